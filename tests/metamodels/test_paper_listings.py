"""The listings of the paper parse as printed and have the meaning that the paper gives."""

from __future__ import annotations

from decimal import Decimal
from pathlib import Path

import pytest

from deros import codes
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.node import NodeType, ParameterType, PortKind
from deros.models.rules import (
    And,
    Behaviour,
    Call,
    Comparison,
    For,
    Membership,
    NamePath,
    Negative,
    Number,
    Or,
    Rules,
    Truth,
)
from deros.models.system import NodeInstance, Subsystem, System
from deros.validators.check import check
from tests.support import paper


@pytest.fixture
def system(tmp_path: Path) -> Path:
    """Write the system of figure 12 to disk."""
    return paper.write_system(tmp_path)


def _rules(system: Path, text: str) -> Rules:
    repository = Repository()
    loaded = repository.load_text(system.with_name("paper.deros"), text)
    assert repository.diagnostics == []
    assert isinstance(loaded.model, Rules)
    return loaded.model


@pytest.mark.parametrize("listing", paper.RULES.values(), ids=paper.RULES)
def test_every_listing_loads_without_findings(system: Path, listing: str) -> None:
    """Each DeRoS listing parses as printed and finds the system that it uses."""
    rules = _rules(system, listing)
    assert rules.uses[0].system is not None
    assert rules.uses[0].system.name == "RobotSafety"


@pytest.mark.parametrize("listing", paper.RULES.values(), ids=paper.RULES)
def test_every_listing_checks_without_errors(system: Path, listing: str) -> None:
    """The only findings are about sensors that may fail unnoticed, and a speed backwards."""
    repository = Repository()
    loaded = repository.load_text(system.with_name("paper.deros"), listing)
    findings = check([loaded], repository, InterfaceStore())
    expected = {codes.INPUT_WITHOUT_TIMEOUT}
    expected |= {codes.UNHANDLED_UNKNOWN} if ".roll()" in listing else set()
    expected |= {codes.ONE_WAY_ONLY} if "max_speed_exceeded" in listing else set()
    assert {finding.code for finding in findings} == expected


def test_figure_2_constants_and_inputs_are_exact(system: Path) -> None:
    """Constants keep their exact number and unit; an input is a topic and a field path."""
    rules = _rules(system, paper.FIGURE_2)
    tilt, speed = rules.constants
    assert isinstance(tilt.value, Call)
    assert tilt.value.receiver is None
    assert tilt.value.function.text == "toRad"
    (degrees,) = tilt.value.arguments
    assert isinstance(degrees, Number)
    assert (degrees.value, degrees.unit) == (Decimal(10), "deg")
    assert isinstance(speed.value, Number)
    assert (speed.value.value, speed.value.unit) == (Decimal("0.5"), "m/s")
    orientation, linear_speed = (each.term for each in rules.inputs)
    assert (orientation.topic.text, orientation.path) == ("/fmInformation/imu", ("orientation",))
    assert linear_speed.path == ("twist", "twist", "linear", "x")


def test_figure_2_rules_have_the_described_conditions(system: Path) -> None:
    """``not in`` is a membership of negated constants; ``for`` closes the whole rule."""
    tilt, speed = (entity.rules[0] for entity in _rules(system, paper.FIGURE_2).entities)
    assert isinstance(tilt.condition, Or)
    roll = tilt.condition.operands[0]
    assert isinstance(roll, Membership)
    assert roll.negated
    assert roll.lower_closed
    assert roll.upper_closed
    assert isinstance(roll.lower, Negative)
    assert isinstance(roll.operand, Call)
    assert isinstance(roll.operand.receiver, NamePath)
    assert roll.operand.receiver.name.text == "orientation"
    assert isinstance(speed.condition, For)
    assert isinstance(speed.condition.operand, Comparison)
    assert speed.condition.duration.value == 2
    assert speed.condition.duration.unit == "sec"


def test_figure_2_behaviours_name_rules(system: Path) -> None:
    """A behaviour's condition names a rule of an entity, with its own ``for``."""
    first, second = _rules(system, paper.FIGURE_2).behaviours
    assert isinstance(first.condition, Truth)
    assert isinstance(first.condition.operand, NamePath)
    assert first.condition.operand.path == ("tilt_not_ok",)
    assert isinstance(second.condition, For)
    assert second.condition.duration.value == Decimal("0.4")


