"""Comparisons of frequencies: how often the messages of an input have come lately.

A frequency is compared by the time since the first of its last messages. With the bound as written,
an exact number, that gives a whole number of nanoseconds: nothing is rounded, in no target.
"""

from __future__ import annotations

import math
from fractions import Fraction

from deros import codes
from deros.diagnostics import Span
from deros.interfaces.durations import LATEST_NS, NS_PER_S
from deros.interfaces.types import FieldType
from deros.models import rules
from deros.rules.compiler.ages import is_empty
from deros.rules.compiler.scope.resolved import (
    FrequencyOf,
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


class Frequencies:
    """Builds comparisons of frequencies. ``None`` means that a fault has been reported."""

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
        """Return the comparison of a frequency with a constant, on either side."""
        if not isinstance(first[1], FrequencyOf):
            first, second, operator = second, first, ir.MIRRORED[operator]
        frequency, (term, bound) = first[1], second
        assert isinstance(frequency, FrequencyOf)
        if operator in _EQUALITY:
            message = f"a frequency passes every value in a nanosecond, '{operator}' never helps"
            hint = "compare it with <, <=, > or >="
            self._scope.fault(codes.WRONG_OPERAND, message, node.span, hint)
            return None
        hertz = self._hertz(frequency, bound, term.span)
        if hertz is None:
            return None
        self._note(node, frequency, bounds_of(operator, hertz))
        return self._condition(frequency, operator, hertz, bound)

    def within(
        self, node: rules.Membership, frequency: FrequencyOf, lower: Resolved, upper: Resolved
    ) -> ir.Condition | None:
        """Return whether a frequency is in an interval of constants."""
        least = self._hertz(frequency, lower, node.lower.span)
        greatest = self._hertz(frequency, upper, node.upper.span)
        if least is None or greatest is None or is_empty(self._scope, node, least, greatest):
            return None
        closed = (node.lower_closed, node.upper_closed)
        self._note(node, frequency, Bounds(least, greatest, *closed, node.negated))
        above: ir.Operator = ">=" if node.lower_closed else ">"
        below: ir.Operator = "<=" if node.upper_closed else "<"
        within = ir.And(
            (
                self._condition(frequency, above, least, lower),
                self._condition(frequency, below, greatest, upper),
            )
        )
        return ir.Not(within) if node.negated else within

    def _condition(
        self, frequency: FrequencyOf, operator: ir.Operator, hertz: Fraction, bound: Resolved
    ) -> ir.Condition:
        """Return a comparison; one for a high frequency is the opposite of one for a low one."""
        is_low = operator in ("<", "<=")
        low = operator if is_low else ir.OPPOSITE[operator]
        elapsed_ns = elapsed_at(frequency.messages, low, hertz)
        shown = wording(low, self._value_of(frequency), bound)
        index = self._scope.use(frequency.input)
        condition = ir.Frequency(index, frequency.messages, elapsed_ns, shown)
        return condition if is_low else ir.Not(condition)

    def _note(
        self, node: rules.Comparison | rules.Membership, frequency: FrequencyOf, bounds: Bounds
    ) -> None:
        """Report a frequency to the checks of value ranges."""
        value = self._value_of(frequency)
        self._found.append(ResolvedComparison(node, value, bounds, exact=False))

    def _value_of(self, frequency: FrequencyOf) -> Value:
        row = FUNCTIONS["frequency"]
        index = self._scope.use(frequency.input)
        expression = ir.Apply(row.name, (ir.Const(frequency.messages),), index)
        unit = self._scope.units.parse(row.unit)
        positive = (Fraction(0), math.inf)
        return Value(expression, FieldType("float64"), unit, frequency.input, positive)

    def _hertz(self, frequency: FrequencyOf, bound: Resolved, span: Span) -> Fraction | None:
        """Return a bound in Hz; report what is no constant frequency above 0."""
        if refuse_tuned(self._scope, bound, span, "what a frequency is compared with"):
            return None
        if not isinstance(bound, Quantity):
            message = "'frequency()' is compared with a constant only"
            self._scope.fault(codes.BAD_FREQUENCY, message, span, "write '8 Hz' or the like")
            return None
        hertz = self._scope.units.parse("Hz")
        if bound.unit and hertz and not self._scope.units.compatible(bound.unit, hertz):
            message = f"'frequency()' is in Hz, '{bound.unit}' is a unit of {bound.unit.dimension}"
            self._scope.fault(codes.INCOMPATIBLE_UNITS, message, span, "write '8 Hz' or the like")
            return None
        found = bound.in_unit(hertz)
        if found <= 0:
            message = f"a frequency is always above 0, '{span.text}' is not a bound for it"
            hint = "that no message comes at all is 'INPUT.missing()' of an input with a timeout"
            self._scope.fault(codes.BAD_FREQUENCY, message, span, hint)
            return None
        if elapsed_at(frequency.messages, "<", found) > LATEST_NS:
            message = f"{frequency.messages} messages at '{span.text}' take more than 146 years"
            self._scope.fault(codes.BAD_FREQUENCY, message, span)
            return None
        return found


def elapsed_at(messages: int, operator: ir.Operator, hertz: Fraction) -> int:
    """Return from which time on, in nanoseconds, so many messages are ``<`` or ``<=`` a frequency.

    It is the least whole number of nanoseconds in which they have a frequency that is so.
    """
    exact_ns = messages * NS_PER_S / hertz
    return math.floor(exact_ns) + 1 if operator == "<" else math.ceil(exact_ns)
