"""Comparisons: exact bounds, units, kinds of values, ages."""

from __future__ import annotations

import math
from decimal import Decimal
from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.rules import Rules
from deros.rules.compiler.build import build
from deros.rules.engine.evaluate import COMPARE
from deros.rules.program import ir, walk
from deros.rules.program.bounds import as_float32, integer_bound
from tests.support.profiles import scaled
from tests.support.rules import condition, embedded_store, program

SPEED = "topic /odom.twist.twist.linear.x"
TURN = "topic /imu.angular_velocity.z"
MODE = "topic /mode.data"


def bound(text: str, declarations: str = "") -> ir.Scalar:
    """Return the constant that a rule compares with."""
    parsed_condition = condition(text, declarations)
    assert isinstance(parsed_condition, ir.Compare)
    assert isinstance(parsed_condition.right, ir.Const)
    return parsed_condition.right.value


@pytest.mark.parametrize(
    ("text", "value"),
    [
        (f"{SPEED} > 0.5", 0.5),
        (f"{SPEED} > 0.5 m/s", 0.5),
        (f"{SPEED} > 1.8 km/h", 0.5),
        (f"{SPEED} > 30 cm/s", 0.3),
        (f"{TURN} > 90 deg/s", math.pi / 2.0),
        (f"{TURN} > -90 deg/s", -math.pi / 2.0),
        ("topic /imu.orientation.roll() > toRad(10 deg)", math.radians(10)),
        ("topic /imu.orientation.roll() > toRad(10)", math.radians(10)),
        ("topic /imu.orientation.roll() > toDeg(0.2 rad)", 0.2),
        ("topic /imu.orientation.roll() > 0.2", 0.2),
        ("topic /speed.data > toRad(180 deg)", math.pi),
        ("topic /speed.data > toDeg(1)", math.degrees(1)),
        ("topic /speed.data > 10 deg", 10.0),
    ],
)
def test_constant_is_converted_to_the_unit_of_the_field(text: str, value: float) -> None:
    """It is converted exactly and rounded once; without a unit it is kept as written."""
    assert bound(text) == value


def test_user_defined_unit_is_converted() -> None:
    """A unit defined in the rules converts like any other."""
    declarations = "unit pace = 0.514444 m/s  const limit = 2 pace"
    assert bound(f"{SPEED} > limit", declarations) == 1.028888


def test_temperature_units_have_an_offset() -> None:
    """A field in degrees Celsius is compared with kelvins and degrees Fahrenheit."""
    assert bound("topic /battery.temperature > 300 K") == as_float32(26.85)
    assert bound("topic /battery.temperature > 68 degF") == 20.0


@settings(max_examples=scaled(25))
@given(st.decimals(-1000, 1000, allow_nan=False, places=6))
def test_decimal_is_rounded_once(value: Decimal) -> None:
    """A written number becomes the nearest double."""
    assert bound(f"topic /speed.data > {value:f}") == float(value)


@given(
    value=st.integers(-300, 300),
    number=st.fractions(-300, 300, max_denominator=8),
    operator=st.sampled_from(sorted(COMPARE)),
)
def test_integer_bound_is_equivalent(value: int, number: Fraction, operator: ir.Operator) -> None:
    """For every integer, the comparison with an integer bound has the exact verdict."""
    brought, limit = integer_bound(operator, number)
    assert COMPARE[brought](value, limit) is COMPARE[operator](Fraction(value), number)


def test_integer_bounds_are_exact_beyond_doubles() -> None:
    """A number that only rounds to an integer is not treated as one."""
    operator, limit = integer_bound("=", Fraction(2**60) + Fraction(1, 2))
    assert (operator, limit) == ("=", 0.5)
    assert integer_bound(">", Fraction(2**63 - 1)) == (">", 2**63 - 1)


