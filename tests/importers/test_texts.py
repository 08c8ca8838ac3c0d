"""Snapshots as models: what is written, and that it means what was seen."""

from __future__ import annotations

import math
import tempfile
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from deros.importers.node_types import imported
from deros.importers.texts import files
from deros.live.snapshots import End, SeenNode, SeenParameter, Snapshot, Unseen
from deros.models.common import Interval, QosProfile
from deros.models.node import ParameterType, PortKind
from deros.models.qos import policies
from deros.systems.flatten import flatten
from tests.support.checks import checked
from tests.support.imported import Described, described, import_into
from tests.support.systems import load

PLAIN = QosProfile(reliability="reliable", durability="volatile")
TOPICS = (PortKind.PUBLISHER, PortKind.SUBSCRIPTION)


PARAMETER_EVENTS: dict[str, int | str] = {
    "depth": 1000,
    "durability": "volatile",
    "history": "keep_last",
    "reliability": "reliable",
}
"""What the parameters of a node of rclcpp say of its topic of parameter events."""


def node(full_name: str, *ends: End, **more: object) -> SeenNode:
    """Return a node without parameters, its ends in the order of a snapshot."""
    order = sorted(ends, key=lambda end: (list(PortKind).index(end.kind), end.name))
    known = {"parameters": (), **more}
    return SeenNode(full_name, tuple(order), **known)  # type: ignore[arg-type]


def publisher(name: str, of_type: str = "std_msgs/msg/Bool") -> End:
    """Return a publisher with the usual QoS."""
    return End(PortKind.PUBLISHER, name, of_type, PLAIN)


def subscription(name: str, of_type: str = "std_msgs/msg/Bool") -> End:
    """Return a subscription with the usual QoS."""
    return End(PortKind.SUBSCRIPTION, name, of_type, PLAIN)


def test_golden_files() -> None:
    """The layout is that of the documentation, in a stable order."""
    rate = SeenParameter(
        "rate", ParameterType.DOUBLE, 5.0, "Turns a second", interval=Interval(0.5, 40.0)
    )
    lidars = (
        node(
            f"/{side}/lidar", publisher(f"/{side}/blocked"), parameters=(rate,), lifecycle="active"
        )
        for side in ("right", "left")
    )
    pilot = node(
        "/pilot",
        subscription("/left/blocked"),
        publisher("/tf"),
        End(PortKind.CLIENT, "/left/lidar/change_state", "lifecycle_msgs/srv/ChangeState"),
    )
    graph = imported(Snapshot((*lidars, pilot)), lambda _: True)
    assert graph.problems == ()
    texts = {
        path: parts.head + "---\n" + parts.body for path, parts in files(graph, "courier").items()
    }
    assert texts == {
        "courier.system": """\
system courier

imports
  import "nodes/*.rnd"
---
topics
  topic /left/blocked : std_msgs.Bool
  external topic /right/blocked : std_msgs.Bool
  external topic /right/lidar/change_state
  external topic /tf : std_msgs.Bool

node pilot : pilot
wirings
  connect /tf to /tf
  connect /left/blocked to /left/blocked
  connect /left/lidar/change_state to /left/lidar/change_state

subsystem left namespace /left {
  node lidar : lidar activated by /pilot  // it was active
  parameters
    param rate = 5.0
  wirings
    connect blocked to /left/blocked
}

subsystem right namespace /right {
  node lidar : lidar  // it was active
  parameters
    param rate = 5.0
  wirings
    connect blocked to /right/blocked
}
""",
        "nodes/lidar.rnd": """\
// A running graph shows no package and no program: write the right ones here.
node lidar : unknown_package
executable "lidar"
---
lifecycle

parameters
  name rate : double in [0.5, 40.0] "Turns a second"

publishes
  topic blocked : std_msgs.Bool qos reliable volatile
""",
        "nodes/pilot.rnd": """\
// A running graph shows no package and no program: write the right ones here.
node pilot : unknown_package
executable "pilot"
---
publishes
  topic /tf : std_msgs.Bool qos reliable volatile

subscribes
  topic /left/blocked : std_msgs.Bool qos reliable volatile

clients
  client /left/lidar/change_state : lifecycle_msgs.ChangeState
""",
    }


