"""Gates of the rules become gates of the program: topics, periods, actions, converted limits."""

from __future__ import annotations

import struct
from pathlib import Path

import pytest

from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import FieldType, InterfaceType
from deros.metamodels.load import Repository
from deros.models.rules import Rules
from deros.names.names import check_node_name
from deros.rules.compiler.build import build
from deros.rules.program import ir
from deros.systems.safety_nodes import gate_node_name
from tests.support.rules import build_rules, program

ACTIONS = """
action stop publishes true on /stop : std_msgs.Bool latched;
action slow publishes true on slow : std_msgs.Bool latched;
"""
LOST = "lost input for 1 sec: zero;"


def _gate(text: str, declarations: str = "") -> ir.Gate:
    (gate,) = program(f"{ACTIONS}{declarations}\n{text}").gates
    return gate


def _limit(text: str, kind: str = "geometry_msgs.Twist", declarations: str = "") -> ir.Limit:
    gate = _gate(f"gate /a -> /b : {kind} rate 20 Hz {{ stop: limit {text}; }}", declarations)
    (limit,) = gate.lines[0].limits
    return limit


def _findings(text: str) -> list[tuple[str, str, str]]:
    findings = build_rules(f"{ACTIONS}{text}").diagnostics
    return [(each.code.name, each.span.text, each.message) for each in findings]


def test_gate_is_built_with_topics_and_lines() -> None:
    """Relative topics are put under the root; lines keep their order, actions are indices."""
    gate = _gate(
        """gate nav -> /cmd_vel : geometry_msgs.Twist rate 20 Hz "The drive" {
          slow: limit linear.x to [-0.1, 0.1]; stop: zero;
          lost heartbeat for 0.3 sec: zero; lost input for 500 ms: limit linear.x to [0, 0]; }"""
    )
    assert (gate.index, gate.sources, gate.target) == (0, (ir.Source("/nav"),), "/cmd_vel")
    assert gate.type == InterfaceType("geometry_msgs", "msg", "Twist")
    assert (gate.period_ns, gate.description) == (50_000_000, "The drive")
    assert [(line.action, line.lost, line.lost_ns) for line in gate.lines] == [
        (1, None, None),
        (0, None, None),
        (None, "heartbeat", 300_000_000),
        (None, "input", 500_000_000),
    ]
    assert [len(line.limits) for line in gate.lines] == [1, 0, 0, 1]


def test_gates_are_numbered_in_source_order() -> None:
    """Each gate has its index."""
    text = "".join(
        f"gate /a -> /b{n} : geometry_msgs.Twist rate 1 Hz {{ {LOST} }}\n" for n in range(3)
    )
    assert [(gate.index, gate.target) for gate in program(text).gates] == [
        (0, "/b0"),
        (1, "/b1"),
        (2, "/b2"),
    ]


@pytest.mark.parametrize(
    ("rate", "period_ns"),
    [("20 Hz", 50_000_000), ("30 Hz", 33_333_333), ("1 kHz", 1_000_000)],
)
def test_gate_period_is_rounded_down(rate: str, period_ns: int) -> None:
    """Zeros are published at the rate or slightly faster, never slower."""
    assert (
        _gate(f"gate /a -> /b : geometry_msgs.Twist rate {rate} {{ {LOST} }}").period_ns
        == period_ns
    )


@pytest.mark.parametrize(
    ("text", "ends"),
    [
        ("linear.x to [-0.1, 0.1] m/s", (-0.1, 0.1)),
        ("linear.x to [-0.1, 0.1]", (-0.1, 0.1)),
        ("linear.x to [-36, 36] km/h", (-10.0, 10.0)),
        ("linear.x to [-10 cm/s, 0.2] m/s", (-0.1, 0.2)),
        ("linear.x to [-10 cm/s, 0.2 m/s]", (-0.1, 0.2)),
        ("angular.z to [0, 180] deg/s", (0.0, 3.141592653589793)),
        ("linear.x to [-low, high]", (-0.5, 1.0)),
        ("linear.x to [-low, high] km/h", (-0.5, 1.0)),
        ("linear.x to [-plain, 0] cm/s", (-0.03, 0.0)),
        ("linear.x to [-2 pace, 0]", (-1.0, 0.0)),
    ],
)
def test_limits_are_converted_to_the_unit_of_the_field(
    text: str, ends: tuple[float, float]
) -> None:
    """The conversion is exact; a unit at a bound overrides the one after the interval."""
    declarations = """unit pace = 0.5 m/s
    const low = 50 cm/s const high = 3.6 km/h const plain = 3"""
    limit = _limit(text, declarations=declarations)
    assert (limit.lower, limit.upper) == ends
    assert limit.type == FieldType("float64")


