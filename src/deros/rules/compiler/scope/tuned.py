"""Tunable constants where names are resolved: what a comparison with one can be, and where none is.

Every check holds for the whole interval of a constant, never for the value that it has by default.
"""

from __future__ import annotations

import math
from fractions import Fraction

from deros import codes
from deros.diagnostics import Span
from deros.rules.compiler.scope.resolved import Quantity, Resolved, Value
from deros.rules.compiler.scope.scope import Scope
from deros.rules.program import ir
from deros.rules.program.bounds import Bounds, Ends, as_float32, bounds_of


def refuse_tuned(scope: Scope, found: Resolved | None, place: Span, what: str) -> bool:
    """Return whether a term is tunable where it has to be fixed; report it, with ``what`` it is."""
    if not isinstance(found, Value) or not found.is_tuned:
        return False
    message = f"{what} is fixed when the rules are compiled, '{place.text}' is tunable"
    hint = "declare a constant without 'tunable in', or write the number"
    scope.fault(codes.BAD_TUNABLE, message, place, hint)
    return True


def negated(value: Value) -> Value | None:
    """Return a tunable constant with the other sign; ``None`` for any other value."""
    expression = value.expression
    if not isinstance(expression, ir.Tuned):
        return None
    least, greatest = value.bounds
    return Value(
        ir.Tuned(expression.constant, not expression.negated),
        value.type,
        value.unit,
        None,
        (-greatest, -least),
    )


def tuned_in_unit(scope: Scope, value: Value, tuned: ir.Tuned, wanted: Value) -> ir.Tuned:
    """Return a tunable constant as it is compared with a value: in its unit, and of its type."""
    factor, offset = 1.0, 0.0
    if value.unit is not None and wanted.unit is not None:
        factor, offset = scope.units.factor(value.unit, wanted.unit)
    found = ir.Tuned(tuned.constant, tuned.negated, factor, offset)
    if wanted.type.base != "float32":
        return found
    # Beyond the range of a float32 it stays a double, as other constants do.
    fits = all(map(math.isfinite, map(as_float32, _ends_of_constant(scope, found))))
    return ir.Tuned(tuned.constant, tuned.negated, factor, offset, single=fits)


def _ends_of_constant(scope: Scope, expression: ir.Tuned) -> list[float]:
    constant = scope.tunables[expression.constant]
    return sorted(map(expression.of, (constant.lower, constant.upper)))


def ends_of(scope: Scope, expression: ir.ValueExpression, value: Value, wanted: Value) -> Ends:
    """Return the ends of a tuned value as it is compared, in the unit of what is ``wanted``."""
    if isinstance(expression, ir.Tuned):
        least, greatest = map(Fraction, _ends_of_constant(scope, expression))
        return least, greatest
    if value.unit is None or wanted.unit is None:
        return value.bounds
    factor = value.unit.factor / wanted.unit.factor
    offset = (value.unit.offset - wanted.unit.offset) / wanted.unit.factor
    first, last = (Fraction(each) * factor + offset for each in value.bounds)
    return first, last


def ends_of_fixed(
    scope: Scope, found: Resolved, expression: ir.ValueExpression, wanted: Value
) -> Ends | None:
    """Return the ends of a side that is known when the monitor starts; ``None`` for others."""
    if isinstance(found, Quantity) and isinstance(expression, ir.Const):
        number = expression.value
        assert isinstance(number, int | float)
        exact = Fraction(number) if math.isfinite(number) else number
        return exact, exact
    if isinstance(found, Value) and found.is_tuned:
        return ends_of(scope, expression, found, wanted)
    return None


def possible_of(operator: ir.Operator, ends: Ends) -> tuple[Bounds, Bounds]:
    """Return the numbers for which a comparison can be true, and those for which it can be false.

    ``ends`` are those of the tuned value on the right.
    """
    return _possible(operator, ends), _possible(ir.OPPOSITE[operator], ends)


def _possible(operator: ir.Operator, ends: Ends) -> Bounds:
    least, greatest = ends
    match operator:
        case "=":
            return Bounds(least, greatest)
        case "!=":
            return Bounds(-math.inf, math.inf)
        case "<" | "<=":
            return bounds_of(operator, greatest)
        case _:
            return bounds_of(operator, least)


def possible_within(
    lower: Ends, upper: Ends, closed: tuple[bool, bool], negated: bool
) -> tuple[Bounds, Bounds]:
    """Return the same of an interval; its ends have these ends each."""
    inside = Bounds(lower[0], upper[1], *closed)
    outside = Bounds(lower[1], upper[0], *closed, outside=True)
    return (outside, inside) if negated else (inside, outside)