@pytest.mark.parametrize(
    ("text", "operator", "value"),
    [
        (f"{MODE} > 2.5", ">", 2),
        (f"{MODE} >= 2.5", ">=", 3),
        (f"{MODE} < 2.5", "<", 3),
        (f"{MODE} <= 2.5", "<=", 2),
        (f"{MODE} = 2.5", "=", 2.5),
        (f"{MODE} == 2", "=", 2),
        (f"2 <= {MODE}", ">=", 2),
        (f"2.5 < {MODE}", ">", 2),
        (f"2 != {MODE}", "!=", 2),
    ],
)
def test_bound_of_an_integer_field_becomes_an_integer(
    text: str, operator: str, value: float
) -> None:
    """The bound becomes an integer, and a constant on the left moves to the right."""
    assert condition(text) == ir.Compare(ir.Read(0), operator, ir.Const(value))  # type: ignore[arg-type]
    assert type(bound(text)) is type(value)


@pytest.mark.parametrize(
    ("text", "within"),
    [
        (f"{MODE} in [1.5, 3.5]", (2, 3, True, True)),
        (f"{MODE} in (1, 3.5)", (1, 3, False, True)),
        ("topic /speed.data in (1, 2]", (1.0, 2.0, False, True)),
        ("topic /speed.data in [1, 2)", (1.0, 2.0, True, False)),
    ],
)
def test_interval_bounds_of_integers_are_narrowed(
    text: str, within: tuple[float, float, bool, bool]
) -> None:
    """Bounds stay as written; those of integers are narrowed to integers."""
    lower, upper, lower_closed, upper_closed = within
    expected = ir.Within(ir.Read(0), ir.Const(lower), ir.Const(upper), lower_closed, upper_closed)
    assert condition(text) == expected
    assert condition(text.replace(" in ", " not in ")) == ir.Not(expected)


def test_interval_bounds_may_be_fields() -> None:
    """The bounds may be read from topics."""
    parsed_condition = condition(f"topic /speed.data in [{MODE}, 3]")
    assert parsed_condition == ir.Within(ir.Read(0), ir.Read(1), ir.Const(3.0), True, True)


def test_two_fields_are_compared_in_one_unit() -> None:
    """Fields of one unit compare directly, others through a factor."""
    same = condition(f"{SPEED} > topic /odom.twist.twist.linear.y")
    assert same == ir.Compare(ir.Read(0), ">", ir.Read(1))
    stamp = "topic /imu.header.stamp"
    scaled = condition(f"{stamp}.sec > {stamp}.nanosec")
    assert scaled == ir.Compare(ir.Read(0), ">", ir.Scale(ir.Read(1), 1e-9))


def test_message_constant_by_name() -> None:
    """An undeclared name may be a constant of the message on the other side."""
    status = "topic /status.level"
    assert condition(f"{status} = ERROR") == ir.Compare(ir.Read(0), "=", ir.Const(2))
    assert condition(f"WARN != {status}") == ir.Compare(ir.Read(0), "!=", ir.Const(1))
    assert bound(f"{status} = ERROR", "const ERROR = 7") == 7


def test_numeric_message_constants_are_ordered() -> None:
    """Levels are compared as levels: at least a warning."""
    parsed_condition = condition("topic /status.level >= WARN")
    assert parsed_condition == ir.Compare(ir.Read(0), ">=", ir.Const(1))


def test_booleans_and_strings_can_be_compared() -> None:
    """A boolean may stand alone or be compared; a string is compared."""
    flag = "topic /flag.data"
    assert condition(flag) == ir.Truth(ir.Read(0))
    assert condition(f"{flag} != true") == ir.Compare(ir.Read(0), "!=", ir.Const(True))
    assert condition('topic /name.data = "go"') == ir.Compare(ir.Read(0), "=", ir.Const("go"))
    assert condition("true") == ir.Truth(ir.Const(True))


