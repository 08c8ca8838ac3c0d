"""The kinds of files that models can be imported from: a row each."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from deros.importers.formats.graph_message import is_graph, read_graph
from deros.importers.formats.nodl import is_nodl, read_nodl
from deros.importers.formats.parameter_library import is_library, read_library
from deros.importers.formats.rostooling import is_rostooling, read_rostooling
from deros.importers.launch.reading import read_python, read_xml, read_yaml
from deros.importers.parameter_files import read_parameter_files
from deros.importers.readers import Kind
from deros.importers.recognized import (
    is_launch_python,
    is_launch_xml,
    is_launch_yaml,
    is_parameter_file,
)
from deros.importers.recordings.reading import read_recordings
from deros.importers.recordings.recognized import is_recording

KINDS: tuple[Kind, ...] = (
    Kind(
        "recording",
        "a recording of rosbag2: its folder, or an .mcap or .db3 file",
        is_recording,
        read_recordings,
    ),
    Kind("launch-xml", "a launch file in XML", is_launch_xml, read_xml),
    Kind("launch-yaml", "a launch file in YAML", is_launch_yaml, read_yaml),
    Kind(
        "launch-python",
        "a launch file in Python, which is run",
        is_launch_python,
        read_python,
        runs=True,
    ),
    Kind("parameters", "a parameter file of ROS 2", is_parameter_file, read_parameter_files),
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
