"""The flattened system: full names, topics, parameters and remappings."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.names.graph_names import resolve_name
from deros.systems.flat import FlatNode, FlatSystem
from deros.systems.flatten import flatten
from tests.support.systems import load_text

LIDAR = """
    node lidar : sensors
    parameters
      name topic_name : string = "points"
      name rate : double = 10.0
    publishes
      topic scan : sensor_msgs.LaserScan
      topic cloud : sensor_msgs.PointCloud2 via topic_name
      topic ~/status : std_msgs.String
      topic /diagnostics : std_msgs.String
"""


def flat(folder: Path, members: str, **nodes: str) -> FlatSystem:
    """Flatten a system of ``members`` that may use ``lidar`` and the given nodes."""
    text = f'system Test imports import "*.rnd" {members}'
    return flatten(load_text(folder, text, lidar=LIDAR, **nodes))


def only_node(folder: Path, members: str, **nodes: str) -> FlatNode:
    """Flatten a system of one node."""
    (node,) = flat(folder, members, **nodes).nodes
    return node


def topics_of(node: FlatNode) -> dict[str, str]:
    """Return the topic of each port."""
    return {port.port.name: port.topic for port in node.ports}


@pytest.mark.parametrize(
    ("name", "namespace", "meaning"),
    [
        ("/a/b", "/x", "/a/b"),
        ("a", "/", "/a"),
        ("a/b", "/x/y", "/x/y/a/b"),
        ("~/a", "/x", "/x/me/a"),
        ("~", "/x", "/x/me"),
        ("~/a", "/", "/me/a"),
    ],
)
def test_names_resolve_as_in_ros_2(name: str, namespace: str, meaning: str) -> None:
    """Absolute names stay, relative ones go under the namespace, private ones under the node."""
    assert resolve_name(name, namespace, "me") == meaning


def test_relative_namespaces_extend_and_absolute_ones_replace(tmp_path: Path) -> None:
    """A relative namespace extends the enclosing one, an absolute one replaces it."""
    nodes = flat(
        tmp_path,
        """
        node top : lidar
        subsystem plain { node inside : lidar }
        subsystem a namespace a {
          subsystem b namespace b { node deep : lidar node own : lidar namespace c }
          subsystem c namespace /z { node far : lidar namespace /q }
        }
        """,
    ).nodes
    assert [node.full_name for node in nodes] == [
        "/top",
        "/inside",
        "/a/b/deep",
        "/a/b/c/own",
        "/q/far",
    ]
    assert [node.path for node in nodes] == [(), ("plain",), ("a", "b"), ("a", "b"), ("a", "c")]


def test_unwired_port_uses_its_own_name(tmp_path: Path) -> None:
    """Without a wiring a port has its own name, or the one in its parameter."""
    node = only_node(tmp_path, "node eye : lidar namespace /front")
    assert topics_of(node) == {
        "scan": "/front/scan",
        "cloud": "/front/points",
        "~/status": "/front/eye/status",
        "/diagnostics": "/diagnostics",
    }
    assert all(port.wiring is None for port in node.ports)
    assert node.parameters == node.remappings == ()


def test_unwired_port_follows_the_value_of_its_parameter(tmp_path: Path) -> None:
    """``param`` alone moves a port that takes its name from that parameter."""
    node = only_node(tmp_path, 'node eye : lidar parameters param topic_name = "/cloud"')
    assert topics_of(node)["cloud"] == "/cloud"


def test_port_via_a_list_has_a_topic_for_each_entry(tmp_path: Path) -> None:
    """Entries are resolved like names in code: those set by the system, else by default."""
    fused = (
        'node fused : f parameters name in : string[] = ["a", "/b"]'
        " subscribes topic x : std_msgs.Bool via in"
    )
    default = only_node(tmp_path, "node eye : fused namespace /front", fused=fused)
    assert [port.topic for port in default.ports] == ["/front/a", "/b"]
    given = 'node eye : fused namespace /front parameters param in = ["~/c"]'
    node = only_node(tmp_path, given, fused=fused)
    assert [(port.topic, port.entry) for port in node.ports] == [("/front/eye/c", "~/c")]
    assert node.remappings == ()
    none = only_node(tmp_path, "node eye : fused parameters param in = []", fused=fused)
    assert none.ports == ()


def test_port_via_a_map_has_a_topic_for_each_entry(tmp_path: Path) -> None:
    """Entries without a name have none; names of entries that the list lacks are ignored."""
    fused = (
        'node fused : f parameters name in : string[] = ["a", "b"]'
        ' name to.<in>.t : string = "~/d" subscribes topic x : std_msgs.Bool via to.<in>.t'
    )

    def ports(text: str) -> list[tuple[str, str | None, str | None]]:
        node = only_node(tmp_path, f"node eye : fused namespace /front {text}", fused=fused)
        assert node.remappings == ()
        return [(port.topic, port.entry, port.named_by) for port in node.ports]

    default = ("/front/eye/d", "~/d", "to.a.t")
    assert ports("") == [default, (*default[:2], "to.b.t")]
    assert ports('parameters param to.b.t = "/c"') == [default, ("/c", "/c", "to.b.t")]
    assert ports('parameters param to.b.t = ""') == [default]
    assert ports('parameters param in = ["b", "b"] param to.a.t = "/c"') == [
        (*default[:2], "to.b.t")
    ]


def test_wirings_become_remappings(tmp_path: Path) -> None:
    """A port is remapped from its own name; relative targets are put under the namespace."""
    node = only_node(
        tmp_path,
        """
        node eye : lidar namespace /front
          wirings
            connect scan to ranges
            connect ~/status to ~/health
            connect diagnostics to /all
        """,
    )
    assert node.remappings == (
        ("scan", "/front/ranges"),
        ("~/status", "/front/eye/health"),
        ("/diagnostics", "/all"),
    )
    assert topics_of(node)["scan"] == "/front/ranges"


@pytest.mark.parametrize("end", ["cloud", "topic_name"])
def test_port_with_via_is_wired_through_its_parameter(tmp_path: Path, end: str) -> None:
    """The wiring sets the parameter instead of a remapping, by either name."""
    node = only_node(tmp_path, f"node eye : lidar wirings connect {end} to /cloud")
    assert node.parameters == (("topic_name", "/cloud"),)
    assert node.remappings == ()
    assert topics_of(node)["cloud"] == "/cloud"
    assert node.ports[1].wiring is not None
    assert node.untyped == ()


def test_wiring_through_an_unclaimed_parameter_is_untyped(tmp_path: Path) -> None:
    """It sets the parameter, and is listed apart from the ports."""
    legacy = 'node legacy : old parameters name out_topic : string = "x"'
    node = only_node(
        tmp_path,
        'node eye : legacy parameters param out_topic = "/a" wirings connect out_topic to /b',
        legacy=legacy,
    )
    assert node.parameters == (("out_topic", "/b"),)
    assert [untyped.topic for untyped in node.untyped] == ["/b"]


def test_first_of_two_wirings_applies(tmp_path: Path) -> None:
    """Port, remapping and parameter agree even in an invalid model."""
    node = only_node(
        tmp_path,
        """
        node eye : lidar
          wirings
            connect scan to /first      connect scan to /second
            connect cloud to /one       connect topic_name to /two
        """,
    )
    assert node.remappings == (("scan", "/first"),)
    assert node.parameters == (("topic_name", "/one"),)
    assert topics_of(node)["cloud"] == "/one"


def test_name_shared_by_two_ports_is_remapped_once(tmp_path: Path) -> None:
    """A node that reads and writes one topic moves with both ends."""
    node = only_node(
        tmp_path,
        "node a : echo wirings connect word to /words",
        echo="""
            node echo : e
            subscribes topic word : std_msgs.Bool
            publishes topic word : std_msgs.Bool
        """,
    )
    assert node.remappings == (("word", "/words"),)
    assert [port.topic for port in node.ports] == ["/words", "/words"]


def test_exact_port_name_has_priority(tmp_path: Path) -> None:
    """``x`` and ``/x`` are two names; the slash may be omitted only if that is unambiguous."""
    node = only_node(
        tmp_path,
        "node a : two namespace /n wirings connect x to /y",
        two="node two : e publishes topic /x : std_msgs.Bool topic x : std_msgs.Bool",
    )
    assert node.remappings == (("x", "/y"),)


def test_system_used_twice_appears_twice(tmp_path: Path) -> None:
    """Each use has its own namespace, nodes and topics."""
    (tmp_path / "arm.system").write_text(
        'system Arm imports import "lidar.rnd" topics topic scans topic /clock '
        "subsystem tip { node eye : lidar wirings connect scan to scans }"
    )
    system = flat(
        tmp_path,
        """
        import "arm.system"
        subsystem left : Arm namespace /left
        subsystem right : Arm namespace /r
        """,
    )
    assert [node.full_name for node in system.nodes] == ["/left/eye", "/r/eye"]
    assert [node.path for node in system.nodes] == [("left", "tip"), ("right", "tip")]
    assert [node.remappings for node in system.nodes] == [
        (("scan", "/left/scans"),),
        (("scan", "/r/scans"),),
    ]
    assert [topic.name for topic in system.topics] == [
        "/left/scans",
        "/clock",
        "/r/scans",
        "/clock",
    ]


def test_topics_are_found_by_their_full_names(tmp_path: Path) -> None:
    """A topic declared in a subsystem lies under its namespace."""
    system = flat(tmp_path, "topics topic /a subsystem s namespace s { topics topic b }")
    assert [topic.name for topic in system.topics] == ["/a", "/s/b"]
    assert system.topic("/s/b") is system.topics[1]
    assert system.topic("/b") is None


def test_nodes_of_unknown_types_have_no_ports(tmp_path: Path) -> None:
    """The checks report them; the rest of the system is complete."""
    from deros.metamodels.load import Repository
    from deros.models.system import System

    text = "system Test node a : nothing wirings connect x to /y"
    model = Repository().load_text(tmp_path / "test.system", text).model
    assert isinstance(model, System)
    (node,) = flatten(model).nodes
    assert (node.type, node.full_name, node.ports) == (None, "/a", ())


def test_nodes_keep_the_order_of_the_source(tmp_path: Path) -> None:
    """Nesting does not change the order of nodes."""
    system = flat(
        tmp_path,
        """
        node z : lidar
        subsystem s { node y : lidar subsystem t { node x : lidar } }
        node a : lidar
        """,
    )
    assert [node.instance.name for node in system.nodes] == ["z", "y", "x", "a"]
