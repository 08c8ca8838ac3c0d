"""Arithmetic becomes one formula: its operators, units and bounds, and what of it is refused."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from deros import codes
from deros.diagnostics import Diagnostic
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.rules import Rules
from deros.rules.compiler.build import BuildResult, build
from deros.rules.compiler.terms.operations import usage_table
from deros.rules.engine.engine import Engine
from deros.rules.functions.function_forms import strict
from deros.rules.program import ir
from tests.support.rules import build_rules, program

HEAD = """
input v = topic /odom.twist.twist.linear.x timeout 1 sec
input w = topic /imu.angular_velocity.z timeout 1 sec
input x = topic /odom.pose.pose.position.x timeout 1 sec
input m = topic /mode.data timeout 1 sec
input b = topic /battery.temperature timeout 1 sec
"""


def rule(condition: str, declared: str = "") -> ir.Program:
    """Return a program with a rule."""
    text = f"{HEAD}{declared} action a; entity e {{ r: {condition}; }} if e.r then {{ a; }};"
    return program(text)


def side(condition: str, declared: str = "") -> ir.Compute:
    """Return the left side of a comparison, which is arithmetic."""
    compare = rule(condition, declared).rules[0].condition
    assert isinstance(compare, ir.Compare)
    assert isinstance(compare.left, ir.Compute)
    return compare.left


def refused(condition: str, declared: str = "") -> tuple[Diagnostic, ...]:
    """Return the findings of a rule that is refused."""
    found = build_rules(f"{HEAD}{declared} entity e {{ r: {condition}; }}")
    assert found.program is None
    return tuple(found.diagnostics)


def value(text: str, *operands: float, declared: str = "") -> float | None:
    """Return what a term gives for the values of its operands, in the order written."""
    found = side(f"{text} > 0", declared)
    return strict(found.formula, found.names, *operands)


OPERATIONS = (
    ("m + 2 * 3", (1.0,), 7.0),
    ("(m + 2) * 3", (1.0,), 9.0),
    ("m - 2 - 3", (10.0,), 5.0),
    ("m - (2 - 3)", (10.0,), 11.0),
    ("m / 2 / 4", (16.0,), 2.0),
    ("m / (2 / 4)", (16.0,), 32.0),
    ("-m * 2", (3.0,), -6.0),
    ("-(m - 5)", (3.0,), 2.0),
    ("2 - -m", (3.0,), 5.0),
    ("m -3", (5.0,), 2.0),
    ("abs(m - 5)", (3.0,), 2.0),
    ("min(m, 4, 2)", (3.0,), 2.0),
    ("max(m, 4, 2)", (3.0,), 4.0),
    ("sqrt(m * 4)", (9.0,), 6.0),
    ("hypot(m, 4)", (3.0,), 5.0),
    ("hypot(m, 4, 12)", (3.0,), 13.0),
    ("sin(m) + cos(m)", (0.0,), 1.0),
    ("tan(m)", (0.0,), 0.0),
    ("atan2(m, 0)", (1.0,), math.pi / 2.0),
    ("m * sqrt(4)", (3.0,), 6.0),
    ("m * min(3, 2)", (3.0,), 6.0),
)


def test_operators_and_functions() -> None:
    """Each gives what mathematics says, in the order that the text says."""
    for text, operands, expected in OPERATIONS:
        assert value(text, *operands) == expected, text


@pytest.mark.parametrize(
    ("text", "operand"),
    [
        ("1 / m", 0.0),
        ("1 / (m - 2)", 2.0),
        ("sqrt(m - 2)", 1.0),
        ("m - m", math.inf),
        ("m * 0", math.inf),
        ("sin(m)", math.inf),
        ("max(m / m, 1)", 0.0),
        ("abs(1 / m)", 0.0),
    ],
)
def test_what_has_no_value_is_unknown(text: str, operand: float) -> None:
    """A part without a value makes the whole unknown."""
    assert value(text, operand) is None


@pytest.mark.parametrize(
    ("text", "operand", "expected"),
    [("1 / m", math.inf, 0.0), ("m + 1", -math.inf, -math.inf), ("m * m", 1e200, math.inf)],
)
def test_infinities_are_values(text: str, operand: float, expected: float) -> None:
    """They are computed with, as IEEE 754 says."""
    assert value(text, operand) == expected


def test_units_are_converted_where_they_differ() -> None:
    """The right operand takes the unit of the left one; constants are converted exactly."""
    assert value("x + 30 cm", 1.0) == 1.3
    assert value("x * 1 + 2", 1.0) == 3.0
    assert value("30 cm + x", 1.0) == 130.0
    found = rule("v * 3 sec > 1 km").rules[0].condition
    assert isinstance(found, ir.Compare)
    assert found.right == ir.Const(1000.0)


def test_sum_of_temperatures_has_no_meaning_but_their_difference() -> None:
    """A scale with a zero of its own is refused but for differences, which are in K."""
    found = rule("b - 25 degC > 9 K").rules[0].condition
    assert isinstance(found, ir.Compare)
    assert found.right == ir.Const(9.0)


def test_constant_terms_are_exact() -> None:
    """A constant of a tenth and two tenths is three tenths."""
    found = rule("x > c", "const c = 0.1 m + 20 cm").rules[0].condition
    assert isinstance(found, ir.Compare)
    assert found.right == ir.Const(0.3)


def test_unit_ends_before_what_is_declared() -> None:
    """In the place of a unit stands an input, unless the whole text is a unit."""
    assert value("0.5 sec * v", 3.0) == 1.5
    found = side("0.5 sec * v * 2 / n > 1 m", "input n = topic /mode.data [dimensionless]")
    assert len(found.operands) == 2
    compare = rule("v > 0.5 m / s", "input s = topic /speed.data").rules[0].condition
    assert isinstance(compare, ir.Compare)
    assert compare.right == ir.Const(0.5)


def test_defined_units_count_where_a_unit_ends() -> None:
    """A unit of the file is one before what is declared in it, wherever it is defined."""
    declared = "unit lap = 400 m input laps = topic /mode.data [dimensionless]"
    assert value("2 lap * laps + 0 m", 3.0, declared=declared) == 6.0


@pytest.mark.parametrize(
    "condition",
    [
        "{} * 500 ms > 0",
        "{} + 30 cm > 1",
        "500 ms / ({}) > 0",
        "{} * 2 > 5 cm",
        "{} * 2 in [5 cm, 1 km]",
        "x > abs({})",
        "abs({}) < x",
        "max({}, 1 m) > 2 m",
        "{}.abs() > 1 m",
        "{}.previous() > 1 m",
        "hypot({}, x) > 1 m",
    ],
)
def test_operand_without_a_known_unit_beside_a_quantity_is_refused(condition: str) -> None:
    """Its unit would be one that nobody sees; declared at the input, it is known."""
    (fault,) = refused(condition.format("m"))
    assert fault.code is codes.UNIT_NOT_DECLARED
    assert rule(condition.format("k"), "input k = topic /mode.data [m]").rules


def test_declared_unit_is_that_of_a_field_everywhere() -> None:
    """Functions and arithmetic have it, and what is compared is converted into it."""
    declared = "input p = topic /speed.data [bar] timeout 1 sec"
    for term in ("p", "p.abs()", "p.previous()", "abs(p)", "p * 1", "p + 0 bar", "max(p, 0 bar)"):
        compare = rule(f"{term} > 600 kPa", declared).rules[0].condition
        assert isinstance(compare, ir.Compare)
        assert compare.right == ir.Const(6.0)
    assert value("p + 50 kPa", 1.0, declared=declared) == 1.5


def test_plain_numbers_beside_a_field_without_a_unit() -> None:
    """Such a field counts as a plain number everywhere."""
    assert value("m * 2 + 3", 2.0) == 7.0
    assert value("m + sin(w * 1 s)", 2.0, 0.0) == 2.0
    (fault,) = refused("m * 2 > 3 and m > 1 m")
    assert fault.code is codes.FIELD_IN_TWO_UNITS
    assert rule("m > 1 m and m > 0 and m in [0, 2 m]").rules


def test_fields_that_are_compared_have_one_unit() -> None:
    """What is known of one is known of the other, in whichever order the rules stand."""
    other = "input n = topic /speed.data timeout 1 sec"
    (fault,) = refused("m > n and m > 6 bar and n > 6 kPa", other)
    assert fault.code is codes.FIELD_IN_TWO_UNITS
    (fault,) = refused("m > 6 bar and n > 6 kPa and m > n", other)
    assert fault.code is codes.FIELD_IN_TWO_UNITS
    assert rule("m > n and m > 6 bar and n > 6 bar", other).rules
    (fault,) = refused("m > x and m > 1 km")
    assert fault.code is codes.FIELD_IN_TWO_UNITS


@pytest.mark.parametrize(
    "condition",
    ["b - b.previous() > 5 degC", "b - 20 degC not in [-9 degF, 9 K]", "b > b - 20 degC"],
)
def test_difference_of_temperatures_is_no_temperature(condition: str) -> None:
    """It is in K; 5 degC would be 278.15 K."""
    (fault,) = refused(condition)
    assert fault.code is codes.INCOMPATIBLE_UNITS
    assert "difference of temperatures" in fault.message + fault.hint


def test_difference_of_temperatures_is_in_kelvin() -> None:
    """Whatever scale the sensor has; a plain number beside it is in K where that is its degree."""
    compare = rule("b - b.previous() > 5 K").rules[0].condition
    assert isinstance(compare, ir.Compare)
    assert compare.right == ir.Const(5.0)
    assert value("b - 68 degF", 25.0) == 5.0
    fahrenheit = "input f = topic /speed.data [degF] timeout 1 sec"
    compare = rule("f - f.previous() > 5 K", fahrenheit).rules[0].condition
    assert isinstance(compare, ir.Compare)
    assert compare.right == ir.Const(9.0)
    (fault,) = refused("f - f.previous() > 5", fahrenheit)
    assert fault.code is codes.PLAIN_BESIDE_COMPUTED


def test_equal_operands_are_one() -> None:
    """What is written twice is read once."""
    assert len(side("v * v / (2 * 1 m/s^2) > 1").operands) == 1


def test_operand_of_another_topic_counts_with_its_latest_value() -> None:
    """Whichever message comes, the others' last ones count."""
    rules = rule("v * w > 2")
    engine = Engine(rules, 0)
    leaves = {rules.leaves[each.leaves[0]].input: each.leaves[0] for each in rules.inputs}
    engine.message(0, "/odom", {leaves[0]: 2.0})
    engine.message(10**8, "/imu", {leaves[1]: 1.0})
    assert not engine.events
    engine.message(2 * 10**8, "/imu", {leaves[1]: 1.5})
    assert [each.t_ns for each in engine.events] == [2 * 10**8]


