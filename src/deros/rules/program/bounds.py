"""Exact bounds of values: of types, and of the numbers that satisfy a comparison.

An end is an exact fraction, or a float for the infinities.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction

from deros.interfaces.types import INTEGER_RANGES, FieldType
from deros.interfaces.units import rounded as rounded
from deros.rules.program import ir
from deros.rules.program.values import as_float32 as as_float32

Ends = tuple[Fraction | float, Fraction | float]
"""The least and the greatest of some numbers."""

SHARE: Ends = (Fraction(0), Fraction(1))
"""The bounds of a ratio that its message keeps between nothing and the whole."""


@dataclass(frozen=True, slots=True)
class Bounds:
    """The numbers that satisfy a condition: those between two ends, or (``outside``) all others."""

    lower: Fraction | float
    upper: Fraction | float
    lower_closed: bool = True
    upper_closed: bool = True
    outside: bool = False


def type_bounds(kind: FieldType) -> Ends:
    """Return the least and greatest value of a primitive type."""
    if isinstance(kind.base, str) and kind.base in INTEGER_RANGES:
        least, greatest = INTEGER_RANGES[kind.base]
        return Fraction(least), Fraction(greatest)
    return -math.inf, math.inf


def bounds_of_absolute(operand: Ends) -> Ends:
    """Return the bounds of the absolute value of a number within ``operand``."""
    lower, upper = operand
    sizes = [each if each >= 0 else -each for each in operand]
    return (Fraction(0) if lower <= 0 <= upper else min(sizes)), max(sizes)


def bounds_of_length(*parts: Ends) -> Ends:
    """Return the least and greatest length of a vector with its parts within ``parts``."""
    greatest = [bounds_of_absolute(each)[1] for each in parts]
    finite = [each for each in greatest if isinstance(each, Fraction)]
    if len(finite) < len(greatest):
        return Fraction(0), math.inf
    # The monitor rounds thrice; the bound must not be below what it can compute.
    return Fraction(0), Fraction(math.sqrt(sum(each * each for each in finite)) * (1 + 1e-15))


def bounds_of_change(operand: Ends, seconds: Fraction) -> Ends:
    """Return the least and greatest change per second over at least so many seconds."""
    lower, upper = operand
    if not isinstance(lower, Fraction) or not isinstance(upper, Fraction):
        return -math.inf, math.inf
    # The monitor rounds twice; the bound must not be below what it can compute.
    greatest = (upper - lower) / seconds * (1 + Fraction(1, 10**15))
    return -greatest, greatest


def rounded_as(value: Fraction, kind: FieldType) -> float:
    """Return the number of a floating-point type that is nearest to a value, ties to even.

    Beyond the range of a ``float32`` it is a double: no number of that type is as great.
    """
    if kind.base != "float32" or not value:
        return rounded(value)
    exponent = value.numerator.bit_length() - value.denominator.bit_length()
    exponent -= abs(value) < Fraction(2) ** exponent
    step = Fraction(2) ** max(exponent - 23, -149)
    return rounded(round(value / step) * step)


def shortest_decimal(value: float) -> float:
    """Return the shortest decimal number that gives a ``float32``: 0.1 for 0.10000000149."""
    decimals = (float(f"{value:.{digits}g}") for digits in range(1, 10))
    return next((each for each in decimals if as_float32(each) == value), value)


def integer_bound(operator: ir.Operator, number: Fraction) -> tuple[ir.Operator, int | float]:
    """Return the comparison of an integer that means the same, with an integer if there is one.

    ``x > 2.5`` is ``x > 2``, ``x >= 2.5`` is ``x >= 3``; ``x = 2.5`` is never true.
    """
    if number.denominator == 1:
        return operator, int(number)
    if operator in (">", "<="):
        return operator, math.floor(number)
    if operator in (">=", "<"):
        return operator, math.ceil(number)
    nearest = rounded(number)
    return operator, nearest if not nearest.is_integer() else 0.5


def bounds_of(operator: ir.Operator, number: Fraction | float) -> Bounds:
    """Return the numbers that satisfy a comparison with ``number``; infinities are numbers."""
    match operator:
        case "=" | "!=":
            return Bounds(number, number, outside=operator == "!=")
        case "<" | "<=":
            return Bounds(-math.inf, number, upper_closed=operator == "<=")
        case _:
            return Bounds(number, math.inf, lower_closed=operator == ">=")


def exact(value: ir.Scalar) -> Fraction | float:
    """Return a number without rounding; infinities stay floats."""
    assert isinstance(value, (int, float))
    return Fraction(value) if math.isfinite(value) else float(value)
