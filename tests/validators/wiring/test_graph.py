"""The wiring graph: its vertices and edges, and that networkx works on it."""

from __future__ import annotations

from pathlib import Path

import networkx as nx
import pytest

from deros.metamodels.load import Repository
from deros.models.system import System
from deros.systems.flat import FlatSystem
from deros.systems.flatten import flatten
from deros.validators.wiring.graph import (
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
    """Return the flattened system."""
    for name, text in MODELS.items():
        (tmp_path / name).write_text(text)
    loaded = Repository().load(tmp_path / "robot.system")
    assert loaded.diagnostics == ()
    assert isinstance(loaded.model, System)
    return flatten(loaded.model)


@pytest.fixture
def graph(flat: FlatSystem) -> nx.MultiDiGraph[Vertex]:
    """Return the graph of that system."""
    return wiring_graph(flat)


def test_vertices_are_nodes_topics_and_services(graph: nx.MultiDiGraph[Vertex]) -> None:
    """Declared topics come first, used or not; all names are fully qualified."""
    assert list(graph) == [
        ("topic", "/image"),
        ("topic", "/untyped"),
        ("topic", "/tf"),
        ("node", "/vision/camera"),
        ("service", "/vision/camera/calibrate"),
        ("node", "/vision/detector"),
        ("topic", "/vision/found"),
    ]


def test_edges_follow_the_data_flow(graph: nx.MultiDiGraph[Vertex]) -> None:
    """Publisher to topic to subscription; client to service to server."""
    camera, detector = node_vertex("/vision/camera"), node_vertex("/vision/detector")
    image, service = topic_vertex("/image"), ("service", "/vision/camera/calibrate")
    assert nx.shortest_path(graph, camera, detector) == [camera, image, detector]
    assert nx.shortest_path(graph, detector, camera) == [detector, service, camera]


def test_edges_carry_port_type_and_wiring(graph: nx.MultiDiGraph[Vertex]) -> None:
    """An edge has its port, type and whether it comes from a ``connect``."""
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


def test_vertices_carry_node_or_topic(flat: FlatSystem, graph: nx.MultiDiGraph[Vertex]) -> None:
    """A node vertex has the flat node; a topic vertex its declaration, if any, and untyped ends."""
    assert graph.nodes[node_vertex("/vision/camera")]["node"] is flat.nodes[0]
    assert graph.nodes[topic_vertex("/tf")]["topic"].declaration.external
    assert graph.nodes[topic_vertex("/vision/found")]["topic"] is None
    (untyped,) = graph.nodes[topic_vertex("/untyped")]["untyped"]
    assert untyped.node is flat.nodes[0]


def test_channel_has_publishers_and_subscribers(graph: nx.MultiDiGraph[Vertex]) -> None:
    """Both sides of a topic and of a service can be queried."""
    assert [e.node.full_name for e in publishers(graph, topic_vertex("/image"))] == [
        "/vision/camera"
    ]
    assert [e.port.port.name for e in subscribers(graph, topic_vertex("/image"))] == ["image"]
    service: Vertex = ("service", "/vision/camera/calibrate")
    assert [e.port.port.name for e in publishers(graph, service)] == ["calibrate"]
    assert [e.port.port.name for e in subscribers(graph, service)] == ["~/calibrate"]
