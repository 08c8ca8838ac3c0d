"""Comparisons of the rules: types and units are checked, and resolved into the monitor's."""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction

from deros import codes
from deros.diagnostics import Span
from deros.models import rules
from deros.rules.compiler.ages import Ages, is_empty
from deros.rules.compiler.compared_units import ComparedUnits
from deros.rules.compiler.frequencies import Frequencies
from deros.rules.compiler.scope.resolved import (
    AgeOf,
    EntriesHold,
    Fixed,
    FrequencyOf,
    InsideOf,
    MessageConstant,
    MissingOf,
    Part,
    Plain,
    Quantity,
    Resolved,
    ResolvedComparison,
    UnknownOf,
    Value,
    family,
    family_of,
    is_float,
)
from deros.rules.compiler.scope.scope import Scope
from deros.rules.compiler.scope.tuned import (
    ends_of,
    ends_of_fixed,
    possible_of,
    possible_within,
    tuned_in_unit,
)
from deros.rules.compiler.terms.arithmetic_number import scaled
from deros.rules.compiler.terms.term_names import describe
from deros.rules.compiler.terms.terms import Terms
from deros.rules.compiler.wordings import wording
from deros.rules.program import ir
from deros.rules.program.bounds import Bounds, Ends, bounds_of, exact, integer_bound, rounded_as

_EQUALITY = frozenset({"=", "!="})