def test_limits_of_a_field_without_a_unit() -> None:
    """They stay as written, and two units are converted to one."""
    limit = _limit("data to [-1 deg, 90 deg]", "std_msgs.Float64")
    assert (limit.lower, limit.upper) == (-1.0, 90.0)
    limit = _limit("data to [-1 m, 90 cm]", "std_msgs.Float64")
    assert (limit.lower, limit.upper) == (-1.0, 0.9)


def test_limit_uses_the_unit_from_a_node_description(tmp_path: Path) -> None:
    """The description of the target's subscriber determines the unit of the field."""
    files = {
        "pump.rnd": "node pump : p\nsubscribes\n  topic flow : std_msgs.Float64 { data [m/s] }\n",
        "a.system": 'system S\nimports\n  import "pump.rnd"\ntopics\n  topic /flow\n'
        "node pump : pump\nwirings\n  connect flow to /flow\n",
        "a.deros": 'use "a.system" import S\naction stop publishes true on /s : std_msgs.Bool;\n'
        "gate /wish -> /flow : std_msgs.Float64 rate 1 Hz "
        "{ stop: limit data to [0, 36] km/h; }\n",
    }
    for name, text in files.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    rules = Repository().load(str(tmp_path / "a.deros")).model
    assert isinstance(rules, Rules)
    built = build(rules, InterfaceStore((), prefixes=())).program
    assert built is not None
    assert built.gates[0].lines[0].limits[0].upper == 10.0


def test_limits_are_representable_in_the_field() -> None:
    """Rounded to a float32, cut to the range of an integer; integers stay integers."""
    narrow = _limit("data to [-0.1, 0.1]", "std_msgs.Float32")
    assert narrow.upper == struct.unpack("<f", struct.pack("<f", 0.1))[0]
    whole = _limit("data to [-5, 300]", "std_msgs.UInt8")
    assert (whole.lower, whole.upper) == (0, 255)
    assert isinstance(whole.lower, int)


def test_limits_of_elements_and_nested_fields() -> None:
    """Paths may contain arrays and messages."""
    limit = _limit("points[1].velocities[0] to [0, 1]", "trajectory_msgs.JointTrajectory")
    assert limit.path == ("points", 1, "velocities", 0)


def test_message_constants_as_limits() -> None:
    """Constants of the message may be bounds of limits."""
    limit = _limit("level to [OK, WARN]", "diagnostic_msgs.DiagnosticStatus")
    assert (limit.lower, limit.upper) == (0, 1)


def test_limit_of_a_whole_array_is_an_error() -> None:
    """An index is needed."""
    text = "gate /a -> /b : std_msgs.Float64MultiArray rate 1 Hz { stop: limit data to [0, 1]; }"
    assert _findings(text) == [
        ("DRS303", "data", "a number is needed here, but 'data' is a float64[]"),
    ]


def test_array_layout_cannot_be_limited() -> None:
    """It does not command anything."""
    text = """gate /a -> /b : std_msgs.Float64MultiArray rate 1 Hz {
      stop: limit layout.data_offset to [0, 1]; }"""
    assert [finding[0] for finding in _findings(text)] == ["DRS337"]


def test_incompatible_unit_of_one_bound_is_an_error() -> None:
    """The span is that bound."""
    text = "gate /a -> /b : geometry_msgs.Twist rate 1 Hz { stop: limit linear.x to [-1, 1 rad]; }"
    assert [finding[:2] for finding in _findings(text)] == [("DRS306", "1 rad")]


def test_limit_read_from_a_topic_is_an_error_if_it_does_not_always_hold() -> None:
    """Only a limit that always holds changes while the gate runs."""
    text = """input v = topic /speed.data timeout 1 sec
    gate /a -> /b : geometry_msgs.Twist rate 1 Hz { stop: limit linear.x to [0, v]; }"""
    assert _findings(text) == [
        ("DRS360", "v", "'v' may only be the end of a limit that always holds"),
    ]


