"""Conditions that the range of their values decides for ever, and exact comparisons of floats."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from fractions import Fraction

from deros import codes
from deros.diagnostics import Diagnostic, report
from deros.metamodels.rules import And, Comparison, Condition, For, Membership, Not, Or, Rules
from deros.monitor.ir import ValueExpression
from deros.monitor.resolved import ResolvedComparison, Value
from deros.validators.rules_numbers import Number, NumberSet
from deros.validators.rules_walk import rules_of


def check_ranges(rules: Rules, comparisons: Sequence[ResolvedComparison]) -> Iterator[Diagnostic]:
    """Yield what is never or always true, alone or together, and float equalities."""
    ranges = _Ranges(comparisons)
    for _, rule in rules_of(rules):
        ranges.solve(rule.condition)
    yield from ranges.findings
    for each in comparisons:
        if each.exact:
            yield report(
                codes.EXACT_FLOAT_COMPARISON,
                f"'{each.condition.span.text}' compares floating-point values exactly",
                each.condition.span,
                "the least rounding decides it; compare with an interval: 'in [a, b]'",
            )


class _Solution:
    """The values of one operand that satisfy a condition, out of those that it can have."""

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
    """Solves conditions from the inside out, and reports a decided one once, where it is."""

    def __init__(self, comparisons: Sequence[ResolvedComparison]) -> None:
        self.findings: list[Diagnostic] = []
        # The models are trees that live as long as this: identity tells equal comparisons apart.
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
            case For():
                self.solve(condition.operand)
        return None

    def _alone(self, condition: Comparison | Membership) -> _Solution | None:
        comparison = self._comparisons.get(id(condition))
        if comparison is None or comparison.bounds is None:
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
            self.findings.append(report(codes.NEVER_TRUE, message, condition.span))
            return None
        if others.is_empty:
            message = f"{what} is always true: {why_always}"
            self.findings.append(report(codes.ALWAYS_TRUE, message, condition.span))
            return None
        return found


def _range_of(operand: Value) -> str:
    unit = f" {operand.unit}" if operand.unit and operand.unit.text != "1" else ""
    least, greatest = operand.bounds
    if greatest == math.inf:
        return f"the value is {_shown(least)}{unit} or more"
    return f"the value is from {_shown(least)} to {_shown(greatest)}{unit}"


def _shown(number: Number) -> str:
    if isinstance(number, Fraction) and number.denominator == 1:
        return str(number)
    return f"{float(number):.6g}"