class Comparisons:
    """Builds the conditions without operands. ``None`` means that a fault has been reported.

    ``found`` collects every comparison with its types, for the checks of value ranges.
    """

    def __init__(self, scope: Scope, terms: Terms) -> None:
        """Look up names in a scope."""
        self._scope = scope
        self._terms = terms
        self._units = ComparedUnits(scope)
        self.found: list[ResolvedComparison] = []
        terms.entries.build = self.build
        self._ages = Ages(scope, self.found)
        self._frequencies = Frequencies(scope, self.found)

    def build(
        self, condition: rules.Comparison | rules.Membership | rules.Truth
    ) -> ir.Condition | None:
        """Return a comparison, an interval or a boolean term of a rule."""
        match condition:
            case rules.Truth():
                return self._truth(condition)
            case rules.Comparison():
                return self._comparison(condition)
            case rules.Membership():
                return self._membership(condition)

    # A term alone -------------------------------------------------------------------------------

    def _truth(self, truth: rules.Truth) -> ir.Condition | None:
        operand = self._terms.resolve(truth.operand)
        match operand:
            case None:
                return None
            case MissingOf() | UnknownOf() | EntriesHold() | InsideOf():
                return self._state_of(operand)
            case Value() if family(operand.type) == "boolean":
                return ir.Truth(operand.expression)
            case Plain(value=bool(value)):
                return ir.Truth(ir.Const(value))
        written = truth.operand.span.text
        message = f"'{written}' is {describe(operand)}, no condition by itself"
        hint = f"compare it: '{written} > ...'" if not isinstance(operand, Part) else ""
        self._scope.fault(codes.WRONG_OPERAND, message, truth.span, hint)
        return None

    def _state_of(
        self, asked: MissingOf | UnknownOf | EntriesHold | InsideOf
    ) -> ir.Missing | ir.Unknown | ir.Compare:
        if isinstance(asked, EntriesHold | InsideOf):
            return asked.condition
        index = self._scope.use(asked.input)
        if isinstance(asked, MissingOf):
            return ir.Missing(index)
        return ir.Unknown(index, asked.function)

    # Comparisons --------------------------------------------------------------------------------

    def _comparison(self, node: rules.Comparison) -> ir.Condition | None:
        first, second = self._both(node.left, node.right)
        if first is None or second is None:
            return None
        left, right = node.left, node.right
        operator: ir.Operator = node.operator
        if _is_fixed(first):
            if _is_fixed(second):
                message = "neither side is read from a topic"
                self._scope.fault(codes.WRONG_OPERAND, message, node.span)
                return None
            first, second, left, right = second, first, right, left
            operator = ir.MIRRORED[operator]
        match first, second:
            case (AgeOf(), _) | (_, AgeOf()):
                return self._ages.compared(node, (left, first), operator, (right, second))
            case (FrequencyOf(), _) | (_, FrequencyOf()):
                return self._frequencies.compared(node, (left, first), operator, (right, second))
            case (
                MissingOf() | UnknownOf() | EntriesHold() | InsideOf(),
                Plain(value=bool(value)),
            ) if operator in _EQUALITY:
                asked = self._state_of(first)
                return asked if value is (operator == "=") else ir.Not(asked)
            case (Value(), Value(input=None)):
                return self._with_tuned(node, first, left, operator, second, right)
            case (Value(), Value()):
                return self._between_values(node, first, operator, second)
            case (Value(), Quantity() | Plain() | MessageConstant()):
                return self._with_constant(node, first, left, operator, second, right)
        self._no_value(first if not isinstance(first, Value) else second, node.span)
        return None

    def _both(self, left: rules.Term, right: rules.Term) -> tuple[Resolved | None, Resolved | None]:
        """Resolve both sides; the one that may name a message's constant, after the other."""
        if self._terms.is_open(left) and not self._terms.is_open(right):
            second = self._terms.resolve(right)
            message = second.message if isinstance(second, Value) else None
            # With the other side unknown, so are the names that it would explain.
            return (None, None) if second is None else (self._terms.resolve(left, message), second)
        first = self._terms.resolve(left)
        if first is None and self._terms.is_open(right):
            return None, None
        message = first.message if isinstance(first, Value) else None
        return first, self._terms.resolve(right, message)

    def _no_value(self, found: Resolved, span: Span) -> None:
        if isinstance(found, Part):
            message = f"a number is needed here, this is {describe(found)}"
            hint = "" if found.type.is_array else "name one of its fields, or apply a function"
            self._scope.fault(codes.FIELD_NOT_NUMERIC, message, span, hint)
        else:
            message = f"{describe(found)} cannot be compared with this"
            self._scope.fault(codes.WRONG_OPERAND, message, span)

    def _with_constant(
        self,
        node: rules.Comparison,
        value: Value,
        left: rules.Term,
        operator: ir.Operator,
        constant: Fixed,
        right: rules.Term,
    ) -> ir.Condition | None:
        kind = family(value.type)
        if isinstance(constant, Quantity):
            if not self._is_number(value, left) or not self._units.fit(constant, value, right):
                return None
            number = constant.in_unit(value.unit)
            return self._with_number(node, value, operator, number, constant)
        scalar: ir.Scalar
        if isinstance(constant, Plain):
            scalar, named = constant.value, f"the {family_of(constant.value)} '{right.span.text}'"
        else:
            scalar, named = constant.constant.value, f"the constant '{constant.constant.name}'"
        if family_of(scalar) != kind:
            message = f"'{left.span.text}' is {describe(value)}, it cannot be {named}"
            self._scope.fault(codes.WRONG_OPERAND, message, node.span)
            return None
        if kind == "number" and isinstance(scalar, (int, float)):
            if not math.isfinite(scalar):
                message = f"{named} is {scalar}, not a number that can be compared with"
                self._scope.fault(codes.WRONG_OPERAND, message, node.span)
                return None
            return self._with_number(node, value, operator, Fraction(scalar), constant)
        if operator not in _EQUALITY:
            self._not_ordered(node, operator, named)
            return None
        return ir.Compare(
            value.expression, operator, ir.Const(scalar), wording(operator, value, constant)
        )

    def _not_ordered(self, node: rules.Comparison, operator: str, what: str) -> None:
        message = f"{what} can be compared with = and != only, not {operator}"
        self._scope.fault(codes.WRONG_OPERAND, message, node.span)

    def _is_number(self, value: Value, term: rules.Term) -> bool:
        if family(value.type) == "number":
            return True
        message = f"a number is needed, '{term.span.text}' is {describe(value)}"
        self._scope.fault(codes.FIELD_NOT_NUMERIC, message, term.span)
        return False

    def _with_number(
        self,
        node: rules.Comparison,
        value: Value,
        operator: ir.Operator,
        number: Fraction,
        constant: Fixed,
    ) -> ir.Condition:
        """Compare with an exact number, which is rounded to an integer for an integer."""
        bound: int | float
        shown = wording(operator, value, constant)
        if value.is_integer:
            operator, bound = integer_bound(operator, number)
        else:
            bound = rounded_as(number, value.type)
        self._note(node, value, bounds_of(operator, exact(bound)), operator in _EQUALITY)
        return ir.Compare(value.expression, operator, ir.Const(bound), shown)

    def _with_tuned(
        self,
        node: rules.Comparison,
        value: Value,
        left: rules.Term,
        operator: ir.Operator,
        tuned: Value,
        right: rules.Term,
    ) -> ir.Condition | None:
        """Compare with tunable constants, which have any values within their intervals."""
        if not self._is_number(value, left) or not self._units.fit(tuned, value, right):
            return None
        expression = self._scaled(tuned, value)
        possible = possible_of(operator, ends_of(self._scope, expression, tuned, value))
        equality = operator in _EQUALITY
        self._note(node, value, None, equality, other=(operator, tuned), possible=possible)
        return ir.Compare(value.expression, operator, expression, wording(operator, value, tuned))

    def _between_values(
        self, node: rules.Comparison, left: Value, operator: ir.Operator, right: Value
    ) -> ir.Condition | None:
        kind = family(left.type)
        if kind != family(right.type):
            message = (
                f"'{node.left.span.text}' is {describe(left)},"
                f" '{node.right.span.text}' is {describe(right)}"
            )
            self._scope.fault(codes.WRONG_OPERAND, message, node.span)
            return None
        if kind != "number" and operator not in _EQUALITY:
            self._not_ordered(node, operator, f"a {kind}")
            return None
        if not self._units.fit(right, left, node.right):
            return None
        if kind == "number":
            # A value and the one before it are not computed: nothing is rounded.
            equality = operator in _EQUALITY and not _is_previous(left, right)
            self._note(node, left, None, equality, is_float(right.type), (operator, right))
        shown = wording(operator, left, right)
        return ir.Compare(left.expression, operator, self._scaled(right, left), shown)

    def _scaled(self, value: Value, wanted: Value) -> ir.ValueExpression:
        """Return the value converted to the unit of ``wanted``."""
        if isinstance(value.expression, ir.Tuned):
            return tuned_in_unit(self._scope, value, value.expression, wanted)
        source, target = value.unit, wanted.unit
        if source is None or target is None:
            return value.expression
        factor, offset = self._scope.units.factor(source, target)
        if (factor, offset) == (1.0, 0.0):
            return value.expression
        if isinstance(value.expression, ir.Compute):
            return scaled(value.expression, factor, offset)
        return ir.Scale(value.expression, factor, offset)

    def _note(
        self,
        node: rules.Comparison | rules.Membership,
        value: Value,
        bounds: Bounds | None,
        equality: bool,
        other_is_float: bool = False,
        other: tuple[ir.Operator, Value] | None = None,
        possible: tuple[Bounds, Bounds] | None = None,
    ) -> None:
        exactly = equality and (is_float(value.type) or other_is_float)
        self.found.append(ResolvedComparison(node, value, bounds, exactly, other, possible))

    # Intervals ----------------------------------------------------------------------------------

    def _membership(self, node: rules.Membership) -> ir.Condition | None:
        operand = self._terms.resolve(node.operand)
        owner = operand.message if isinstance(operand, Value) else None
        lower, upper = (
            # With the operand unknown, so are the names that it would explain.
            None
            if operand is None and self._terms.is_open(end)
            else self._terms.resolve(end, owner)
            for end in (node.lower, node.upper)
        )
        if operand is None or lower is None or upper is None:
            return None
        if isinstance(operand, AgeOf):
            return self._ages.within(node, operand, lower, upper)
        if isinstance(operand, FrequencyOf):
            return self._frequencies.within(node, operand, lower, upper)
        if isinstance(operand, (Part, MissingOf, UnknownOf, EntriesHold, InsideOf)):
            self._no_value(operand, node.operand.span)
            return None
        if not isinstance(operand, Value) or operand.is_tuned:
            message = f"'{node.operand.span.text}' is not read from a topic"
            self._scope.fault(codes.WRONG_OPERAND, message, node.operand.span)
            return None
        if not self._is_number(operand, node.operand):
            return None
        fit = [
            self._is_end(lower, operand, node.lower),
            self._is_end(upper, operand, node.upper),
        ]
        if not all(fit):
            return None
        if isinstance(lower, Quantity) and isinstance(upper, Quantity):
            least, greatest = (each.in_unit(operand.unit) for each in (lower, upper))
            if is_empty(self._scope, node, least, greatest):
                return None
        within = self._within(node, operand, lower, upper)
        return None if within is None else ir.Not(within) if node.negated else within

    def _is_end(self, end: Resolved, operand: Value, term: rules.Term) -> bool:
        if isinstance(end, Quantity):
            return self._units.fit(end, operand, term)
        if isinstance(end, Value) and family(end.type) == "number":
            return self._units.fit(end, operand, term)
        message = f"the end of an interval is a number, '{term.span.text}' is {describe(end)}"
        self._scope.fault(codes.WRONG_OPERAND, message, term.span)
        return False

    def _may_be_empty(self, node: rules.Membership, lower: Ends, upper: Ends) -> bool:
        """Report an interval that no value lies in while its constants are tuned so."""
        closed = node.lower_closed and node.upper_closed
        if lower[1] < upper[0] or (lower[1] == upper[0] and closed):
            return False
        first, last = float(lower[1]), float(upper[0])
        message = (
            f"the interval {node.interval_span.text} can be tuned so that no value lies in it:"
            f" from {first:.6g} to {last:.6g}"
        )
        hint = "narrow the intervals of its constants, so that they do not meet"
        self._scope.fault(codes.EMPTY_INTERVAL, message, node.interval_span, hint)
        return True

    def _within(
        self, node: rules.Membership, operand: Value, lower: Resolved, upper: Resolved
    ) -> ir.Within | None:
        least, lower_closed = self._end(operand, lower, node.lower_closed, math.ceil)
        greatest, upper_closed = self._end(operand, upper, node.upper_closed, math.floor)
        bounds = possible = None
        if isinstance(least, ir.Const) and isinstance(greatest, ir.Const):
            ends = [exact(each.value) for each in (least, greatest)]
            bounds = Bounds(ends[0], ends[1], lower_closed, upper_closed, node.negated)
        else:
            first = ends_of_fixed(self._scope, lower, least, operand)
            last = ends_of_fixed(self._scope, upper, greatest, operand)
            if first is not None and last is not None:
                if self._may_be_empty(node, first, last):
                    return None
                closed = (lower_closed, upper_closed)
                possible = possible_within(first, last, closed, node.negated)
        self._note(node, operand, bounds, equality=False, possible=possible)
        shown = wording("=", operand, lower, upper, brackets=_brackets(node))
        return ir.Within(operand.expression, least, greatest, lower_closed, upper_closed, shown)

    def _end(
        self,
        operand: Value,
        end: Resolved,
        closed: bool,
        inwards: Callable[[Fraction], int],
    ) -> tuple[ir.ValueExpression, bool]:
        if isinstance(end, Value):
            return self._scaled(end, operand), closed
        assert isinstance(end, Quantity)
        number = end.in_unit(operand.unit)
        if not operand.is_integer:
            return ir.Const(rounded_as(number, operand.type)), closed
        if number.denominator == 1:
            return ir.Const(int(number)), closed
        return ir.Const(inwards(number)), True


def _is_fixed(found: Resolved) -> bool:
    """Return whether a side is known when the monitor starts."""
    return isinstance(found, Fixed) or (isinstance(found, Value) and found.is_tuned)


def _is_previous(*values: Value) -> bool:
    """Return whether one of two values is the other at the message before."""
    first, second = (each.expression for each in values)
    return any(
        isinstance(one, ir.Apply) and one.function == "previous" and one.arguments[0] == other
        for one, other in ((first, second), (second, first))
    )


def _brackets(node: rules.Membership) -> str:
    return ("[" if node.lower_closed else "(") + ("]" if node.upper_closed else ")")