def _standing(text: str, kind: str = "geometry_msgs.Twist") -> ir.Limit:
    inputs = """input v = topic /speed.data [km/h] timeout 1 sec
    const most = 36 km/h tunable in [0, 72] km/h"""
    gate = _gate(f"gate /a -> /b : {kind} rate 20 Hz {{ always: limit {text}; {LOST} }}", inputs)
    (limit,) = gate.lines[0].limits
    return limit


def test_ends_read_from_a_topic_are_converted() -> None:
    """The factor has the sign, too; the timeout is that of the input."""
    limit = _standing("linear.x to [-v, v]")
    lower, upper = limit.ends
    assert isinstance(lower, ir.InputBound)
    assert isinstance(upper, ir.InputBound)
    assert (lower.topic, lower.path, lower.timeout_ns) == ("/speed", ("data",), 10**9)
    assert (lower.factor, upper.factor) == (-1 / 3.6, 1 / 3.6)
    assert lower.key == upper.key


def test_tuned_end_is_converted() -> None:
    """It is a factor of the constant, which keeps its unit."""
    upper = _standing("linear.x to [-1 m/s, most]").upper
    assert isinstance(upper, ir.TunedBound)
    assert (upper.constant.default, upper.factor) == (36.0, 1 / 3.6)


def test_inputs_of_limits_are_no_inputs_of_the_safety_node() -> None:
    """The gate alone subscribes to them."""
    built = program(
        f"""{ACTIONS}input v = topic /speed.data [m/s] timeout 1 sec
        gate /a -> /b : geometry_msgs.Twist rate 20 Hz {{
        always: limit linear.x to [-v, v]; {LOST} }}"""
    )
    assert built.inputs == ()
    assert [each.topic for each in built.gates[0].inputs] == ["/speed"]


def test_type_with_an_unknown_part_is_an_error(tmp_path: Path) -> None:
    """A gate creates zeros of whole messages, so every part of the type must be known."""
    folder = tmp_path / "my_msgs" / "msg"
    folder.mkdir(parents=True)
    (folder / "Wish.msg").write_text("float64 speed\nother_msgs/Extra extra\n", encoding="utf-8")
    text = f"gate /a -> /b : my_msgs.Wish rate 1 Hz {{ {LOST} }}"
    rules = Repository().load_text("a.deros", text).model
    assert isinstance(rules, Rules)
    findings = build(rules, InterfaceStore((tmp_path,), prefixes=())).diagnostics
    assert [(each.code.name, each.message) for each in findings] == [
        ("DRS101", "unknown interface package 'other_msgs'"),
    ]


def test_invalid_gate_topics_are_errors() -> None:
    """Each is reported; private topics belong to a node, and a gate is between two nodes."""
    assert _findings(f"gate ~/a -> /b/2c : geometry_msgs.Twist rate 1 Hz {{ {LOST} }}") == [
        ("DRS332", "~/a", "the topic '~/a' is private: rules name the topics of other nodes"),
        ("DRS332", "/b/2c", "the topic '/b/2c' has a part that starts with a digit ('2c')"),
    ]


def test_optional_behaviours_are_marked() -> None:
    """The keyword reaches the program."""
    built = program(
        """entity e { r: topic /flag.data; }
        optional behaviour a: if e.r then { log_state("a"); };
        behaviour b: if e.r then { log_state("b"); };"""
    )
    assert [(behaviour.name, behaviour.optional) for behaviour in built.behaviours] == [
        ("a", True),
        ("b", False),
    ]


@pytest.mark.parametrize(
    ("target", "name"),
    [
        ("/cmd_vel", "cmd_vel_gate"),
        ("/front/cmd_vel", "front_cmd_vel_gate"),
        ("cmd_vel", "cmd_vel_gate"),
        ("/_0", "topic_0_gate"),
        ("/_", "topic_gate"),
    ],
)
def test_gate_node_is_named_after_its_target(target: str, name: str) -> None:
    """It is derived from the target."""
    assert gate_node_name(target) == name
    assert check_node_name(name) is None
