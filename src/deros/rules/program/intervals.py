"""Intervals of doubles: between which ends the result of an operation lies.

An operation of IEEE 754 rounds, and rounding keeps the order of numbers. So the ends that it gives
of the ends of its operands are ends of all that it can compute. An end that has no value, as
``inf - inf``, is that of the nearest numbers that have one.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from fractions import Fraction

from deros.rules.program.bounds import Ends, rounded

Interval = tuple[float, float]
"""The least and the greatest of some doubles; both are numbers or infinities."""

ALL: Interval = (-math.inf, math.inf)


def interval_of(ends: Ends) -> Interval:
    """Return exact ends as doubles, as the monitor rounds what lies between them."""
    least, greatest = (rounded(each) if isinstance(each, Fraction) else each for each in ends)
    return least, greatest


def ends_of(interval: Interval) -> Ends:
    """Return doubles as exact ends."""
    least, greatest = (Fraction(each) if math.isfinite(each) else each for each in interval)
    return least, greatest


def added(left: Interval, right: Interval) -> Interval:
    """Return the interval of sums."""
    least, greatest = left[0] + right[0], left[1] + right[1]
    return (
        -math.inf if math.isnan(least) else least,
        math.inf if math.isnan(greatest) else greatest,
    )


def negated(operand: Interval) -> Interval:
    """Return the interval of the numbers with the other sign."""
    return -operand[1], -operand[0]


def multiplied(left: Interval, right: Interval) -> Interval:
    """Return the interval of products; of different numbers, even where both are within one."""
    return _hull(a * b for a in left for b in right)


def squared(operand: Interval) -> Interval:
    """Return the interval of the products of numbers with themselves."""
    least, greatest = absolute(operand)
    return least * least, greatest * greatest


def divided(left: Interval, right: Interval) -> Interval:
    """Return the interval of quotients; what is divided by zero is unknown, and has none."""
    least, greatest = right
    if least < 0.0 < greatest or least == greatest == 0.0:
        return ALL
    if least == 0.0:
        ends: tuple[Callable[[float], float], ...] = (
            lambda a: a * math.inf,
            lambda a: a / greatest,
        )
    elif greatest == 0.0:
        ends = (lambda a: a / least, lambda a: a * -math.inf)
    else:
        ends = (lambda a: a / least, lambda a: a / greatest)
    return _hull(end(a) for a in left for end in ends)


def absolute(operand: Interval) -> Interval:
    """Return the interval of the absolute values."""
    least, greatest = operand
    ends = abs(least), abs(greatest)
    return 0.0 if least <= 0.0 <= greatest else min(ends), max(ends)


def root(operand: Interval) -> Interval:
    """Return the interval of square roots; of numbers below zero there is none."""
    least, greatest = operand
    return ALL if greatest < 0.0 else (math.sqrt(max(least, 0.0)), math.sqrt(greatest))


def least_of(*operands: Interval) -> Interval:
    """Return the interval of the least of some numbers."""
    return min(each[0] for each in operands), min(each[1] for each in operands)


def greatest_of(*operands: Interval) -> Interval:
    """Return the interval of the greatest of some numbers."""
    return max(each[0] for each in operands), max(each[1] for each in operands)


def _hull(values: Iterable[float]) -> Interval:
    """Return the ends of some numbers; what has no value is between zero and infinity."""
    found = [0.0 if math.isnan(each) else each for each in values]
    return min(found), max(found)
