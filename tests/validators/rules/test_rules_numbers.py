"""Sets of numbers: operations agree with membership."""

from __future__ import annotations

import math
from fractions import Fraction

from hypothesis import given
from hypothesis import strategies as st

from deros.validators.rules.rules_numbers import Number, NumberSet

ENDS = st.one_of(
    st.sampled_from([-math.inf, math.inf]), st.integers(-8, 8).map(lambda n: Fraction(n, 2))
)
Ends = tuple[Number, Number, bool, bool]
POINTS: list[Number] = [-math.inf, *(Fraction(n, 4) for n in range(-20, 21)), math.inf]


@st.composite
def intervals(draw: st.DrawFn) -> Ends:
    """Draw the ends of an interval, possibly empty, and whether they are closed."""
    return draw(ENDS), draw(ENDS), draw(st.booleans()), draw(st.booleans())


def holds(interval: Ends, point: Number) -> bool:
    """Return whether a point lies in an interval, by definition."""
    lower, upper, lower_closed, upper_closed = interval
    above = point >= lower if lower_closed else point > lower
    return above and (point <= upper if upper_closed else point < upper)


def members(numbers: NumberSet) -> list[Number]:
    """Return the points of a quarter grid that are in the set."""
    return [p for p in POINTS if not (NumberSet.between(p, p) & numbers).is_empty]


@given(intervals(), intervals())
def test_set_operations_agree_with_membership(a: Ends, b: Ends) -> None:
    """Intersection, union and complement contain the right points."""
    one, other = NumberSet.between(*a), NumberSet.between(*b)
    assert members(one) == [p for p in POINTS if holds(a, p)]
    assert members(one & other) == [p for p in POINTS if holds(a, p) and holds(b, p)]
    assert members(one | other) == [p for p in POINTS if holds(a, p) or holds(b, p)]
    assert members(one.complement()) == [p for p in POINTS if not holds(a, p)]
    assert one.is_empty == (not members(one))


@given(intervals())
def test_of_integers_keeps_exactly_the_integers(interval: Ends) -> None:
    """The narrowed set has the same integers, and is empty if there are none."""
    drawn_in = NumberSet.between(*interval).of_integers()
    whole = [p for p in POINTS if p in (-math.inf, math.inf) or p == int(p)]
    assert [p for p in whole if p in members(drawn_in)] == [p for p in whole if holds(interval, p)]
    assert drawn_in.is_empty == (not any(holds(interval, p) for p in whole))
