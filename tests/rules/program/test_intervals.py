"""No double that an operation computes lies outside the interval that is said of it."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deros.rules.program import intervals
from deros.rules.program.intervals import ALL, Interval

numbers = st.floats(allow_nan=False) | st.sampled_from((-2.0, -1.0, -0.0, 0.0, 0.5, 1.0, 3.0))


@st.composite
def members(draw: st.DrawFn) -> tuple[Interval, float]:
    """Draw an interval and a number in it."""
    least, inside, greatest = sorted(draw(st.tuples(numbers, numbers, numbers)))
    return (least, greatest), inside


Operation = Callable[..., float]
Bounding = Callable[..., Interval]


@pytest.mark.parametrize(
    ("operation", "bounding"),
    [
        (operator.add, intervals.added),
        (operator.mul, intervals.multiplied),
        (operator.truediv, intervals.divided),
        (min, intervals.least_of),
        (max, intervals.greatest_of),
    ],
)
@given(left=members(), right=members())
def test_result_of_two_numbers_is_inside(
    operation: Operation,
    bounding: Bounding,
    left: tuple[Interval, float],
    right: tuple[Interval, float],
) -> None:
    """It holds for all that is known: of the rest there is no value."""
    if operation is operator.truediv and right[1] == 0.0:
        return
    value = operation(left[1], right[1])
    least, greatest = bounding(left[0], right[0])
    assert math.isnan(value) or least <= value <= greatest


@pytest.mark.parametrize(
    ("operation", "bounding"),
    [
        (operator.neg, intervals.negated),
        (abs, intervals.absolute),
        (lambda each: each * each, intervals.squared),
        (lambda each: math.sqrt(each) if each >= 0.0 else math.nan, intervals.root),
    ],
)
@given(operand=members())
def test_result_of_one_number_is_inside(
    operation: Operation, bounding: Bounding, operand: tuple[Interval, float]
) -> None:
    """It holds for all that is known."""
    value = operation(operand[1])
    least, greatest = bounding(operand[0])
    assert math.isnan(value) or least <= value <= greatest


def test_divisor_around_zero_bounds_nothing() -> None:
    """The quotient can be any number; where the divisor only touches zero, one side is bounded."""
    assert intervals.divided((1.0, 2.0), (-1.0, 1.0)) == ALL
    assert intervals.divided((1.0, 2.0), (0.0, 0.0)) == ALL
    assert intervals.divided((1.0, 2.0), (0.0, 4.0)) == (0.25, math.inf)
    assert intervals.divided((1.0, 2.0), (-4.0, 0.0)) == (-math.inf, -0.25)
    assert intervals.divided((1.0, 2.0), (2.0, 4.0)) == (0.25, 1.0)


def test_ends_without_a_value_bound_nothing_falsely() -> None:
    """The sum of what reaches to both infinities is anything."""
    assert intervals.added((-math.inf, 0.0), (0.0, math.inf)) == ALL
    assert intervals.multiplied((0.0, math.inf), (0.0, 1.0)) == (0.0, math.inf)
    assert intervals.root((-4.0, -1.0)) == ALL