def test_missing_can_be_compared_with_a_boolean() -> None:
    """`missing()` may be compared with true and false."""
    declared = "input v = topic /speed.data timeout 1 sec"
    assert condition("v.missing() = false", declared) == ir.Not(ir.Missing(0))
    assert condition("v.missing() != false", declared) == ir.Missing(0)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("v.age() > 0.4 sec", ir.Age(0, ">", 400_000_000)),
        ("v.age() >= 3 ns", ir.Age(0, ">=", 3)),
        ("v.age() < 2", ir.Age(0, "<", 2_000_000_000)),
        ("1 min < v.age()", ir.Age(0, ">", 60_000_000_000)),
        (
            "v.age() in (1 sec, 2 sec]",
            ir.And((ir.Age(0, ">", 1_000_000_000), ir.Age(0, "<=", 2_000_000_000))),
        ),
        (
            "v.age() not in [1 sec, 2 sec)",
            ir.Not(ir.And((ir.Age(0, ">=", 1_000_000_000), ir.Age(0, "<", 2_000_000_000)))),
        ),
    ],
)
def test_age_is_compared_in_nanoseconds(text: str, expected: ir.Condition) -> None:
    """An age is compared in whole nanoseconds; a plain number is in seconds."""
    assert condition(text, "input v = topic /speed.data timeout 9 sec") == expected


@pytest.mark.parametrize(
    ("duration", "nanoseconds"),
    [("4sec", 4 * 10**9), ("0.1 ms", 10**5), ("2 min", 12 * 10**10), ("0 sec", 0), ("1 ns", 1)],
)
def test_duration_is_exact(duration: str, nanoseconds: int) -> None:
    """Durations are exact in nanoseconds."""
    parsed_condition = condition(f"topic /flag.data for {duration}")
    assert isinstance(parsed_condition, ir.For)
    assert parsed_condition.duration_ns == nanoseconds


# Functions ------------------------------------------------------------------------------------


def test_functions_may_be_nested() -> None:
    """The rate of an angle is an angle per second; each rate has its own memory."""
    declared = "input q = topic /imu.orientation"
    parsed_condition = condition("q.yaw().rate().abs() > 90 deg/s or q.yaw().rate() > 1", declared)
    yaw = ir.Apply("yaw", tuple(ir.Read(leaf) for leaf in range(4)), 0)
    turn = ir.Const(2.0 * math.pi)
    ways = [ir.Apply("unwrapped", (yaw, turn), 0, state) for state in (0, 2)]
    rates = [ir.Apply("rate", (way,), 0, state) for way, state in zip(ways, (1, 3), strict=True)]
    first = ir.Apply("abs", (rates[0],), 0)
    assert isinstance(parsed_condition, ir.Or)
    assert parsed_condition.operands[0] == ir.Compare(first, ">", ir.Const(math.pi / 2.0))
    assert parsed_condition.operands[1] == ir.Compare(rates[1], ">", ir.Const(1.0))


def test_norm_has_the_unit_of_its_components() -> None:
    """The norm of a velocity is a speed."""
    parsed_condition = condition("topic /odom.twist.twist.linear.norm() > 3.6 km/h")
    reads = tuple(ir.Read(leaf) for leaf in range(3))
    assert parsed_condition == ir.Compare(ir.Apply("norm", reads, 0), ">", ir.Const(1.0))


def test_nearest_reads_ranges_and_geometry() -> None:
    """The function handles NaN beams; NaN in the geometry of the scan makes it unknown."""
    built = program("entity e { r: topic /scan.nearest(-30 deg, 0.5) < 40 cm; }")
    assert [(leaf.path, leaf.nan_is_unknown) for leaf in built.leaves] == [
        (("ranges",), False),
        (("angle_min",), True),
        (("angle_increment",), True),
        (("range_min",), True),
        (("range_max",), True),
    ]
    leaves = [ir.Read(leaf) for leaf in range(5)]
    bearings = ir.Const(-0.5235987755982989), ir.Const(0.5)
    nearest = ir.Apply("nearest", (*leaves, *bearings, ir.Const(False)), 0)
    assert built.rules[0].condition == ir.Compare(nearest, "<", ir.Const(as_float32(0.4)))


def test_scan_of_a_driver_that_reports_zero_for_nothing() -> None:
    """`no_return 0` at the input is the last argument of each function of its sectors."""
    built = program(
        "input mud = topic /scan no_return 0 input scan = topic /scan"
        " entity e { r: mud.blind(0, 1) > 0.5 or scan.blind_gap(0, 1) > 5 deg; }"
    )
    values = [each for each in walk.values(walk.conditions(built)) if isinstance(each, ir.Apply)]
    assert [(each.function, each.arguments[-1]) for each in values] == [
        ("blind", ir.Const(True)),
        ("blind_gap", ir.Const(False)),
    ]


