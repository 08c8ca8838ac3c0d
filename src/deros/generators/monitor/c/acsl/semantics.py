"""The semantics of rules in ACSL, derived from the rules and not from the emitted code.

A condition has two predicates: it is true, and it is false. Otherwise it is
unknown. They read the struct as it is after an event. The code computes one verdict of three values
instead, and the two are proved to agree.
"""

from __future__ import annotations

from collections.abc import Callable

from deros.generators.monitor.c.acsl.contracts import iff
from deros.generators.monitor.c.code.expressions import SYMBOLS, known_of
from deros.generators.monitor.c.code.layout import Layout
from deros.generators.monitor.c.code.literals import number
from deros.generators.monitor.c.code.value_types import compared
from deros.rules.program import walk
from deros.rules.program.ir import (
    Active,
    Age,
    And,
    Begins,
    Compare,
    Condition,
    Const,
    Failsafe,
    For,
    Frequency,
    Missing,
    Not,
    Once,
    Operator,
    Or,
    RuleRef,
    Since,
    Times,
    Truth,
    Unknown,
    ValueExpression,
    Within,
)

_OF_DOUBLES: dict[Operator, str] = {
    "=": "\\eq_double",
    "<": "\\lt_double",
    "<=": "\\le_double",
    ">": "\\gt_double",
    ">=": "\\ge_double",
}