def test_managed_nodes_are_activated_by_what_the_graph_shows(tmp_path: Path) -> None:
    """By the node with a client, or from outside: neither is a finding."""
    manager = End(PortKind.CLIENT, "/a/change_state", "lifecycle_msgs/srv/ChangeState")
    seen = Snapshot(
        (node("/a", lifecycle="active"), node("/b", lifecycle="unconfigured"), node("/m", manager))
    )
    import_into(tmp_path, seen)
    assert checked(tmp_path / "robot.system") == []


@pytest.mark.parametrize(
    ("first", "second", "ports"),
    [
        # Two namespaces show that a name is relative.
        (node("/a/n", publisher("/a/x")), node("/b/n", publisher("/b/x")), ["x"]),
        (node("/a/n", publisher("/a/x")), node("/n", publisher("/x")), ["x"]),
        (node("/a/n", publisher("/a/n/x")), node("/m", publisher("/m/x")), ["~/x"]),
        # In the root nothing shows it.
        (node("/n", publisher("/x")), node("/m", publisher("/x")), ["/x"]),
        (node("/a/n", publisher("/x")), node("/b/n", publisher("/x")), ["/x"]),
    ],
)
def test_nodes_with_equal_interfaces_share_a_type(
    first: SeenNode, second: SeenNode, ports: list[str]
) -> None:
    """Names are as relative as the nodes show."""
    (kind,) = imported(Snapshot((first, second)), lambda _: True).types
    assert [port.name for port in kind.ports] == ports


@pytest.mark.parametrize(
    "second",
    [
        node("/b/n", publisher("/b/y")),
        node("/b/n", publisher("/a/x")),
        node("/b/n", publisher("/b/x", "std_msgs/msg/String")),
        node("/b/n", subscription("/b/x")),
        node("/b/n", publisher("/b/x"), subscription("/b/x")),
        node("/b/n", publisher("/b/x"), lifecycle="active"),
        node("/b/n", publisher("/b/x"), parameters=None),
        node("/b/n", publisher("/b/x"), parameters=(SeenParameter("p", ParameterType.BOOL, True),)),
        node("/b/n", publisher("/b/x")._replace(qos=QosProfile(reliability="best_effort"))),
    ],
)
def test_nodes_that_differ_have_types_of_their_own(second: SeenNode) -> None:
    """The second is named after its namespace."""
    types = imported(Snapshot((node("/a/n", publisher("/a/x")), second)), lambda _: True).types
    assert [kind.name for kind in types] == ["n", "n_b"]


def test_names_of_types_differ_in_more_than_case() -> None:
    """They are names of files."""
    seen = Snapshot(
        (node("/N"), node("/n", publisher("/x")), node("/a/n", publisher("/x"), publisher("/y")))
    )
    types = imported(seen, lambda _: True).types
    assert len({kind.name.lower() for kind in types}) == 3


def test_what_a_model_cannot_say_is_listed_and_a_comment(tmp_path: Path) -> None:
    """Nothing is left out silently, and the rest has no error."""
    odd = (
        SeenParameter("a b", ParameterType.BOOL, True),
        SeenParameter("<x>", ParameterType.BOOL, True),
        SeenParameter("fine", ParameterType.INTEGER, 2, constraints="even\nonly", step=2),
    )
    ends = (publisher("/x", "secret_msgs/msg/Thing"), publisher("/y"), publisher("/z", "nonsense"))
    seen = Snapshot((node("/n", *ends, parameters=odd, container=True),), (Unseen("/m was shy"),))
    graph = imported(seen, lambda kind: kind.package != "secret_msgs")
    no_definition = "is left out: there is no definition of its type here, see --interfaces"
    listed = [
        f"publisher /x : secret_msgs/msg/Thing {no_definition}",
        f"publisher /z : nonsense {no_definition}",
        "parameter a b is left out: its name contains ' '",
        "parameter <x> is left out: its name contains '<'",
        "parameter fine goes in steps of 2",
        "parameter fine has constraints in words: even?only",
    ]
    assert graph.problems[0] == "/m was shy"
    for line, problem in zip(listed, graph.problems[1:], strict=False):
        assert problem.startswith(f"/n: {line}")
    assert "/n is a container" in graph.problems[-1]
    body = files(graph, "robot")["nodes/n.rnd"].body
    assert all(f"// {line}" in body for line in listed)
    import_into(tmp_path, Snapshot((node("/n", publisher("/y"), parameters=odd),)))
    assert checked(tmp_path / "robot.system") == []