def test_count_ignores_nan_unless_another_function_does_not() -> None:
    """`count()` alone accepts any elements; with `max()` a NaN makes the array unknown."""
    declared = "input p = topic /joints.position"
    counted = program(f"{declared} entity e {{ r: p.count() > 3; }}")
    assert [leaf.nan_is_unknown for leaf in counted.leaves] == [False]
    both = program(f"{declared} entity e {{ r: p.count() > 3 and p.max() > 1; }}")
    assert [leaf.nan_is_unknown for leaf in both.leaves] == [True]


def test_count_applies_to_any_array() -> None:
    """Arrays of strings and messages have a length too."""
    built = program(
        "entity e { r: topic /joints.name.count() != 6; s: /status.values.count() > 1; }"
    )
    assert [str(leaf.type) for leaf in built.leaves] == [
        "string[]",
        "diagnostic_msgs/msg/KeyValue[]",
    ]


def test_unit_may_come_from_a_node_description(tmp_path: Path) -> None:
    """A node description gives the unit of a field without a convention, also of elements."""
    (tmp_path / "gauge.rnd").write_text(
        "node gauge : gauges publishes"
        " topic depth : std_msgs.Float64 { data [cm] }"
        " topic depths : std_msgs.Float64MultiArray { data [mm] }"
    )
    (tmp_path / "Tank.system").write_text(
        'system Tank imports import "gauge.rnd" node gauge : gauge'
    )
    text = (
        'use "Tank.system" import Tank entity e {'
        " one: /depth.data > 2 m; each: /depths.data[3] > 2 m; all: /depths.data.max() > 1 cm; }"
    )
    model = Repository().load_text(tmp_path / "x.deros", text).model
    assert isinstance(model, Rules)
    built = build(model, embedded_store()).program
    assert built is not None
    bounds = [
        rule.condition.right for rule in built.rules if isinstance(rule.condition, ir.Compare)
    ]
    assert bounds == [ir.Const(200.0), ir.Const(2000.0), ir.Const(10.0)]


def test_functions_apply_to_user_defined_messages(tmp_path: Path) -> None:
    """A message with only x and y is a plane vector, and a bounded array has a maximum length."""
    (tmp_path / "shapes" / "msg").mkdir(parents=True)
    definition = "float64 x\nfloat64 y\n"
    (tmp_path / "shapes" / "msg" / "Flat.msg").write_text(definition)
    (tmp_path / "shapes" / "msg" / "Few.msg").write_text(
        "Flat flat\nint32[<=4] few\nint32[3] three"
    )
    (tmp_path / "S.system").write_text("system S topics external topic /few : shapes.Few")
    text = (
        'use "S.system" import S entity e {'
        " far: /few.flat.norm() > 2; four: /few.few.count() = 4; three: /few.three.count() = 3; }"
    )
    model = Repository().load_text(tmp_path / "x.deros", text).model
    assert isinstance(model, Rules)
    result = build(model, InterfaceStore([tmp_path], prefixes=()))
    assert result.program is not None
    norm = ir.Apply("norm", (ir.Read(0), ir.Read(1), ir.Const(0.0)), 0)
    assert result.program.rules[0].condition == ir.Compare(norm, ">", ir.Const(2.0))
    assert [comparison.operand.bounds for comparison in result.comparisons] == [
        (0, math.inf),
        (0, 4),
        (3, 3),
    ]


@pytest.mark.parametrize("number", ["1 m/s", "0.5", ".5 m/s", "1e-3 m/s"])
def test_space_may_follow_a_minus_sign(number: str) -> None:
    """The number is the same, as a bound, in an interval, and behind another operation."""
    declared = "input v = topic /odom.twist.twist.linear.x timeout 1 sec"
    for text in ("v > -{}", "v in [-{}, 5]", "v + v > -{}", "not v <= -{}"):
        spaced = condition(text.replace("-", "- ").format(number), declared)
        assert spaced == condition(text.format(number), declared)
