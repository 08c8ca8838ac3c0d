"""Arithmetic becomes one formula: its operators, units and bounds, and what of it is refused."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from deros import codes
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.metamodels.rules import Rules
from deros.monitor import ir
from deros.monitor.build import BuildResult, build
from deros.monitor.engine import Engine
from deros.monitor.function_forms import strict
from deros.monitor.operations import usage_table
from tests.support.rules import program

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
    found = side("0.5 sec * v * 2 / m > 1 m")
    assert len(found.operands) == 2
    compare = rule("v > 0.5 m / s", "input s = topic /speed.data").rules[0].condition
    assert isinstance(compare, ir.Compare)
    assert compare.right == ir.Const(0.5)


def test_defined_units_count_where_a_unit_ends() -> None:
    """A unit of the file is one before what is declared in it, wherever it is defined."""
    declared = "unit lap = 400 m input laps = topic /mode.data"
    assert value("2 lap * laps / 1 m", 3.0, declared=declared) == 2400.0


def test_operand_without_a_known_unit_is_in_base_units() -> None:
    """Constants beside it are converted, and so is what the result is compared with."""
    assert value("m * 500 ms", 3.0) == 1.5
    assert value("m + 30 cm", 1.0) == 1.3
    assert value("500 ms / (m)", 2.0) == 0.25
    found = rule("m * 2 > 5 cm").rules[0].condition
    assert isinstance(found, ir.Compare)
    assert found.right == ir.Const(0.05)
    found = rule("m * 2 in [5 cm, 1 km] and x / 2 not in [1 in, 2 in]").rules[0].condition
    assert isinstance(found, ir.And)
    found = found.operands[0]
    assert isinstance(found, ir.Within)
    assert (found.lower, found.upper) == (ir.Const(0.05), ir.Const(1000.0))
    found = rule("x * 100 / 1 m > m * 1 deg").rules[0].condition
    assert isinstance(found, ir.Compare)


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
    docs = Path(__file__).parents[2] / "docs/languages/rules.md"
    assert usage_table() in docs.read_text(encoding="utf-8"), f"it must hold\n{usage_table()}"