def test_section_4_2_delays_the_other_behaviour(system: Path) -> None:
    """In this version of the program the tilt has the duration, not the speed."""
    first, second = _rules(system, paper.SECTION_4_2).behaviours
    assert isinstance(first.condition, For)
    assert isinstance(second.condition, Truth)


def test_figure_9_topic_term_may_span_lines(system: Path) -> None:
    """A topic term may break after a dot, and ``=topic`` needs no space."""
    (linear_speed,) = _rules(system, paper.FIGURE_9).inputs
    assert linear_speed.term.path == ("twist", "twist", "linear", "x")
    assert linear_speed.term.topic.text == "/fmKnowledge/encoder_odom"


def test_figure_11_is_a_node_type(tmp_path: Path) -> None:
    """The node description yields typed parameters and ports of both kinds."""
    path = tmp_path / "ci_safety_node.rnd"
    path.write_text(paper.FIGURE_11, encoding="utf-8")
    loaded = Repository().load(path)
    assert loaded.diagnostics == ()
    node = loaded.model
    assert isinstance(node, NodeType)
    assert (node.name, node.package) == ("ci_safety_node", "ci_safety")
    assert [(p.name, p.type, p.default) for p in node.parameters] == [
        ("time_update_freq", ParameterType.DOUBLE, 10.0),
        ("publish_freq", ParameterType.DOUBLE, 10.0),
        ("upside_down", ParameterType.BOOL, False),
    ]
    assert [(p.kind, p.name, str(p.type)) for p in node.ports] == [
        (PortKind.PUBLISHER, "stop_robot", "std_msgs/msg/Bool"),
        (PortKind.SUBSCRIPTION, "/fmInformation/imu", "sensor_msgs/msg/Imu"),
        (PortKind.SUBSCRIPTION, "/fmKnowledge/encoder_odom", "nav_msgs/msg/Odometry"),
    ]


def test_figure_12_is_a_system(system: Path) -> None:
    """Subsystems nest, nodes find their types across files, a wiring names a parameter."""
    repository = Repository()
    model = repository.load(system).model
    assert repository.diagnostics == []
    assert isinstance(model, System)
    assert [topic.name for topic in model.topics][:2] == [
        "/fmInformation/imu",
        "/fmKnowledge/encoder_odom",
    ]
    (safety,) = model.members
    assert isinstance(safety, Subsystem)
    sensors, processors = safety.members
    assert isinstance(sensors, Subsystem)
    assert isinstance(processors, Subsystem)
    (imu,) = sensors.members
    assert isinstance(imu, NodeInstance)
    assert imu.type is model.node_types["vectornav_vn100_node"]
    assert [(p.name, p.value) for p in imu.parameters] == [
        ("publish_topic_id", "/fmInformation/imu"),
        ("frame_id", "imu_link"),
    ]
    assert [(w.port, w.target) for w in imu.wirings] == [("publish_topic_id", "/fmInformation/imu")]
    odometry = processors.members[-1]
    assert isinstance(odometry, NodeInstance)
    assert odometry.type_name == "odometry_node"
    assert odometry.type is not None


def test_section_6_3_conditions_nest_as_written(system: Path) -> None:
    """``if((a and b and c) or d)`` nests as its parentheses say; bodies keep their order."""
    rules = _rules(system, paper.SECTION_6_3)
    tilt = rules.entities[0].rules[0].condition
    assert isinstance(tilt, For)
    assert tilt.duration.value == 4
    assert tilt.duration.unit == "sec"
    assert rules.constants[0].value.arguments[0].value == -8  # type: ignore[union-attr]
    exceeded = rules.behaviours[1]
    assert isinstance(exceeded, Behaviour)
    assert isinstance(exceeded.condition, Or)
    assert isinstance(exceeded.condition.operands[0], And)
    assert len(exceeded.condition.operands[0].operands) == 3
    names = [item.action.text for item in exceeded.body]  # type: ignore[union-attr]
    assert names == ["motor_stop", "stop", "log_state"]
