"""What differs between a graph and its model: each fault is reported, and nothing else."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from deros.diagnostics import SourceFile, Span
from deros.interfaces.durations import NS_PER_S
from deros.live.snapshots import End, SeenNode, Snapshot
from deros.live.verify.compare import compare
from deros.live.verify.differences import Difference, Kind
from deros.live.verify.expectation import Expectation, expectation
from deros.live.verify.graces import Event
from deros.live.verify.parameters import FirstValues
from deros.live.verify.texts import event_line, line
from deros.models.common import QosProfile
from deros.models.node import ParameterType, PortKind
from deros.report.text import counted
from deros.systems.arguments.lookups import AT_START
from deros.systems.flatten import flatten
from tests.support.examples import EXAMPLES
from tests.support.seen import changed, graph_of, parameter, profile, without
from tests.support.systems import load, load_text

NODES = {
    "lidar": """\
node lidar : drivers
parameters
  name rate : double = 10.0
  name frames : string[] = ["a", "b"]
  name given : int
publishes
  topic scan : sensor_msgs.LaserScan qos best_effort
  topic ~/health : std_msgs.String qos reliable transient_local
services
  service ~/enable : std_srvs.SetBool
""",
    "pilot": """\
node pilot : pilot
subscribes
  topic scan : sensor_msgs.LaserScan qos best_effort
  topic order : std_msgs.Bool
publishes
  topic cmd_vel : geometry_msgs.Twist
clients
  client enable : std_srvs.SetBool
""",
    "crane": """\
node crane : crane lifecycle
parameters
  name reach : double = 2.0
publishes
  topic ~/load : std_msgs.String
""",
    "any": "node any : any\nparameters open\n",
}
TEXT = """\
system Yard
imports import "*.rnd"
topics
  external topic /order
  external topic /cmd_vel
  external topic /lidar/health
  external topic /crane/load
node lidar : lidar
parameters
  param rate = 12
  param given = 3
wirings connect scan to /scan
node pilot : pilot
wirings
  connect scan to /scan
  connect order to /order
  connect enable to /lidar/enable
node crane : crane autostart
node any : any
parameters
  param speed = 1
