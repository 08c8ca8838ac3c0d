"""The values of expressions and conditions of systems."""

from __future__ import annotations

import math

import pytest

from deros.models.common import Scalar
from deros.systems.arguments.evaluate import CannotEvaluate, evaluate, holds
from tests.support.arguments import condition, expression

VALUES: dict[str, Scalar] = {
    "n": 7, "m": -2, "x": 0.5, "zero": 0, "robot": "left", "empty": "", "slam": True, "off": False,
    "most": 2**63 - 1, "huge": 1e308, "nan": math.nan, "inf": math.inf,
}  # fmt: skip


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("$n", 7),
        ("$n + 3", 10),
        ("$n - 3 - 1", 3),
        ("2 + $n * 3", 23),
        ("(2 + $n) * 3", 27),
        ("-$m", 2),
        ("- -$m", -2),
        ("$n / 2", 3.5),
        ("$n / 7", 1.0),
        ("$n * 1.0", 7.0),
        ("$x * 2", 1.0),
        ("$huge * 10", math.inf),
        ("$most - 1", 2**63 - 2),
        ('"${robot}_base"', "left_base"),
        ('"/${robot}/${n}${empty}"', "/left/7"),
        ('"${m}"', "-2"),
        ("$slam", True),
        ('"$${robot}"', "${robot}"),
        ("if slam then 1 else 2.5", 1.0),
        ("if not slam then 1 else 2.5", 2.5),
        ("if n > 7 then 1 else if n = 7 then 2 else 3", 2),
        ("if zero = 0 then 0 else 1 / $zero", 0.0),
        ('if robot = "left" then "l" else 1', "l"),
    ],
)
def test_values_of_expressions(text: str, value: Scalar) -> None:
    """Integers stay integers in ``+ - *``; ``/`` gives a double; texts contain texts, integers."""
    found = evaluate(expression(text), VALUES)
    assert (found, type(found)) == (value, type(value))


@pytest.mark.parametrize(
    ("text", "message", "place"),
    [
        ("$no", "unknown argument 'no'", "$no"),
        ('"${no}"', "unknown argument 'no'", "${no}"),
        ("3 / $zero", "this divides by zero", "$zero"),
        ("3 / ($n - 7)", "this divides by zero", "$n - 7"),
        ("$x / 0.0", "this divides by zero", "0.0"),
        ("$most + 1", "number out of range", "$most + 1"),
        ("-($m * $most)", "number out of range", "$m * $most"),
        ("$inf - $inf", "number out of range", "$inf - $inf"),
        ("$most * $most * $x", "number out of range", "$most * $most"),
        ("$robot + 1", "this is a text, not a number", "$robot"),
        ("if n then 1 else 2", "'n' is an integer, not a condition", "n"),
        (
            "1 + (if slam then $robot else 2)",
            "this is a text, not a number",
            "if slam then $robot else 2",
        ),
        ("if slam then 1 / $zero else 2", "this divides by zero", "$zero"),
        ("1 - $slam", "this is a bool, not a number", "$slam"),
        ("-$robot", "this is a text, not a number", "$robot"),
        ('"${x}"', "'x' is a double, of which several spellings exist", "${x}"),
        ('"${slam}"', "'slam' is a bool, of which several spellings exist", "${slam}"),
    ],
)
def test_expressions_without_a_value(text: str, message: str, place: str) -> None:
    """The fault says why, and where."""
    with pytest.raises(CannotEvaluate) as fault:
        evaluate(expression(text), VALUES)
    assert (fault.value.message, fault.value.span.text) == (message, place)
    assert fault.value.missing == ("no" if "no}" in text or text == "$no" else None)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("slam", True),
        ("not slam", False),
        ("slam and off", False),
        ("slam or off", True),
        ("off and off or slam", True),
        ("not (slam and off)", True),
        ("n = 7", True),
        ("n = 7.0", True),
        ("n != 7", False),
        ("n < 7", False),
        ("n <= 7", True),
        ("n > 6.5", True),
        ("x >= 0.5", True),
        ("5 > x", True),
        ('robot = "left"', True),
        ('robot != "left"', False),
        ("robot = empty", False),
        ('robot in ["right", "left"]', True),
        ("n in [1, 2]", False),
        ("n in [7.0]", True),
        ("slam = off", False),
        ("slam = true", True),
        ("nan = nan", False),
        ("true", True),
    ],
)
def test_values_of_conditions(text: str, value: bool) -> None:
    """Numbers are compared by value, whatever their type; texts and bools for equality."""
    assert holds(condition(text), VALUES) is value


@pytest.mark.parametrize(
    ("text", "message", "place"),
    [
        ("n", "'n' is an integer, not a condition", "n"),
        ("robot", "'robot' is a text, not a condition", "robot"),
        ("no", "unknown argument 'no'", "no"),
        ("n = robot", "an integer and a text cannot be compared", "n = robot"),
        ("slam = 1", "a bool and an integer cannot be compared", "slam = 1"),
        ('robot < "m"', "'<' compares numbers, and this is a text", 'robot < "m"'),
        ("slam >= off", "'>=' compares numbers, and this is a bool", "slam >= off"),
        ('n in [7, "x"]', "an integer and a text cannot be compared", '"x"'),
        ("slam or n", "'n' is an integer, not a condition", "n"),
        ("off and n", "'n' is an integer, not a condition", "n"),
    ],
)
def test_conditions_without_a_value(text: str, message: str, place: str) -> None:
    """The fault says why, and where: also in an operand that cannot change the result."""
    with pytest.raises(CannotEvaluate) as fault:
        holds(condition(text), VALUES)
    assert (fault.value.message, fault.value.span.text) == (message, place)
