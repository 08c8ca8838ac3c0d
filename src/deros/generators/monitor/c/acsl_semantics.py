"""What a rule means, in ACSL: derived from the rule, not from the code that is emitted for it.

A condition is given by two predicates, when it is true and when it is false; otherwise it is
unknown. They read the struct as it is after an event. The code computes one verdict of three values
instead, and the two are proved to agree.
"""

from __future__ import annotations

from deros.generators.monitor.c.expressions import SYMBOLS, known_of
from deros.generators.monitor.c.layout import Layout, compared
from deros.generators.monitor.c.literals import number
from deros.monitor.ir import (
    Age,
    And,
    Compare,
    Condition,
    Const,
    Failsafe,
    For,
    Missing,
    Not,
    Operator,
    Or,
    RuleRef,
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
    """Writes conditions as predicates on ``m``."""

    def __init__(self, layout: Layout) -> None:
        """Remember what is named how."""
        self._layout = layout

    def true(self, condition: Condition) -> str:
        """Return when a condition is true."""
        match condition:
            case Truth(operand=Const(value=value)):
                return "\\true" if value else "\\false"
            case Truth() | Compare() | Within():
                return f"({self._known(condition)} && {self._holds(condition)})"
            case Missing():
                return f"m->{self._layout.inputs[condition.input].missing} != 0"
            case Unknown():
                known = known_of(self._layout, condition)
                return f"(m->{known} == 0 && {self._has_come(condition.input)})"
            case Age():
                return f"({self._came(condition)} && {self._age(condition)})"
            case Not():
                return self.false(condition.operand)
            case And():
                return _joined(" && ", [self.true(each) for each in condition.operands])
            case Or():
                return _joined(" || ", [self.true(each) for each in condition.operands])
            case For():
                if condition.index not in self._layout.since:
                    return self.true(condition.operand)
                return f"({self.runs(condition)} && {self.lasted(condition)})"
            case Failsafe():
                come = [self._has_come(index) for index in condition.inputs]
                due = _joined(" && ", [f"!({self.false(condition.operand)})", *come])
                return f"({self.true(condition.operand)} || {due})"
            case RuleRef():
                verdict = self._layout.verdicts[condition.rule]
                return f"m->{verdict} == {self._layout.macro}_TRUE"

    def false(self, condition: Condition) -> str:
        """Return when a condition is false."""
        match condition:
            case Truth(operand=Const(value=value)):
                return "\\false" if value else "\\true"
            case Truth() | Compare() | Within():
                return f"({self._known(condition)} && !{self._holds(condition)})"
            case Missing():
                return f"m->{self._layout.inputs[condition.input].missing} == 0"
            case Unknown():
                known = known_of(self._layout, condition)
                return f"(m->{known} != 0 || !{self._has_come(condition.input)})"
            case Age():
                return f"({self._came(condition)} && !{self._age(condition)})"
            case Not():
                return self.true(condition.operand)
            case And():
                return _joined(" || ", [self.false(each) for each in condition.operands])
            case Or():
                return _joined(" && ", [self.false(each) for each in condition.operands])
            case For():
                false = self.false(condition.operand)
                if condition.index not in self._layout.since:
                    return false
                return f"({false} || ({self.runs(condition)} && !{self.lasted(condition)}))"
            case Failsafe():
                return self.false(condition.operand)
            case RuleRef():
                verdict = self._layout.verdicts[condition.rule]
                return f"m->{verdict} == {self._layout.macro}_FALSE"

    def _has_come(self, index: int) -> str:
        """Return when an input is not awaited: it has come, or is missing."""
        fields = self._layout.inputs[index]
        return f"(m->{fields.came} != 0 || m->{fields.missing} != 0)"

    def runs(self, condition: For) -> str:
        """Return when an interval is running, which it must exactly while its operand is true.

        What an interval means is said by this name, not by what its operand means: that would be
        repeated for each interval around it, and be twice as long with each level.
        """
        return f"m->{self._layout.since[condition.index]} != {self._layout.macro}_UNSET"

    def lasted(self, condition: For) -> str:
        """Return when a running interval has lasted for long enough."""
        since = self._layout.since[condition.index]
        return f"(m->now >= m->{since} + {condition.duration_ns})"

    def _came(self, condition: Age) -> str:
        return f"m->{self._layout.inputs[condition.input].came} != 0"

    def _age(self, condition: Age) -> str:
        base = self._layout.inputs[condition.input].base
        return f"(m->now - m->{base} {SYMBOLS[condition.operator]} {condition.bound_ns})"

    def _known(self, condition: Truth | Compare | Within) -> str:
        flags = dict.fromkeys(self._layout.terms[value].known for value in compared(condition))
        return " && ".join(f"m->{flag} != 0" for flag in flags)

    def _holds(self, condition: Truth | Compare | Within) -> str:
        finding = self._layout.findings.get(condition)
        return f"(m->{finding.name} != 0)" if finding else self.holds(condition)

    def holds(self, condition: Condition) -> str:
        """Return whether a comparison of values, which must be known, holds."""
        match condition:
            case Truth():
                return f"(m->{self._layout.terms[condition.operand].name} != 0)"
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
            return f"m->{self._layout.terms[value].name}"
        if isinstance(value.value, str):
            return str(self._layout.terms[other].texts.index(value.value) + 1)
        if isinstance(value.value, bool):
            return "1" if value.value else "0"
        if self._is_double(other) or isinstance(value.value, float):
            return f"(double){number(float(value.value))}"
        return str(value.value)


def _joined(word: str, parts: list[str]) -> str:
    return f"({word.join(parts)})"