"""


@pytest.fixture
def expected(tmp_path: Path) -> Expectation:
    """Return what the yard says of its graph."""
    return expectation(flatten(load_text(tmp_path, TEXT, **NODES)))


@pytest.fixture
def seen(tmp_path: Path) -> Snapshot:
    """Return the yard as it runs."""
    return graph_of(flatten(load_text(tmp_path, TEXT, **NODES)))


def found(expected: Expectation, seen: Snapshot, first: FirstValues | None = None) -> list[str]:
    """Return the differences without the places in the model."""
    return [line(replace(each, span=None)) for each in compare(expected, seen, first).differences]


def added(*ends: End) -> Callable[[SeenNode], SeenNode]:
    """Return what gives a node further ends."""
    return lambda node: replace(node, ends=(*node.ends, *ends))


def lacking(kind: PortKind, name: str) -> Callable[[SeenNode], SeenNode]:
    """Return what takes an end from a node."""

    def change(node: SeenNode) -> SeenNode:
        ends = tuple(each for each in node.ends if (each.kind, each.name) != (kind, name))
        assert len(ends) == len(node.ends) - 1
        return replace(node, ends=ends)

    return change


def with_qos(name: str, **policies: object) -> Callable[[SeenNode], SeenNode]:
    """Return what gives an end of a node other policies."""

    def change(node: SeenNode) -> SeenNode:
        assert name in {each.name for each in node.ends}
        return replace(
            node,
            ends=tuple(
                each._replace(qos=replace(each.qos, **policies))  # type: ignore[type-var]
                if each.name == name
                else each
                for each in node.ends
            ),
        )

    return change


def with_value(name: str, kind: ParameterType, value: object) -> Callable[[SeenNode], SeenNode]:
    """Return what gives a parameter of a node another value, or adds it."""

    def change(node: SeenNode) -> SeenNode:
        assert node.parameters is not None
        others = (each for each in node.parameters if each.name != name)
        return replace(node, parameters=(*others, parameter(name, kind, value)))  # type: ignore[arg-type]

    return change


def without_value(name: str) -> Callable[[SeenNode], SeenNode]:
    """Return what takes a parameter from a node."""

    def change(node: SeenNode) -> SeenNode:
        assert node.parameters is not None
        return replace(node, parameters=tuple(p for p in node.parameters if p.name != name))

    return change


SCAN = End(PortKind.PUBLISHER, "/scan", "sensor_msgs/msg/LaserScan", profile(None))
READS_SCAN = End(
    PortKind.SUBSCRIPTION,
    "/scan",
    "sensor_msgs/msg/LaserScan",
    profile(QosProfile(reliability="reliable")),
)

BY_LIBRARIES = [
    End(PortKind.SUBSCRIPTION, "/clock", "rosgraph_msgs/msg/Clock", profile(None)),
    End(PortKind.SUBSCRIPTION, "/tf", "tf2_msgs/msg/TFMessage", profile(None)),
    End(PortKind.PUBLISHER, "/bond", "bond/msg/Status", profile(None)),
    End(PortKind.CLIENT, "/crane/change_state", "lifecycle_msgs/srv/ChangeState"),
    End(PortKind.CLIENT, "/lidar/set_parameters", "rcl_interfaces/srv/SetParameters"),
]
ELSEWHERE = [
    (End(PortKind.CLIENT, "/crane/change_state", "std_srvs/srv/Trigger"), "client"),
    (End(PortKind.SERVICE, "/x/change_state", "lifecycle_msgs/srv/ChangeState"), "service"),
    (End(PortKind.SUBSCRIPTION, "/clock", "std_msgs/msg/Bool", profile(None)), "subscriber"),
]
"""The same names, of another type or kind."""

FAULTS: dict[str, tuple[str, Callable[[SeenNode], SeenNode], list[str]]] = {
    "twin": (
        "/lidar",
        lambda node: replace(node, count=2),
        [
            "repeated-node /lidar: 2 in place of 1; one that was killed counts until its lease "
            "ends, 20 s with Fast DDS"
        ],
    ),
    "publisher is missing": (
        "/lidar",
        lacking(PortKind.PUBLISHER, "/lidar/health"),
        ["missing-end /lidar, publisher /lidar/health: nothing in place of std_msgs/msg/String"],
    ),
    "service is missing": (
        "/lidar",
        lacking(PortKind.SERVICE, "/lidar/enable"),
        ["missing-end /lidar, service /lidar/enable: nothing in place of std_srvs/srv/SetBool"],
    ),
    "end too many": (
        "/lidar",
        added(End(PortKind.SUBSCRIPTION, "/more", "std_msgs/msg/Bool", profile(None))),
        ["extra-end /lidar, subscriber /more: std_msgs/msg/Bool"],
    ),
    "other type": (
        "/pilot",
        lambda node: replace(
            node,
            ends=tuple(
                each._replace(type="std_msgs/msg/String") if each.name == "/order" else each
                for each in node.ends
            ),
        ),
        ["wrong-type /pilot, subscriber /order: std_msgs/msg/String in place of std_msgs/msg/Bool"],
    ),
    "publisher offers less": (
        "/lidar",
        with_qos("/lidar/health", durability="volatile"),
        ["wrong-qos /lidar, publisher /lidar/health: volatile in place of transient_local"],
    ),
    "publisher offers more": ("/lidar", with_qos("/scan", reliability="reliable"), []),
    "subscription requests more": (
        "/pilot",
        with_qos("/scan", reliability="reliable"),
        ["wrong-qos /pilot, subscriber /scan: reliable in place of best_effort"],
    ),
    "subscription requests less": (
        "/pilot",
        with_qos("/order", reliability="best_effort"),
        ["wrong-qos /pilot, subscriber /order: best_effort in place of reliable"],
    ),
    "deadline": (
        "/pilot",
        with_qos("/order", deadline_ns=10**8),
        ["wrong-qos /pilot, subscriber /order: deadline 100 ms in place of no deadline"],
    ),
    "lifespan of a publisher": (
        "/lidar",
        with_qos("/lidar/health", lifespan_ns=2 * 10**9),
        ["wrong-qos /lidar, publisher /lidar/health: lifespan 2 sec in place of no lifespan"],
    ),
    "lifespan of a subscription": ("/pilot", with_qos("/order", lifespan_ns=2 * 10**9), []),
    "second publisher": (
        "/pilot",
        added(SCAN),
        ["second-publisher /pilot, publisher /scan; /lidar alone is meant to publish it"],
    ),
    "set value": (
        "/lidar",
        with_value("rate", ParameterType.DOUBLE, 12.5),
        ["wrong-value /lidar, rate: 12.5 in place of 12.0"],
    ),
    "default": (
        "/lidar",
        with_value("frames", ParameterType.STRING_ARRAY, ("a",)),
        ['wrong-value /lidar, frames: ["a"] in place of ["a", "b"]'],
    ),
    "type of a value": (
        "/lidar",
        with_value("given", ParameterType.STRING, "3"),
        ['wrong-value /lidar, given: "3" (string) in place of 3 (integer)'],
    ),
    "parameter is missing": (
        "/lidar",
        without_value("given"),
        ["missing-parameter /lidar, given: nothing in place of 3"],
    ),
    "any parameter": (
        "/any",
        with_value("speed", ParameterType.DOUBLE, 2.0),
        ["wrong-value /any, speed: 2.0 in place of 1.0"],
    ),
    "any parameter, equal": ("/any", with_value("speed", ParameterType.DOUBLE, 1.0), []),
    "inactive": (
        "/crane",
        lambda node: replace(node, lifecycle="inactive"),
        ["wrong-state /crane: inactive in place of active"],
    ),
    "not managed": (
        "/crane",
        lambda node: replace(node, lifecycle=None),
        ["wrong-state /crane: not a managed node in place of active"],
    ),
    "unconfigured nodes have no ends yet": (
        "/crane",
        lambda node: replace(node, lifecycle="unconfigured", ends=(), parameters=()),
        ["wrong-state /crane: unconfigured in place of active"],
    ),
    "silent": ("/crane", lambda node: replace(node, lifecycle="unknown", parameters=None), []),
    "ends by libraries": ("/any", added(*BY_LIBRARIES), []),
    **{
        f"{word} {end.name}": (
            "/any",
            added(end),
            [f"extra-end /any, {word} {end.name}: {end.type}"],
        )
        for end, word in ELSEWHERE
    },
}


def test_system_as_described_has_no_difference(expected: Expectation, seen: Snapshot) -> None:
    """All of it is compared."""
    result = compare(expected, seen)
    assert (result.differences, result.unknown) == ((), frozenset())


@pytest.mark.parametrize("fault", FAULTS)
def test_each_fault_is_reported_alone(expected: Expectation, seen: Snapshot, fault: str) -> None:
    """One change in the graph gives its difference, and no other."""
    name, change, lines = FAULTS[fault]
    assert found(expected, changed(seen, name, change)) == lines


def test_missing_node_stands_for_all_of_it(expected: Expectation, seen: Snapshot) -> None:
    """Its ends and parameters are unknown; the place is that of its name."""
    result = compare(expected, without(seen, "/lidar"))
    (difference,) = result.differences
    assert (difference.kind, difference.node) == (Kind.MISSING_NODE, "/lidar")
    assert difference.span is not None
    assert difference.span.text == "lidar"
    about = ("ends", "parameters", "state", "container")
    assert result.unknown == {("/lidar", each) for each in about}


def test_extra_node_and_what_it_publishes(expected: Expectation, seen: Snapshot) -> None:
    """A node of no model that publishes a topic with one publisher gives both differences."""
    more = replace(seen, nodes=(*seen.nodes, SeenNode("/far/joker", (SCAN,), ())))
    assert found(expected, more) == [
        "extra-node /far/joker",
        "second-publisher /far/joker, publisher /scan; /lidar alone is meant to publish it",
    ]


def test_unconnected_reader_is_named_with_what_it_lacks(
    expected: Expectation, seen: Snapshot
) -> None:
    """A reader of no model that requests more than is offered gets nothing."""
    more = replace(seen, nodes=(*seen.nodes, SeenNode("/viewer", (READS_SCAN,), ())))
    assert found(expected, more) == [
        "extra-node /viewer",
        "not-connected /viewer, subscriber /scan: best_effort instead of reliable (/lidar)",
    ]


@pytest.mark.parametrize("name", ["/launch_ros_4711", "/x/transform_listener_impl_55d0a1"])
def test_helpers_are_no_extra_nodes(expected: Expectation, seen: Snapshot, name: str) -> None:
    """Nodes of ros2 launch and of listeners of tf2 are in no model."""
    assert found(expected, replace(seen, nodes=(*seen.nodes, SeenNode(name)))) == []


def test_excluded_nodes_are_neither_missing_nor_extra(tmp_path: Path, seen: Snapshot) -> None:
    """By name and by pattern."""
    flat = flatten(load_text(tmp_path, TEXT, **NODES))
    expected = expectation(flat, ignored=["lidar", "/far/*"])
    less = without(seen, "/lidar")
    assert found(expected, replace(less, nodes=(*less.nodes, SeenNode("/far/joker")))) == []


@pytest.mark.parametrize("pin", ["topic /scan publishers any", "external topic /scan"])
def test_several_publishers_may_be_meant(tmp_path: Path, pin: str) -> None:
    """Where the system says so, a second one is just an end that is not described."""
    text = TEXT.replace("topics\n", f"topics\n  {pin}\n", 1)
    flat = flatten(load_text(tmp_path, text, **NODES))
    more = changed(graph_of(flat), "/pilot", added(SCAN))
    assert found(expectation(flat), more) == [
        "extra-end /pilot, publisher /scan: sensor_msgs/msg/LaserScan"
    ]


def test_other_nodes_of_a_launch_file_are_not_extra(tmp_path: Path) -> None:
    """In its namespace, more may be started than the system describes; elsewhere not."""
    (tmp_path / "more.launch.py").write_text("# computed\n", encoding="utf-8")
    text = f'{TEXT}launch "more.launch.py" namespace /more provides {{ }}\n'
    flat = flatten(load_text(tmp_path, text, **NODES))
    nodes = (*graph_of(flat).nodes, SeenNode("/more/a"), SeenNode("/other/a"))
    assert found(expectation(flat), Snapshot(nodes)) == ["extra-node /other/a"]


def test_values_of_the_place_of_the_start_are_not_compared(tmp_path: Path) -> None:
    """A path that the system looks up is another one on each computer."""
    text = TEXT.replace("param rate = 12", 'param frames = ["${this_dir}/a", "b"]')
    flat = flatten(load_text(tmp_path, text, **NODES))
    marked = flatten(load_text(tmp_path, text.replace("${this_dir}", AT_START), **NODES))
    seen = changed(
        graph_of(flat), "/lidar", with_value("frames", ParameterType.STRING_ARRAY, ("/x", "b"))
    )
    assert found(expectation(flat, marked), seen) == []
    assert len(found(expectation(flat), seen)) == 1


def test_change_of_a_value_that_no_model_has(expected: Expectation, seen: Snapshot) -> None:
    """It is compared with the first one that was seen; without one, it is no difference."""
    first: FirstValues = {}
    before = changed(seen, "/any", with_value("free", ParameterType.INTEGER, 1))
    after = changed(seen, "/any", with_value("free", ParameterType.INTEGER, 2))
    assert found(expected, before, first) == []
    assert found(expected, after, first) == ["changed-value /any, free: 2 in place of 1"]
    assert found(expected, before, first) == []
    assert found(expected, after) == []


@pytest.mark.parametrize(
    "path", ["feeding_robot/feeding_robot.system", "intelligent_one/intelligent_one.system"]
)
def test_examples_have_no_difference(path: str) -> None:
    """Safety nodes and gates are nodes like all others."""
    flat = flatten(load(EXAMPLES / path))
    assert found(expectation(flat), graph_of(flat)) == []


def test_without_one_node_each_example_differs() -> None:
    """Whichever it is; what it alone was, nobody else becomes."""
    flat = flatten(load(EXAMPLES / "feeding_robot/feeding_robot.system"))
    expected, seen = expectation(flat), graph_of(flat)
    for node in flat.nodes:
        assert found(expected, without(seen, node.full_name)) == [f"missing-node {node.full_name}"]


PILOT = """\
node pilot : pilot
parameters
  name max_speed : double = 0.5
