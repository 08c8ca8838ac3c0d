"""Checks of conditions that are always or never true, and of exact float comparisons."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from decimal import Decimal
from fractions import Fraction

from deros import codes
from deros.diagnostics import Code, Diagnostic, report
from deros.interfaces.units import Unit
from deros.models.rules import (
    And,
    Begins,
    Behaviour,
    Boolean,
    Comparison,
    Condition,
    Entries,
    For,
    Membership,
    NamePath,
    Negative,
    Not,
    Number,
    Once,
    Or,
    Rule,
    Rules,
    Since,
    Term,
    Times,
    Truth,
    operands,
)
from deros.rules.compiler.scope.resolved import ResolvedComparison, Value, is_float
from deros.rules.program.bounds import SHARE, Bounds, Ends
from deros.rules.program.ir import Operator, ValueExpression
from deros.validators.rules.rules_numbers import Number as Bound
from deros.validators.rules.rules_numbers import NumberSet
from deros.validators.rules_walk import RulesByName, rules_of, terms_of

_ANGLE = (("rad", Fraction(1)),)


def check_ranges(rules: Rules, comparisons: Sequence[ResolvedComparison]) -> Iterator[Diagnostic]:
    """Yield conditions that are never or always true, alone or combined, and float equalities."""
    ranges = _Ranges(rules, comparisons)
    for full_name, _ in rules_of(rules):
        ranges.of_rule(full_name)
    for behaviour in rules.behaviours:
        ranges.solve_behaviour(behaviour, {})
    yield from ranges.findings
    decided = {each.span for each in ranges.findings}
    for each in comparisons:
        if each.exact and each.condition.span not in decided:
            yield _exact(each)


_Key = ValueExpression | str
"""A value that is compared or, by its text, a boolean one."""

_Needs = dict[_Key, NumberSet]
"""The values that operands must have; those that may have any value are left out."""


@dataclass(frozen=True, slots=True)
class _Solution:
    """What operands must be, at the event itself, while a condition is true and while it is false.

    Both are necessary, not sufficient: memories of earlier events, and rules that are failsafe, may
    leave them wider. Of a condition that is decided, and reported, nothing is known.
    """

    true: _Needs = field(default_factory=dict)
    false: _Needs = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class _Operand:
    """What findings say of an operand."""

    name: str
    unit: Unit | None
    is_integer: bool
    is_share: bool = False


class _Ranges:
    """Solves conditions from the inside out, and reports each decided one once."""

    def __init__(self, rules: Rules, comparisons: Sequence[ResolvedComparison]) -> None:
        self.findings: list[Diagnostic] = []
        self._constants = {each.name.text: each.value for each in rules.constants}
        # The models are trees that live as long as this: identity distinguishes equal comparisons.
        self._comparisons = {id(each.condition): each for each in comparisons}
        self._operands: dict[_Key, _Operand] = {}
        self._names = RulesByName(rules)
        self._solved: dict[str, _Solution] = {}

    def of_rule(self, full_name: str) -> _Solution:
        """Return the solution of a rule by its full name; of those that it names, too."""
        entered: set[str] = set()
        open_ = [full_name]
        while open_:
            name = open_[-1]
            named = dict.fromkeys(each for _, each in self._names.named_by_rule(name))
            waiting = [each for each in named if each not in self._solved and each not in entered]
            entered.add(name)
            if waiting:  # one that depends on itself, which is reported, does not wait for itself
                open_ += waiting
                continue
            open_.pop()
            if name not in self._solved:
                self._solved[name] = self._of(*self._names[name])
        return self._solved[full_name]

    def _of(self, entity: str, rule: Rule) -> _Solution:
        found = self._solve(rule.condition, entity)
        return _Solution({}, found.false) if rule.failsafe else found  # true may mean unknown

    def solve_behaviour(self, behaviour: Behaviour, outer: _Needs) -> None:
        """Solve the conditions of a behaviour, and of those in it, whose outer one is true."""
        true = self._solve(behaviour.condition, "").true
        both = _intersection([outer, true])
        lost = self._impossible(both)
        if lost is not None:
            message = (
                "this is never true where the 'if' around it is: the conditions on"
                f" '{self._operands[lost].name}' contradict each other"
            )
            self._report(codes.NEVER_TRUE, message, behaviour.condition, lost)
            both = outer
        for item in behaviour.body:
            if isinstance(item, Behaviour):
                self.solve_behaviour(item, both)

    def _solve(self, condition: Condition, entity: str) -> _Solution:
        for term in () if operands(condition) else terms_of(condition):
            if isinstance(term, Entries):  # for itself: another one may be about other entries
                self._solve(term.condition, entity)
        match condition:
            case Comparison() | Membership():
                return self._alone(condition)
            case Truth():
                return self._truth(condition, entity)
            case Not():
                found = self._solve(condition.operand, entity)
                return _Solution(found.false, found.true)
            case And() | Or():
                return self._together(condition, entity)
            case For() | Begins():  # false, it may be true for too short a time, or from before
                return _Solution(self._solve(condition.operand, entity).true)
            case Once():  # it may be true from before
                return _Solution(false=self._solve(condition.operand, entity).false)
            case Times():  # as often says nothing about now
                self._solve(condition.operand, entity)
                return _Solution()
            case Since():
                return self._since(condition, entity)

    def _alone(self, condition: Comparison | Membership) -> _Solution:
        comparison = self._comparisons.get(id(condition))
        if comparison is not None and comparison.possible is not None:
            return self._tuned(condition, comparison.operand, comparison.possible)
        if comparison is None or comparison.bounds is None:
            if comparison is not None and comparison.other is not None:
                self._between(condition, comparison.operand, *comparison.other)
            return _Solution()
        operand, bounds = comparison.operand, comparison.bounds
        values, why = _numbers(bounds), _range_of(operand)
        if operand.is_integer:
            values = values.of_integers()
            why = "the value is an integer" if values.is_empty else why
        if bounds.outside:
            values = values.complement()
        key, possible = self._operand(operand)
        found = _Solution({key: possible & values}, {key: possible & values.complement()})
        return self._undecided(found, condition, f"'{condition.span.text}'", (why, why))

    def _operand(self, operand: Value) -> tuple[_Key, NumberSet]:
        """Return the key of an operand, and its possible values."""
        assert operand.input is not None
        known = _Operand(
            operand.input.name,
            operand.unit,
            operand.is_integer,
            not operand.is_integer and operand.bounds == SHARE,
        )
        self._operands.setdefault(operand.expression, known)
        return operand.expression, NumberSet.between(*operand.bounds)

    def _tuned(
        self, condition: Condition, operand: Value, possible: tuple[Bounds, Bounds]
    ) -> _Solution:
        """Solve a comparison with tunable constants, for all of their values together."""
        key, values = self._operand(operand)
        true, false = (
            values & (_numbers(each).complement() if each.outside else _numbers(each))
            for each in possible
        )
        why = f"{_range_of(operand)}, whatever the constants are set to"
        found = _Solution({key: true}, {key: false})
        return self._undecided(found, condition, f"'{condition.span.text}'", (why, why))

    def _truth(self, condition: Truth, entity: str) -> _Solution:
        term = condition.operand
        match term:
            case Boolean():
                return _Solution()
            case NamePath() if (full_name := self._names.full_name(term, entity)) is not None:
                return self._solved.get(full_name, _Solution())
        key = " ".join(term.span.text.split())
        self._operands.setdefault(key, _Operand(key, None, is_integer=True))
        return _Solution({key: NumberSet.between(1, 1)}, {key: NumberSet.between(0, 0)})

    def _between(self, condition: Condition, left: Value, operator: Operator, right: Value) -> None:
        """Report a comparison of two values that the bounds of both decide."""
        hint = ""
        if left.expression == right.expression:
            verdict, why = operator in ("=", "<=", ">="), "both sides are the same value"
            hint = _of_nan(left, operator)
        else:
            ends = _in_unit(right, left.unit)
            decided = _decided(operator, left.bounds, ends)
            if decided is None:
                return
            verdict, why = decided, f"{_range_of(left)}, the other one {_span_of(ends, left.unit)}"
        code, word = (codes.ALWAYS_TRUE, "always") if verdict else (codes.NEVER_TRUE, "never")
        message = f"'{condition.span.text}' is {word} true: {why}"
        self.findings.append(report(code, message, condition.span, hint))

    def _together(self, condition: And | Or, entity: str) -> _Solution:
        parts = [self._solve(each, entity) for each in condition.operands]
        true, false = [each.true for each in parts], [each.false for each in parts]
        if isinstance(condition, And):
            found = _Solution(_intersection(true), _union(false))
        else:
            found = _Solution(_union(true), _intersection(false))
        never = "its conditions on {} contradict each other"
        always = "whatever the value of {}, one of its conditions holds"
        return self._undecided(found, condition, "this", (never, always))

    def _since(self, condition: Since, entity: str) -> _Solution:
        operand, cause = (
            self._solve(each, entity) for each in (condition.operand, condition.cause)
        )
        why = hint = ""
        match condition.cause:
            case Truth(operand=Boolean(value=False)):
                why = "its cause is never true"
            case _ if self._impossible(_intersection([operand.true, cause.false])) is not None:
                kept, began = condition.operand.span.text, condition.cause.span.text
                why = f"whenever '{kept}' is true, '{began}' is true as well"
                hint = "a hysteresis begins at the stricter bound and lasts until the weaker one"
        if why:
            message = f"'{condition.span.text}' remembers nothing: {why}"
            finding = report(codes.SINCE_WITHOUT_MEMORY, message, condition.span, hint)
            self.findings.append(finding)
        return _Solution(_union([operand.true, cause.true]), cause.false)

    def _undecided(
        self, found: _Solution, condition: Condition, what: str, why: tuple[str, str]
    ) -> _Solution:
        """Return a solution that leaves both verdicts open; report one that does not."""
        for needs, code, word, reason in (
            (found.true, codes.NEVER_TRUE, "never", why[0]),
            (found.false, codes.ALWAYS_TRUE, "always", why[1]),
        ):
            lost = self._impossible(needs)
            if lost is not None:
                reason = reason.format(f"'{self._operands[lost].name}'")
                self._report(code, f"{what} is {word} true: {reason}", condition, lost)
                return _Solution()
        return found

    def _impossible(self, needs: _Needs) -> _Key | None:
        """Return an operand that can have none of the values needed."""
        for key, values in needs.items():
            drawn = values.of_integers() if self._operands[key].is_integer else values
            if drawn.is_empty:
                return key
        return None

    def _report(self, code: Code, message: str, condition: Condition, key: _Key) -> None:
        """Report a decided condition, with a hint where degrees or percent were probably meant."""
        unit = self._operands[key].unit
        hint = ""
        if unit is not None and unit.exponents in (_ANGLE, ()) and unit.factor == 1:
            plain = (self._plain(term) for term in terms_of(condition))
            number = next((each for each in plain if each is not None), None)
            if number is not None and unit.exponents and abs(number) > math.pi:
                hint = f"a number without a unit is in rad here: write '{number} deg'"
            is_share = self._operands[key].is_share
            if number is not None and is_share and 1 < number <= 100:
                hint = f"1 is the whole here: write '{number} %'"
        self.findings.append(report(code, message, condition.span, hint))

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


def _exact(comparison: ResolvedComparison) -> Diagnostic:
    """Report a comparison of floating-point values that rounding and noise decide."""
    condition = comparison.condition
    unequal = isinstance(condition, Comparison) and condition.operator == "!="
    verdict = "true for all values but one" if unequal else "true for one value alone"
    if comparison.other is None:
        hint = f"write an interval: '{'not in' if unequal else 'in'} [a, b]'"
    else:
        hint = f"compare the difference: 'abs(x - y) {'>' if unequal else '<='} a'"
    return report(
        codes.EXACT_FLOAT_COMPARISON,
        f"'{condition.span.text}' is {verdict}: it compares floating-point values exactly",
        condition.span,
        f"noise and rounding decide it; {hint}",
    )


def _numbers(bounds: Bounds) -> NumberSet:
    """Return the numbers between bounds."""
    return NumberSet.between(bounds.lower, bounds.upper, bounds.lower_closed, bounds.upper_closed)


def _intersection(parts: Iterable[_Needs]) -> _Needs:
    """Return what is needed where every part holds."""
    found: _Needs = {}
    for part in parts:
        for key, values in part.items():
            found[key] = found[key] & values if key in found else values
    return found


def _union(parts: Sequence[_Needs]) -> _Needs:
    """Return what is needed where any of the parts holds."""
    first, *others = parts
    found: _Needs = {}
    for key, values in first.items():
        for other in others:
            if key not in other:
                break
            values = values | other[key]
        else:
            found[key] = values
    return found


def _of_nan(value: Value, operator: Operator) -> str:
    """Return a hint where a test for NaN was probably meant."""
    if not is_float(value.type) or operator not in ("=", "!="):
        return ""
    assert value.input is not None
    name = value.input.name
    asked = f"{name}.unknown()"
    return f"a NaN makes '{name}' unknown: write '{'not ' * (operator == '=')}{asked}'"


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
