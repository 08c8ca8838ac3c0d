"""Comparisons of ages: how long ago the last message of an input came."""

from __future__ import annotations

import math
from fractions import Fraction

from deros import codes
from deros.diagnostics import Span
from deros.interfaces.durations import NS_PER_S
from deros.interfaces.types import FieldType
from deros.models import rules
from deros.rules.compiler.scope.resolved import (
    AgeOf,
    Quantity,
    Resolved,
    ResolvedComparison,
    Value,
)
from deros.rules.compiler.scope.scope import Scope
from deros.rules.compiler.scope.tuned import refuse_tuned
from deros.rules.compiler.wordings import wording
from deros.rules.functions.functions import FUNCTIONS
from deros.rules.program import ir
from deros.rules.program.bounds import Bounds, bounds_of

_EQUALITY = frozenset({"=", "!="})


class Ages:
    """Builds comparisons of ages. ``None`` means that a fault has been reported."""

    def __init__(self, scope: Scope, found: list[ResolvedComparison]) -> None:
        """Report to a scope, and add each comparison to those ``found``."""
        self._scope = scope
        self._found = found

    def compared(
        self,
        node: rules.Comparison,
        first: tuple[rules.Term, Resolved],
        operator: ir.Operator,
        second: tuple[rules.Term, Resolved],
    ) -> ir.Condition | None:
        """Return the comparison of an age with a constant, on either side."""
        if not isinstance(first[1], AgeOf):
            first, second, operator = second, first, ir.MIRRORED[operator]
        age, (term, bound) = first[1], second
        assert isinstance(age, AgeOf)
        if operator in _EQUALITY:
            message = f"an age passes every value in a nanosecond, '{operator}' never helps"
            hint = "compare it with <, <=, > or >="
            self._scope.fault(codes.WRONG_OPERAND, message, node.span, hint)
            return None
        bound_ns = self._age_bound(bound, term.span)
        if bound_ns is None:
            return None
        self._note_age(node, age, bounds_of(operator, _seconds(bound_ns)))
        shown = wording(operator, self._seconds_of(age), bound)
        return ir.Age(self._scope.use(age.input), operator, bound_ns, shown)

    def within(
        self, node: rules.Membership, age: AgeOf, lower: Resolved, upper: Resolved
    ) -> ir.Condition | None:
        """Return whether an age is in an interval of constants."""
        least = self._age_bound(lower, node.lower.span)
        greatest = self._age_bound(upper, node.upper.span)
        if least is None or greatest is None:
            return None
        if is_empty(self._scope, node, Fraction(least), Fraction(greatest)):
            return None
        owner = self._scope.use(age.input)
        ends = Bounds(
            _seconds(least), _seconds(greatest), node.lower_closed, node.upper_closed, node.negated
        )
        self._note_age(node, age, ends)
        seconds = self._seconds_of(age)
        above: ir.Operator = ">=" if node.lower_closed else ">"
        below: ir.Operator = "<=" if node.upper_closed else "<"
        within = ir.And(
            (
                ir.Age(owner, above, least, wording(above, seconds, lower)),
                ir.Age(owner, below, greatest, wording(below, seconds, upper)),
            )
        )
        return ir.Not(within) if node.negated else within

    def _note_age(
        self, node: rules.Comparison | rules.Membership, age: AgeOf, bounds: Bounds
    ) -> None:
        """Report an age, in seconds, to the checks of value ranges."""
        seconds = self._seconds_of(age)
        self._found.append(ResolvedComparison(node, seconds, bounds, exact=False))

    def _seconds_of(self, age: AgeOf) -> Value:
        row = FUNCTIONS["age"]
        expression = ir.Apply(row.name, (), self._scope.use(age.input))
        unit = self._scope.units.parse(row.unit)
        return Value(expression, FieldType("float64"), unit, age.input, (Fraction(0), math.inf))

    def _age_bound(self, bound: Resolved, span: Span) -> int | None:
        if refuse_tuned(self._scope, bound, span, "what an age is compared with"):
            return None
        if not isinstance(bound, Quantity):
            message = "'age()' is compared with a constant only"
            self._scope.fault(codes.AGE_NOT_CONSTANT, message, span)
            return None
        second = self._scope.units.parse("s")
        if bound.unit and second and not self._scope.units.compatible(bound.unit, second):
            message = f"an age is a time, '{bound.unit}' is a unit of {bound.unit.dimension}"
            self._scope.fault(codes.INCOMPATIBLE_UNITS, message, span)
            return None
        return self._scope.nanoseconds(bound.in_unit(second), span)


def is_empty(scope: Scope, node: rules.Membership, least: Fraction, greatest: Fraction) -> bool:
    """Return whether no value lies in an interval; report it."""
    closed = node.lower_closed and node.upper_closed
    if least < greatest or (least == greatest and closed):
        return False
    wrong = "runs backwards" if least > greatest else "is empty"
    message = f"the interval {node.interval_span.text} {wrong}: no value lies in it"
    hint = "write the lesser end first" if least > greatest else ""
    scope.fault(codes.EMPTY_INTERVAL, message, node.interval_span, hint)
    return True


def _seconds(nanoseconds: int) -> Fraction:
    return Fraction(nanoseconds, NS_PER_S)