subscribes
  topic scan : sensor_msgs.LaserScan qos best_effort
"""
LIDAR = """\
node lidar : drivers
publishes
  topic scan : sensor_msgs.LaserScan qos best_effort
"""
ROBOT = """\
system Robot

imports
  import "nodes/*.rnd"

topics
  topic /scan



// Its only sensor.
node lidar : lidar
wirings
  connect scan to /scan




node pilot : pilot
parameters
  param max_speed = 0.5
wirings
  connect scan to /scan
"""


def test_documented_watch_is_that_of_a_node_that_is_gone() -> None:
    """Its two lines, but for the time of day."""
    missing = Difference(Kind.MISSING_NODE, "/lidar", span=_span(12))
    events = [Event(missing, False, 5 * NS_PER_S), Event(missing, True, 82 * NS_PER_S // 10)]
    page = (EXAMPLES.parent / "docs/running-graph.md").read_text(encoding="utf-8")
    shown = page.split("```text\n")[2].split("```")[0].splitlines()
    assert [each.split(" ", 1)[1] for each in shown] == [event_line(each) for each in events]


def test_documented_kinds_and_graces_are_those_of_the_table() -> None:
    """Each kind with its severity, and how long it has to last."""
    page = (EXAMPLES.parent / "docs/running-graph.md").read_text(encoding="utf-8")
    rows = [
        [cell.strip() for cell in row.split("|")[1:-1]]
        for row in page.splitlines()
        if row.startswith("| `")
    ]
    severities = {first.strip("`"): cells[0] for first, *cells in rows if len(cells) == 2}
    assert severities == {
        kind.word: kind.severity for kind in Kind if kind is not Kind.CHANGED_VALUE
    }
    assert f"`changed-value` ({Kind.CHANGED_VALUE.severity})" in page
    graces = {
        word.strip("`"): int(cells[0].split()[0]) * NS_PER_S
        for first, *cells in rows
        if len(cells) == 1 and cells[0].split(":")[0].endswith(" s")
        for word in first.split(", ")
    }
    assert graces == {kind.word: kind.grace_ns for kind in Kind}


def _span(number: int) -> Span:
    """Return a place in that line of ``robot.system``, as it is called on the page."""
    source = SourceFile("robot.system", "\n" * number)
    return Span(source, number - 1, number - 1)


def test_documented_report_is_that_of_such_a_robot(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its lines, with their places, but for the number of nodes in the last one."""
    (tmp_path / "nodes").mkdir()
    (tmp_path / "nodes/pilot.rnd").write_text(PILOT, encoding="utf-8")
    (tmp_path / "nodes/lidar.rnd").write_text(LIDAR, encoding="utf-8")
    (tmp_path / "robot.system").write_text(ROBOT, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    flat = flatten(load(Path("robot.system")))
    seen = without(graph_of(flat), "/lidar")
    seen = changed(seen, "/pilot", with_qos("/scan", reliability="reliable"))
    seen = changed(seen, "/pilot", with_value("max_speed", ParameterType.DOUBLE, 0.8))
    page = (EXAMPLES.parent / "docs/running-graph.md").read_text(encoding="utf-8")
    *shown, last = page.split("```text\n")[1].split("```")[0].splitlines()
    differences = compare(expectation(flat), seen).differences
    assert [line(each) for each in differences] == shown
    assert last.endswith(counted(len(differences), "difference"))
