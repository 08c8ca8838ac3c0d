"""The wiring graph: what its vertices and edges are, and that networkx works on it."""

from __future__ import annotations

from pathlib import Path

import networkx as nx
import pytest

from deros.metamodels.flatten import FlatSystem, flatten
from deros.metamodels.load import Repository
from deros.metamodels.system import System
from deros.validators.graph import (
    Vertex,
    node_vertex,
    publishers,
    subscribers,
    topic_vertex,
    wiring_graph,
)

MODELS = {
    "camera.rnd": """\
node camera : demo
parameters
  name topic_id : string = "x"
publishes
  topic image : sensor_msgs.Image
services
  service ~/calibrate : std_srvs.Trigger
""",
    "detector.rnd": """\
node detector : demo
subscribes
  topic image : sensor_msgs.Image
publishes
  topic found : std_msgs.Bool
clients
  client calibrate : std_srvs.Trigger
""",
    "robot.system": """\
system Robot
imports import "*.rnd"
topics
  topic /image : sensor_msgs.Image
  topic /untyped
  external topic /tf
subsystem Vision namespace /vision {
  node camera : camera
  wirings
    connect image to /image
    connect topic_id to /untyped
  node detector : detector
  wirings
    connect image to /image
    connect calibrate to camera/calibrate
}
""",
}


@pytest.fixture
def flat(tmp_path: Path) -> FlatSystem:
    """The system above, flattened."""
    for name, text in MODELS.items():
        (tmp_path / name).write_text(text)
    loaded = Repository().load(tmp_path / "robot.system")
    assert loaded.diagnostics == ()
    assert isinstance(loaded.model, System)
    return flatten(loaded.model)


@pytest.fixture
def graph(flat: FlatSystem) -> nx.MultiDiGraph[Vertex]:
    """The graph of that system."""
    return wiring_graph(flat)


def test_vertices_are_nodes_topics_and_services(graph: nx.MultiDiGraph[Vertex]) -> None:
    """Declared topics come first, also those that nobody uses; names are full names."""
    assert list(graph) == [
        ("topic", "/image"),
        ("topic", "/untyped"),
        ("topic", "/tf"),
        ("node", "/vision/camera"),
        ("service", "/vision/camera/calibrate"),
        ("node", "/vision/detector"),
        ("topic", "/vision/found"),
    ]


def test_edges_run_with_the_data(graph: nx.MultiDiGraph[Vertex]) -> None:
    """Publisher to topic to subscription; client to service to server."""
    camera, detector = node_vertex("/vision/camera"), node_vertex("/vision/detector")
    image, service = topic_vertex("/image"), ("service", "/vision/camera/calibrate")
    assert nx.shortest_path(graph, camera, detector) == [camera, image, detector]
    assert nx.shortest_path(graph, detector, camera) == [detector, service, camera]


def test_edges_carry_port_type_and_wiring(graph: nx.MultiDiGraph[Vertex]) -> None:
    """An edge tells which port it is, of which type, and whether a ``connect`` made it."""
    camera, detector = node_vertex("/vision/camera"), node_vertex("/vision/detector")
    edge = graph.edges[camera, topic_vertex("/image"), 0]
    assert (edge["port"], str(edge["type"]), edge["wired"]) == (
        "image",
        "sensor_msgs/msg/Image",
        True,
    )
    unwired = graph.edges[detector, topic_vertex("/vision/found"), 0]
    assert (unwired["port"], unwired["wired"]) == ("found", False)
    assert unwired["end"].name == "/vision/detector (found)"


def test_vertices_carry_what_they_stand_for(
    flat: FlatSystem, graph: nx.MultiDiGraph[Vertex]
) -> None:
    """A node vertex has the flat node; a topic its declaration, if any, and its untyped ends."""
    assert graph.nodes[node_vertex("/vision/camera")]["node"] is flat.nodes[0]
    assert graph.nodes[topic_vertex("/tf")]["topic"].declaration.external
    assert graph.nodes[topic_vertex("/vision/found")]["topic"] is None
    (untyped,) = graph.nodes[topic_vertex("/untyped")]["untyped"]
    assert untyped.node is flat.nodes[0]


def test_ends_of_a_channel(graph: nx.MultiDiGraph[Vertex]) -> None:
    """Both sides of a topic and of a service can be asked for."""
    assert [e.node.full_name for e in publishers(graph, topic_vertex("/image"))] == [
        "/vision/camera"
    ]
    assert [e.port.port.name for e in subscribers(graph, topic_vertex("/image"))] == ["image"]
    service: Vertex = ("service", "/vision/camera/calibrate")
    assert [e.port.port.name for e in publishers(graph, service)] == ["calibrate"]
    assert [e.port.port.name for e in subscribers(graph, service)] == ["~/calibrate"]