class AcslSemantics:
    """Prints conditions as predicates on ``m``."""

    def __init__(self, layout: Layout) -> None:
        """Use the names of a layout."""
        self._layout = layout
        self._read: dict[str, None] = {}  # the fields that were printed, in order

    def fields_of(self, condition: Condition) -> list[str]:
        """Return the fields that tell what a condition is worth, and what it remembers."""
        self._read = {"now": None}
        self.true(condition)
        self.false(condition)
        parts = tuple(walk.parts(condition))
        for since in (each for each in parts if isinstance(each, Since)):
            self.keeps(since, self._m(self._layout.kept[since.index]))
        for once in (each for each in parts if isinstance(each, Once)):
            if once.index in self._layout.until:
                self.until(once, self._m(self._layout.until[once.index]))
        for times in (each for each in parts if isinstance(each, Times)):
            self.counts(times, self._m)
        return list(self._read)

    def _m(self, name: str) -> str:
        """Return a field of the monitor."""
        self._read[name] = None
        return f"m->{name}"

    def true(self, condition: Condition) -> str:
        """Return the predicate that a condition is true."""
        return self._is(condition, True)

    def false(self, condition: Condition) -> str:
        """Return the predicate that a condition is false."""
        return self._is(condition, False)

    def _is(self, condition: Condition, truth: bool) -> str:
        """Return the predicate that a condition is known, and true or false."""
        match condition:
            case Truth(operand=Const(value=value)):
                return "\\true" if bool(value) is truth else "\\false"
            case Truth() | Compare() | Within():
                return f"({self._known(condition)} && {_not(truth)}{self._holds(condition)})"
            case Missing():
                missing = self._layout.inputs[condition.input].missing
                return f"{self._m(missing)} {'!=' if truth else '=='} 0"
            case Unknown():
                known = self._m(known_of(self._layout, condition))
                has_come = self._has_come(condition.input)
                return (
                    f"({known} == 0 && {has_come})" if truth else f"({known} != 0 || !{has_come})"
                )
            case Age():
                return f"({self._came(condition)} && {_not(truth)}{self._age(condition)})"
            case Frequency():
                first = self._layout.inputs[condition.input].stamps[condition.messages - 1]
                elapsed = f"{self._m('now')} - {self._m(first)}"
                return f"({elapsed} {'>=' if truth else '<'} {condition.elapsed_ns})"
            case Not():
                return self._is(condition.operand, not truth)
            case And() | Or():
                word = " && " if isinstance(condition, And) is truth else " || "
                return _joined(word, [self._is(each, truth) for each in condition.operands])
            case For():
                return self._interval(condition, truth)
            case Once():
                return self._once(condition, truth)
            case Times():
                turns = self._layout.turns[condition.index]
                often = f"({self._m('now')} < {self._m(turns.ends[-1])})"
                if truth:
                    return often
                known = f"({self._m(turns.held)} != 0 || {self.false(condition.operand)})"
                return f"(!{often} && {known})"
            case Since():
                kept = f"{self._m(self._layout.kept[condition.index])} == {self._verdict(truth)}"
                if truth or not condition.inputs:
                    return kept
                return f"({kept} && {self.false(condition.cause)})"
            case Begins(operand=lasting):
                if truth:
                    return f"({self.runs(lasting)} && !{self.lasted(lasting)})"
                false = self.false(lasting.operand)
                return f"({false} || ({self.runs(lasting)} && {self.lasted(lasting)}))"
            case Failsafe():
                return self._failsafe(condition) if truth else self.false(condition.operand)
            case Active():
                active = self._m(self._layout.active[condition.action])
                return f"{active} {'!=' if truth else '=='} 0"
            case RuleRef():
                return f"{self._m(self._layout.verdicts[condition.rule])} == {self._verdict(truth)}"

    def _verdict(self, truth: bool) -> str:
        return f"{self._layout.macro}_{'TRUE' if truth else 'FALSE'}"

    def _once(self, condition: Once, truth: bool) -> str:
        if condition.index not in self._layout.until:
            return self._is(condition.operand, truth)
        recent = f"{self._m('now')} < {self._m(self._layout.until[condition.index])}"
        return f"({recent})" if truth else f"(!({recent}) && {self.false(condition.operand)})"

    def until(self, condition: Once, before: str) -> str:
        """Return until when a ``within`` is true, given the expression of that before."""
        never = f"{self._layout.macro}_NEVER"
        end = f"{self._m('now')} + {condition.duration_ns}"
        ceased = f"({before} == {never} ? {end} : {before})"
        until = self._m(self._layout.until[condition.index])
        return f"{until} == ({self.true(condition.operand)} ? {never} : {ceased})"

    def counts(self, condition: Times, before: Callable[[str], str]) -> list[str]:
        """Return the turns of a counted condition, given the expressions of those before."""
        turns, true = self._layout.turns[condition.index], self.true(condition.operand)
        turned = f"{before(turns.held)} == 0 && {true}"
        news = [f"{self._m('now')} + {condition.duration_ns}", *map(before, turns.ends)]
        ends = [
            f"{self._m(end)} == ({turned} ? {new} : {before(end)})"
            for end, new in zip(turns.ends, news, strict=False)
        ]
        return [*ends, iff(f"{self._m(turns.held)} != 0", true)]

    def keeps(self, condition: Since, before: str) -> list[str]:
        """Return what the verdict of a ``since`` is worth, given the expression of that before."""
        kept = self._m(self._layout.kept[condition.index])
        results = []
        for truth in (True, False):
            verdict = self._verdict(truth)
            cause = self.true(condition.cause) if truth else self._is_none(condition)
            operand = f"({self._is(condition.operand, truth)})"
            was = f"{before} == {verdict}"
            meant = (
                f"({cause}) || ({operand} && {was})"
                if truth
                else f"({cause}) && ({operand} || {was})"
            )
            results.append(iff(f"{kept} == {verdict}", f"({meant})"))
        return results

    def _is_none(self, condition: Since) -> str:
        """Return that there is no cause: it is false, or unknown and not all it reads has come."""
        false = self.false(condition.cause)
        come = [f"{self._m(self._layout.inputs[index].came)} == 0" for index in condition.inputs]
        if not come:
            return false
        return f"{false} || ({_joined(' || ', come)} && !({self.true(condition.cause)}))"

    def _interval(self, condition: For, truth: bool) -> str:
        if condition.index not in self._layout.since:
            return self._is(condition.operand, truth)
        if truth:
            return f"({self.runs(condition)} && {self.lasted(condition)})"
        false = self.false(condition.operand)
        return f"({false} || ({self.runs(condition)} && !{self.lasted(condition)}))"

    def _failsafe(self, condition: Failsafe) -> str:
        true, false = self.true(condition.operand), self.false(condition.operand)
        come = [self._has_come(index) for index in condition.inputs]
        return f"({true} || {_joined(' && ', [f'!({false})', *come])})"

    def _has_come(self, index: int) -> str:
        """Return the predicate that an input is not awaited: it has come, or is missing."""
        fields = self._layout.inputs[index]
        return f"({self._m(fields.came)} != 0 || {self._m(fields.missing)} != 0)"

    def runs(self, condition: For) -> str:
        """Return the predicate that an interval is running: its operand is true.

        The predicate names the field, not the operand: the operand's predicate would be
        repeated for each enclosing interval, and double in length with each level.
        """
        return f"{self._m(self._layout.since[condition.index])} != {self._layout.macro}_UNSET"

    def lasted(self, condition: For) -> str:
        """Return the predicate that a running interval has lasted long enough."""
        since = self._layout.since[condition.index]
        return f"({self._m('now')} >= {self._m(since)} + {condition.duration_ns})"

    def _came(self, condition: Age) -> str:
        return f"{self._m(self._layout.inputs[condition.input].came)} != 0"

    def _age(self, condition: Age) -> str:
        age = f"{self._m('now')} - {self._m(self._layout.inputs[condition.input].base)}"
        return f"({age} {SYMBOLS[condition.operator]} {condition.bound_ns})"

    def _known(self, condition: Truth | Compare | Within) -> str:
        changing = walk.changing(compared(condition))
        flags = dict.fromkeys(self._layout.terms[value].known for value in changing)
        return " && ".join(f"{self._m(flag)} != 0" for flag in flags)

    def _holds(self, condition: Truth | Compare | Within) -> str:
        finding = self._layout.findings.get(condition)
        return f"({self._m(finding.name)} != 0)" if finding else self.holds(condition)

    def holds(self, condition: Condition) -> str:
        """Return the comparison of values that are known."""
        match condition:
            case Truth():
                return f"({self._m(self._layout.terms[condition.operand].name)} != 0)"
            case Compare():
                return self._compare(condition.left, condition.operator, condition.right)
            case Within():
                lower: Operator = ">=" if condition.lower_closed else ">"
                upper: Operator = "<=" if condition.upper_closed else "<"
                above = self._compare(condition.operand, lower, condition.lower)
                below = self._compare(condition.operand, upper, condition.upper)
                return f"({above} && {below})"
            case _:
                raise AssertionError("no comparison of values")

    def _compare(self, left: ValueExpression, operator: Operator, right: ValueExpression) -> str:
        first, second = self._operand(left, right), self._operand(right, left)
        if not self._is_double(left) and not self._is_double(right):
            return f"({first} {SYMBOLS[operator]} {second})"
        if operator == "!=":
            return f"(!\\eq_double({first}, {second}))"
        return f"{_OF_DOUBLES[operator]}({first}, {second})"

    def _is_double(self, value: ValueExpression) -> bool:
        if isinstance(value, Const):
            return isinstance(value.value, float)
        return self._layout.terms[value].type == "double"

    def _operand(self, value: ValueExpression, other: ValueExpression) -> str:
        if not isinstance(value, Const):
            cast = self._is_double(other) and not self._is_double(value)
            return f"{'(double)' if cast else ''}{self._m(self._layout.terms[value].name)}"
        if isinstance(value.value, str):
            return str(self._layout.terms[other].texts.index(value.value) + 1)
        if isinstance(value.value, bool):
            return "1" if value.value else "0"
        if self._is_double(other) or isinstance(value.value, float):
            return f"(double){number(float(value.value))}"
        return str(value.value)


def _not(truth: bool) -> str:
    return "" if truth else "!"


def _joined(word: str, parts: list[str]) -> str:
    return f"({word.join(parts)})"