def test_use_of_simulated_time_is_a_setting(tmp_path: Path) -> None:
    """Every node has that parameter, so no type declares it; its usual value is not written."""
    times = {"/a": True, "/b": False}
    seen = Snapshot(
        tuple(
            node(name, parameters=(SeenParameter("use_sim_time", ParameterType.BOOL, value),))
            for name, value in times.items()
        )
    )
    assert len(import_into(tmp_path, seen).types) == 1
    found = {name: each.parameters for name, each in described(tmp_path / "robot.system").items()}
    assert found == {"/a": {"use_sim_time": ("built in", True)}, "/b": {}}


def test_subscription_of_the_clock_is_of_simulated_time(tmp_path: Path) -> None:
    """A node that is told to use it has one, and is of the same type as one that is not."""
    clock = subscription("/clock", "rosgraph_msgs/msg/Clock")
    told = (SeenParameter("use_sim_time", ParameterType.BOOL, True),)
    seen = Snapshot(
        (
            node("/a", publisher("/scan"), clock, parameters=told),
            node("/b", publisher("/scan"), parameters=()),
            node("/reader", publisher("/scan"), clock, parameters=()),
            node("/sim", publisher("/clock", "rosgraph_msgs/msg/Clock"), parameters=told),
        )
    )
    graph = import_into(tmp_path, seen)
    # That only some are told is what the graph is like.
    assert [each.code.slug for each in checked(tmp_path / "robot.system")] == ["simulated-time"]
    ends = {each.seen.full_name: [end.name for end in each.ends] for each in graph.nodes}
    assert ends == {
        "/a": ["/scan"],
        "/b": ["/scan"],
        "/reader": ["/scan", "/clock"],
        "/sim": ["/clock"],
    }
    kinds = {each.seen.full_name: each.type for each in graph.nodes}
    assert kinds["/a"] is kinds["/b"]
    assert kinds["/a"] is not kinds["/reader"]


def test_usual_overrides_of_nodes_in_cpp_are_left_out(tmp_path: Path) -> None:
    """Every node of rclcpp has them; one that somebody has changed is a parameter as any other."""
    usual: dict[str, int | str] = {
        **{
            f"qos_overrides./parameter_events.publisher.{policy}": value
            for policy, value in PARAMETER_EVENTS.items()
        },
        "qos_overrides./clock.subscription.reliability": "best_effort",
    }
    depth = "qos_overrides./parameter_events.publisher.depth"
    scan = "qos_overrides./scan.publisher.depth"
    overrides: dict[str, dict[str, int | str]]
    overrides = {"/a": usual, "/b": {}, "/c": usual | {depth: 5, scan: 1000}}
    seen = Snapshot(
        tuple(
            node(name, publisher("/scan"), parameters=tuple(map(_override, own.items())))
            for name, own in overrides.items()
        )
    )
    assert len(import_into(tmp_path, seen).types) == 2
    system = tmp_path / "robot.system"
    assert checked(system) == []
    found = {each.full_name: dict(each.parameters) for each in flatten(load(system)).nodes}
    assert found == {"/a": {}, "/b": {}, "/c": {depth: 5, scan: 1000}}


def _override(item: tuple[str, int | str]) -> SeenParameter:
    name, value = item
    kind = ParameterType.INTEGER if isinstance(value, int) else ParameterType.STRING
    return SeenParameter(name, kind, value, read_only=True)


# Drawn snapshots --------------------------------------------------------------------------------

NAMES = st.sampled_from(
    ["a", "b", "node", "topic", "connect", "parameters", "subsystem", "a_b", "to", "A"]
)
SPACES = st.sampled_from(["", "/a", "/b", "/a/b", "/a_b", "/topics"])
TYPES = {
    "topic": ["std_msgs/msg/Bool", "std_msgs/msg/String"],
    "service": ["std_srvs/srv/Trigger", "std_srvs/srv/SetBool"],
    "action": ["test_msgs/action/Fibonacci"],
}
VALUES: dict[ParameterType, st.SearchStrategy[Any]] = {
    ParameterType.BOOL: st.booleans(),
    ParameterType.INTEGER: st.integers(-(2**63), 2**63 - 1),
    ParameterType.DOUBLE: st.floats(allow_nan=False),
    ParameterType.STRING: st.text(st.characters(exclude_categories=["Cs"])),
}
VALUES |= {
    kind: st.lists(items, max_size=3).map(tuple)
    for kind, items in [
        (ParameterType.BYTE_ARRAY, st.integers(0, 255)),
        (ParameterType.BOOL_ARRAY, st.booleans()),
        (ParameterType.INTEGER_ARRAY, VALUES[ParameterType.INTEGER]),
        (ParameterType.DOUBLE_ARRAY, VALUES[ParameterType.DOUBLE]),
        (ParameterType.STRING_ARRAY, VALUES[ParameterType.STRING]),
    ]
}
TIMES = st.none() | st.integers(1, 10**12)


