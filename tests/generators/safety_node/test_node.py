"""The safety node as a node type."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.diagnostics import SourceFile, Span
from deros.generators.safety_node.node import safety_node
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import InterfaceType
from deros.metamodels.load import Repository
from deros.models.common import QosProfile
from deros.models.node import NodeType, PortKind
from deros.models.rules import Rules
from deros.rules.compiler.build import build
from deros.rules.compiler.scope.topics import SystemTopics
from deros.rules.program.ir import Program

MODELS = Path(__file__).resolve().parent / "python/models"
RULES = SourceFile("rules.deros", "")


def node_of(name: str, **options: str) -> NodeType:
    """Return the safety node of one of the models."""
    loaded = Repository().load(MODELS / f"{name}.deros")
    assert isinstance(loaded.model, Rules)
    built = build(loaded.model, InterfaceStore())
    assert built.program is not None
    return safety_node(built.program, built.topics, options, loaded.model.source)


def named(name: str, **options: str) -> NodeType:
    """Return the safety node of an empty program with that name."""
    program = Program(name, (), (), (), (), ())
    return safety_node(program, SystemTopics(()), options, RULES)


@pytest.mark.parametrize(
    ("stem", "package"),
    [
        ("robot", "robot_safety"),
        ("robot_safety", "robot_safety"),
        ("My-Robot.v2", "my_robot_v2_safety"),
        ("2wheels", "rules_2wheels_safety"),
        ("__", "rules_safety"),
    ],
)
def test_package_is_named_after_the_rules(stem: str, package: str) -> None:
    """For any file name, package and node have valid ROS 2 names."""
    node = named(stem)
    assert (node.package, node.name) == (package, f"{package}_node")


def test_options_set_package_and_node_name() -> None:
    """The node name follows the package name unless it is given too."""
    assert named("robot", package="guard").name == "guard_node"
    node = named("robot", package="guard", node="watchdog")
    assert (node.package, node.name) == ("guard", "watchdog")


@pytest.mark.parametrize("options", [{"package": "No-Package"}, {"node": "a/b"}])
def test_invalid_name_is_rejected_with_the_reason(options: dict[str, str]) -> None:
    """The error says which character ROS 2 does not accept."""
    with pytest.raises(ValueError, match="contains"):
        named("robot", **options)


def test_ports_follow_from_the_rules() -> None:
    """One publisher per bound topic, a heartbeat, one subscription per input topic, a reset."""
    node = node_of("every_thing")
    assert [(port.kind, port.name, port.type.short) for port in node.ports] == [
        (PortKind.PUBLISHER, "/stop", "std_msgs.Bool"),
        (PortKind.PUBLISHER, "/limit", "std_msgs.Float64"),
        (PortKind.PUBLISHER, "~/heartbeat", "std_msgs.UInt64"),
        (PortKind.PUBLISHER, "~/events", "diagnostic_msgs.DiagnosticStatus"),
        (PortKind.PUBLISHER, "~/diagnostics", "diagnostic_msgs.DiagnosticArray"),
        (PortKind.SUBSCRIPTION, "/speed", "std_msgs.Float64"),
        (PortKind.SUBSCRIPTION, "/odom", "nav_msgs.Odometry"),
        (PortKind.SUBSCRIPTION, "/imu", "sensor_msgs.Imu"),
        (PortKind.SUBSCRIPTION, "/joints", "sensor_msgs.JointState"),
        (PortKind.SUBSCRIPTION, "/diagnostics", "diagnostic_msgs.DiagnosticStatus"),
        (PortKind.SUBSCRIPTION, "/mode", "std_msgs.UInt8"),
        (PortKind.SERVICE, "~/reset", "std_srvs.Trigger"),
    ]


def test_diagnostics_topic_is_private_if_the_rules_use_the_common_one() -> None:
    """A node description cannot distinguish two ports of one name."""
    assert node_of("two_rules").port("/diagnostics") is not None
    assert node_of("every_thing").port("~/diagnostics") is not None


def test_parameters_are_fixed_except_for_optional_behaviours() -> None:
    """Latches have a file; optional behaviours can be switched at run time."""
    read_only = {
        parameter.name: parameter.read_only for parameter in node_of("every_thing").parameters
    }
    assert read_only == {
        "publish_freq": True,
        "startup_grace": True,
        "state_file": True,
        "diagnostics_freq": True,
        "realtime_priority": True,
        "lock_memory": True,
        "garbage_collection": True,
        "behaviours.speeding.enabled": False,
    }
    assert node_of("two_rules").parameter("state_file") is None


def test_node_without_latches_has_no_reset_service() -> None:
    """There is nothing to reset."""
    assert node_of("two_rules").port("~/reset") is None


def test_services_of_actions_have_clients() -> None:
    """One for each service, under the name that the rules give it."""
    node = node_of("calls")
    assert [(port.name, port.type.short) for port in node.ports_of(PortKind.CLIENT)] == [
        ("/arm", "std_srvs.SetBool"),
        ("/brake", "std_srvs.Trigger"),
    ]


def test_states_reach_late_subscribers() -> None:
    """Bound topics are reliable and transient local, with depth 1."""
    port = node_of("every_thing").port("/stop")
    assert port is not None
    assert port.qos == QosProfile(reliability="reliable", durability="transient_local", depth=1)


@pytest.mark.parametrize(
    ("topic", "qos"),
    [
        ("/speed", QosProfile(reliability="reliable", depth=10)),
        ("/mode", QosProfile(reliability="reliable", durability="transient_local", depth=10)),
        ("/imu", QosProfile(reliability="best_effort", depth=10)),
        ("/odom", QosProfile(reliability="best_effort", depth=10)),
        ("/diagnostics", QosProfile(reliability="best_effort", depth=10)),
    ],
)
def test_subscription_requests_no_more_than_is_offered(topic: str, qos: QosProfile) -> None:
    """It is reliable or durable only if every publisher in the system is."""
    port = node_of("every_thing").port(topic)
    assert port is not None
    assert port.qos == qos


def test_spans_of_ports_are_in_the_rules() -> None:
    """A diagnostic about a port points at its input or action."""
    node = node_of("every_thing")
    stop, speed = node.port("/stop"), node.port("/speed")
    assert stop is not None
    assert speed is not None
    assert (Path(stop.name_span.file).name, stop.name_span.line) == ("every_thing.deros", 3)
    assert speed.name_span.line == 11


def test_empty_program_gives_a_node() -> None:
    """Without rules there is a heartbeat, and no action."""
    node = named("empty")
    assert [port.name for port in node.ports] == ["~/heartbeat", "~/events", "/diagnostics"]
    assert node.ports[0].type == InterfaceType("std_msgs", "msg", "UInt64")
    assert node.span == Span(RULES, 0, 0)
