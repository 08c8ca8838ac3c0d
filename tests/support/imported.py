"""Imported models, as the graph that they describe."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from deros.generators.output.writer import write
from deros.importers.kept.files import renewed
from deros.importers.node_types import ImportedGraph, imported
from deros.importers.texts import files
from deros.live.snapshots import Snapshot
from deros.models.node import PortKind
from deros.models.qos import Policies, policies
from deros.systems.flatten import flatten
from tests.support.systems import load

Ends = dict[tuple[str, str, str], Policies | None]
"""Policies by kind, graph name and type; none for services and actions."""


class Described(NamedTuple):
    """A node as a model describes it; ``parameters`` have their types and values."""

    ends: Ends
    parameters: Mapping[str, tuple[str, Any]]


def described(path: Path) -> dict[str, Described]:
    """Return the nodes of a system, by their full names."""
    return {
        node.full_name: Described(
            {
                (each.port.kind.word, each.topic, str(each.port.type)): policies(each.port.qos)
                if each.port.kind in (PortKind.PUBLISHER, PortKind.SUBSCRIPTION)
                else None
                for each in node.ports
            },
            {name: (_type_of(node.type, name), value) for name, value in node.parameters},
        )
        for node in flatten(load(path)).nodes
    }


def _type_of(node_type: Any, name: str) -> str:
    parameter = node_type.parameter(name)
    return parameter.type.value if parameter is not None else "built in"


def import_into(folder: Path, snapshot: Snapshot, name: str = "robot") -> ImportedGraph:
    """Write the models of a snapshot, all of whose types are known."""
    graph = imported(snapshot, lambda _: True)
    write(renewed(files(graph, name), folder).files, folder)
    return graph