@st.composite
def profiles(draw: st.DrawFn) -> QosProfile:
    """Draw the profile of an end."""
    lease = draw(TIMES)
    manual = draw(st.booleans())
    return QosProfile(
        reliability=draw(st.sampled_from(["reliable", "best_effort"])),
        durability=draw(st.sampled_from(["volatile", "transient_local"])),
        deadline_ns=draw(TIMES),
        lifespan_ns=draw(TIMES),
        liveliness="manual_by_topic" if manual else ("automatic" if lease else None),
        lease_ns=lease,
    )


@st.composite
def ends(draw: st.DrawFn, full_name: str) -> End:
    """Draw an end, whose name is private, near the node, or absolute."""
    kind = draw(st.sampled_from(list(PortKind)))
    start = draw(st.sampled_from([full_name, full_name.rpartition("/")[0], "", "/far"]))
    if kind in TOPICS:
        return End(
            kind, f"{start}/{draw(NAMES)}", draw(st.sampled_from(TYPES["topic"])), draw(profiles())
        )
    of = "service" if kind in (PortKind.SERVICE, PortKind.CLIENT) else "action"
    return End(kind, f"{start}/{draw(NAMES)}", draw(st.sampled_from(TYPES[of])))


@st.composite
def parameters(draw: st.DrawFn, name: str) -> SeenParameter:
    """Draw a parameter with a value of its type."""
    kind = draw(st.sampled_from(list(ParameterType)))
    description = draw(st.text(max_size=5))
    return SeenParameter(name, kind, draw(VALUES[kind]), description, read_only=draw(st.booleans()))


@st.composite
def snapshots(draw: st.DrawFn) -> Snapshot:
    """Draw a graph of a few nodes."""
    names = draw(st.sets(st.builds("{}/{}".format, SPACES, NAMES), min_size=1, max_size=5))
    nodes = []
    for name in sorted(names):
        own = {(end.kind, end.name): end for end in draw(st.lists(ends(name), max_size=5))}
        known = draw(
            st.sets(st.sampled_from(["p", "q.r", "name", "qos_overrides./x.publisher.depth"]))
        )
        values = tuple(draw(parameters(each)) for each in sorted(known))
        nodes.append(node(name, *own.values(), parameters=values))
    return Snapshot(tuple(nodes))


@settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(snapshots())
@example(
    Snapshot(
        (
            node(
                "/a/a",
                End(PortKind.PUBLISHER, "/a/to", "std_msgs/msg/Bool", QosProfile()),
                End(PortKind.ACTION, "/a/to", "test_msgs/action/Fibonacci", None),
            ),
        )
    )
)
@pytest.mark.essential
def test_models_mean_what_was_seen(seen: Snapshot) -> None:
    """Whatever the names are: all ends, types, QoS and parameters come back."""
    with tempfile.TemporaryDirectory() as folder:
        problems = import_into(Path(folder), seen).problems
        found = described(Path(folder) / "robot.system")
    left_out = [problem for problem in problems if "left out" in problem]
    if not left_out:
        assert found == {each.full_name: _described(each) for each in seen.nodes}
    assert all("its value is not a text" in problem for problem in left_out)


def _described(seen: SeenNode) -> Described:
    return Described(
        {
            (end.kind.word, end.name, end.type): policies(end.qos) if end.qos else None
            for end in seen.ends
        },
        {each.name: (each.type.value, each.value) for each in seen.parameters or ()},
    )


def test_special_doubles_come_back(tmp_path: Path) -> None:
    """NaN is not equal to itself, so no drawn snapshot has it."""
    value = (math.nan, math.inf, -math.inf, -0.0)
    seen = SeenParameter("p", ParameterType.DOUBLE_ARRAY, value)
    import_into(tmp_path, Snapshot((node("/n", parameters=(seen,)),)))
    (_, found) = described(tmp_path / "robot.system")["/n"].parameters["p"]
    assert list(map(repr, found)) == list(map(repr, value))
