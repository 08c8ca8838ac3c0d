"""Checks of conditions that are always or never true, and of exact float comparisons."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from decimal import Decimal
from fractions import Fraction

from deros import codes
from deros.diagnostics import Code, Diagnostic, report
from deros.interfaces.units import Unit
from deros.metamodels.rules import (
    And,
    Begins,
    Comparison,
    Condition,
    For,
    Membership,
    NamePath,
    Negative,
    Not,
    Number,
    Once,
    Or,
    Rules,
    Since,
    Term,
)
from deros.monitor.bounds import Ends
from deros.monitor.ir import Operator, ValueExpression
from deros.monitor.resolved import ResolvedComparison, Value
from deros.validators.rules_numbers import Number as Bound
from deros.validators.rules_numbers import NumberSet
from deros.validators.rules_walk import rules_of, terms_of

_ANGLE = (("rad", Fraction(1)),)


def check_ranges(rules: Rules, comparisons: Sequence[ResolvedComparison]) -> Iterator[Diagnostic]:
    """Yield conditions that are never or always true, alone or combined, and float equalities."""
    ranges = _Ranges(rules, comparisons)
    for _, rule in rules_of(rules):
        ranges.solve(rule.condition)
    yield from ranges.findings
    for each in comparisons:
        if each.exact:
            yield report(
                codes.EXACT_FLOAT_COMPARISON,
                f"'{each.condition.span.text}' compares floating-point values exactly",
                each.condition.span,
                "the result depends on rounding; compare with an interval: 'in [a, b]'",
            )


class _Solution:
    """The values of one operand that satisfy a condition, among its possible values."""

    def __init__(self, comparison: ResolvedComparison, values: NumberSet) -> None:
        self.comparison = comparison
        self.values = values

    @property
    def operand(self) -> ValueExpression:
        return self.comparison.operand.expression

    @property
    def possible(self) -> NumberSet:
        return NumberSet.between(*self.comparison.operand.bounds)


class _Ranges:
    """Solves conditions from the inside out, and reports each decided one once."""

    def __init__(self, rules: Rules, comparisons: Sequence[ResolvedComparison]) -> None:
        self.findings: list[Diagnostic] = []
        self._constants = {each.name.text: each.value for each in rules.constants}
        # The models are trees that live as long as this: identity distinguishes equal comparisons.
        self._comparisons = {id(each.condition): each for each in comparisons}

    def solve(self, condition: Condition) -> _Solution | None:
        """Return the solution of a condition on one operand, unless it is decided."""
        match condition:
            case Comparison() | Membership():
                return self._alone(condition)
            case Not():
                found = self.solve(condition.operand)
                if found is None:
                    return None
                return _Solution(found.comparison, found.possible & found.values.complement())
            case And() | Or():
                return self._together(condition)
            case For() | Once() | Begins():
                self.solve(condition.operand)
            case Since():
                self.solve(condition.operand)
                self.solve(condition.cause)
        return None

    def _alone(self, condition: Comparison | Membership) -> _Solution | None:
        comparison = self._comparisons.get(id(condition))
        if comparison is None or comparison.bounds is None:
            if comparison is not None and comparison.other is not None:
                self._between(condition, comparison.operand, *comparison.other)
            return None
        bounds = comparison.bounds
        values = NumberSet.between(
            bounds.lower, bounds.upper, bounds.lower_closed, bounds.upper_closed
        )
        why = _range_of(comparison.operand)
        if comparison.operand.is_integer:
            values = values.of_integers()
            why = "the value is an integer" if values.is_empty else why
        if bounds.outside:
            values = values.complement()
        found = _Solution(comparison, NumberSet.between(*comparison.operand.bounds) & values)
        return self._undecided(found, condition, f"'{condition.span.text}'", why, why)

    def _between(self, condition: Condition, left: Value, operator: Operator, right: Value) -> None:
        """Report a comparison of two values that the bounds of both decide."""
        if left.expression == right.expression:
            verdict, why = operator in ("=", "<=", ">="), "both sides are the same value"
        else:
            ends = _in_unit(right, left.unit)
            decided = _decided(operator, left.bounds, ends)
            if decided is None:
                return
            verdict, why = decided, f"{_range_of(left)}, the other one {_span_of(ends, left.unit)}"
        code, word = (codes.ALWAYS_TRUE, "always") if verdict else (codes.NEVER_TRUE, "never")
        message = f"'{condition.span.text}' is {word} true: {why}"
        self.findings.append(report(code, message, condition.span))

    def _together(self, condition: And | Or) -> _Solution | None:
        groups: dict[ValueExpression, _Solution] = {}
        everything = True
        for operand in condition.operands:
            found = self.solve(operand)
            if found is None:
                everything = False
                continue
            before = groups.get(found.operand)
            if before is None:
                groups[found.operand] = found
                continue
            if isinstance(condition, And):
                values = before.values & found.values
            else:
                values = before.values | found.values
            name = found.comparison.operand.input.name
            together = self._undecided(
                _Solution(found.comparison, values),
                condition,
                "this",
                f"its conditions on '{name}' contradict each other",
                f"whatever the value of '{name}', one of its conditions holds",
            )
            if together is None:
                return None
            groups[found.operand] = together
        return next(iter(groups.values())) if everything and len(groups) == 1 else None

    def _undecided(
        self, found: _Solution, condition: Condition, what: str, why_never: str, why_always: str
    ) -> _Solution | None:
        """Return a solution that leaves both verdicts open; report one that does not."""
        satisfying, others = found.values, found.possible & found.values.complement()
        if found.comparison.operand.is_integer:
            satisfying, others = satisfying.of_integers(), others.of_integers()
        if satisfying.is_empty:
            message = f"{what} is never true: {why_never}"
            self.findings.append(self._finding(codes.NEVER_TRUE, message, condition, found))
            return None
        if others.is_empty:
            message = f"{what} is always true: {why_always}"
            self.findings.append(self._finding(codes.ALWAYS_TRUE, message, condition, found))
            return None
        return found

    def _finding(
        self, code: Code, message: str, condition: Condition, found: _Solution
    ) -> Diagnostic:
        """Return the finding, with a hint where degrees were probably meant."""
        unit = found.comparison.operand.unit
        hint = ""
        if unit is not None and unit.exponents == _ANGLE and unit.factor == 1:
            plain = (self._plain(term) for term in terms_of(condition))
            number = next((each for each in plain if each is not None), None)
            if number is not None and abs(number) > math.pi:
                hint = f"a number without a unit is in rad here: write '{number} deg'"
        return report(code, message, condition.span, hint)

    def _plain(self, term: Term) -> Decimal | None:
        """Return the number of a term or constant without a unit."""
        seen: set[str] = set()
        while isinstance(term, NamePath) and term.name.text in self._constants:
            if term.path or term.name.text in seen:
                return None
            seen.add(term.name.text)
            term = self._constants[term.name.text]
        if isinstance(term, Negative):
            number = self._plain(term.operand)
            return None if number is None else -number
        return term.value if isinstance(term, Number) and term.unit is None else None


def _in_unit(value: Value, wanted: Unit | None) -> Ends:
    """Return the bounds of a value in a unit that it converts to."""
    if value.unit is None or wanted is None:
        return value.bounds
    factor = value.unit.factor / wanted.factor
    offset = (value.unit.offset - wanted.offset) / wanted.factor
    least, greatest = (
        each * factor + offset if isinstance(each, Fraction) else each for each in value.bounds
    )
    return least, greatest


def _decided(operator: Operator, left: Ends, right: Ends) -> bool | None:
    """Return the value of a comparison for all numbers between these ends, if it is constant."""
    if operator in (">", ">="):
        left, right = right, left
        operator = "<" if operator == ">" else "<="
    apart = left[0] > right[1] or left[1] < right[0]
    match operator:
        case "<":
            return False if left[0] >= right[1] else True if left[1] < right[0] else None
        case "<=":
            return False if left[0] > right[1] else True if left[1] <= right[0] else None
        case _:
            return (operator == "!=") if apart else None


def _range_of(operand: Value) -> str:
    return f"the value is {_span_of(operand.bounds, operand.unit)}"


def _span_of(ends: Ends, unit: Unit | None) -> str:
    least, greatest = ends
    shown = f" {unit}" if unit and unit.text != "1" else ""
    if greatest == math.inf:
        return f"{_shown(least)}{shown} or more"
    return f"from {_shown(least)} to {_shown(greatest)}{shown}"


def _shown(number: Bound) -> str:
    if isinstance(number, Fraction) and number.denominator == 1:
        return str(number)
    return f"{float(number):.6g}"