def built(text: str) -> BuildResult:
    """Build rules that may have faults."""
    repository = Repository()
    model = repository.load_text(Path("a.deros"), text).model
    assert isinstance(model, Rules), repository.diagnostics
    return build(model, InterfaceStore())


@pytest.mark.parametrize("term", ["m" + " + 1" * 101, "(" * 60 + "m" + " + 1 + 1)" * 60])
def test_deep_terms_are_refused(term: str) -> None:
    """Terms of more operations than rules ever have are a finding, not an overflow."""
    text = f"input m = topic /mode.data entity e {{ r: {term} > 3; }}"
    diagnostics = Repository().load_text(Path("a.deros"), text).diagnostics
    assert codes.NESTED_TOO_DEEPLY in {each.code for each in diagnostics}


def test_deep_constants_are_refused() -> None:
    """Constants of constants count with the operations in them."""
    sums = [f"const c{n} = c{n + 1}{' + 1' * 90}" for n in range(90)]
    text = f"{' '.join(sums)} const c90 = 1 input m = topic /mode.data entity e {{ r: m > c0; }}"
    assert codes.NESTED_TOO_DEEPLY in {each.code for each in built(text).diagnostics}


def test_table_is_in_the_documentation() -> None:
    """The documentation holds the table of operations."""
    docs = Path(__file__).parents[4] / "docs/languages/rules.md"
    assert usage_table() in docs.read_text(encoding="utf-8"), f"it must hold\n{usage_table()}"
