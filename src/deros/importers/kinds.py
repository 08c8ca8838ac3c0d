"""The kinds of files that models can be imported from: a row each."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from deros.importers.formats.graph_message import is_graph, read_graph
from deros.importers.formats.nodl import is_nodl, read_nodl
from deros.importers.formats.parameter_library import is_library, read_library
from deros.importers.formats.rostooling import is_rostooling, read_rostooling
from deros.importers.readers import Kind

KINDS: tuple[Kind, ...] = (
    Kind("graph", "a message rosgraph_msgs/msg/Graph, as YAML or JSON", is_graph, read_graph),
    Kind("nodl", "NoDL 2, the interfaces of nodes", is_nodl, read_nodl),
    Kind(
        "rostooling", "models of RosTooling, .ros2 and .rossystem", is_rostooling, read_rostooling
    ),
    Kind("parameter-library", "parameters of generate_parameter_library", is_library, read_library),
)


def kinds_of(files: Sequence[Path]) -> Iterator[Kind | None]:
    """Yield the kind of each file, ``None`` for one that is of none."""
    for file in files:
        yield next((kind for kind in KINDS if kind.is_one(file)), None)
