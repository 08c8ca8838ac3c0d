"""The texts of comparisons for people: the author's numbers and units, constants resolved."""

from __future__ import annotations

from fractions import Fraction

from deros.interfaces.units import is_one, is_same
from deros.rules.compiler.scope.resolved import MessageConstant, Plain, Quantity, Resolved, Value
from deros.rules.program import ir
from deros.rules.program.bounds import rounded

_LONGEST_TEXT = 60
_GREATEST_WHOLE = 10**16  # beyond that, a number is written with an exponent


def wording(operator: ir.Operator, left: Value, *right: Resolved, brackets: str = "") -> ir.Wording:
    """Return the text of a comparison of a value with its right side.

    What is computed has its unit, if no other side has one.
    """
    units = [each.unit for each in right if isinstance(each, Quantity | Value)]
    differ = any(each and not is_same(each, left.unit) for each in units)
    shown = tuple(_side(each, left, units_differ=differ) for each in right)
    fixed = [each for each in right if isinstance(each, Quantity | Value)]
    told = any(each.unit and (isinstance(each, Quantity) or each.is_tuned) for each in fixed)
    differ |= isinstance(left.expression, ir.Compute) and not told
    unit = str(left.unit) if differ and left.unit and not is_one(left.unit) else ""
    return ir.Wording(operator, unit, shown, brackets)


def quoted(text: str) -> str:
    """Return a text in quotes, on one line of bounded length, fit for a log."""
    line = "".join(each if each.isprintable() else "?" for each in text[:_LONGEST_TEXT])
    return f'"{line}{"…" if len(text) > _LONGEST_TEXT else ""}"'


def constant(value: ir.Scalar) -> str:
    """Return a constant as text."""
    if isinstance(value, str):
        return quoted(value)
    if isinstance(value, float):
        return str(value + 0.0)  # which makes 0.0 of -0.0
    return str(value).lower() if isinstance(value, bool) else str(value)


def _side(side: Resolved, left: Value, *, units_differ: bool) -> str:
    match side:
        case Quantity():
            return f"{_number(side.value)} {side.unit}" if side.unit else _number(side.value)
        case Plain():
            return constant(side.value)
        case MessageConstant():
            return side.constant.name
        case Value(expression=ir.Compute()) if units_differ and left.unit:
            return str(left.unit)  # into which its value is converted
        case Value(unit=unit) if unit and not is_one(unit) and (units_differ or side.is_tuned):
            return str(unit)
        case _:
            return ""


def _number(number: Fraction) -> str:
    if number.denominator == 1 and abs(number) < _GREATEST_WHOLE:
        return str(number.numerator)
    return str(rounded(number))
