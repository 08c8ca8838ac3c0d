"""Values and conditions of the rules as C expressions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from deros.generators.monitor.c.code.computed import entries_functions
from deros.generators.monitor.c.code.layout import Layout
from deros.generators.monitor.c.code.literals import integer, literal, number
from deros.generators.monitor.c.code.value_types import compared, type_of
from deros.generators.monitor.computed import points_name
from deros.generators.text.c import Call, Expression, Infix
from deros.rules.engine.evaluate import COMPARE
from deros.rules.functions.functions import FUNCTIONS, Argument, Result
from deros.rules.program import walk
from deros.rules.program.ir import (
    Active,
    Age,
    And,
    Apply,
    Begins,
    Compare,
    Compute,
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
    Program,
    Read,
    RuleRef,
    Scale,
    Since,
    Times,
    Truth,
    Tuned,
    Unknown,
    ValueExpression,
    Within,
)

SYMBOLS: dict[Operator, str] = {
    "=": "==",
    "!=": "!=",
    "<": "<",
    "<=": "<=",
    ">": ">",
    ">=": ">=",
}


class Conditions:
    """Prints conditions as expressions of the verdict type."""

    def __init__(self, program: Program, layout: Layout) -> None:
        """Use the names of a layout."""
        self._program = program
        self._layout = layout
        self._intervals: dict[str, dict[int, str]] = {}

    def interval(self, condition: For | Once | Times) -> str:
        """Return the local constant that holds an interval's verdict."""
        word = condition.row.word
        names = self._intervals.setdefault(word, {})
        return names.setdefault(condition.index, f"{word}_{len(names) + 1}")

    def verdict(self, condition: Condition) -> Expression:
        """Return a condition; its intervals are local constants."""
        macro = self._layout.macro
        match condition:
            case Truth(operand=Const(value=value)):
                return f"{macro}_TRUE" if value else f"{macro}_FALSE"
            case Truth() | Compare() | Within():
                return self._known(condition)
            case Missing():
                return Call(
                    "truth_of", ("true", f"m->{self._layout.inputs[condition.input].missing}")
                )
            case Unknown():
                known = f"(!m->{known_of(self._layout, condition)})"
                come = f"({self._has_come(condition.input)})"
                return Call("truth_of", ("true", Infix("&&", (known, come))))
            case Age():
                fields = self._layout.inputs[condition.input]
                age = f"(m->now - m->{fields.base})"
                held = f"{age} {SYMBOLS[condition.operator]} {integer(condition.bound_ns)}"
                return Call("truth_of", (f"m->{fields.came}", held))
            case Frequency():
                first = self._layout.inputs[condition.input].stamps[condition.messages - 1]
                held = f"(m->now - m->{first}) >= {integer(condition.elapsed_ns)}"
                return Call("truth_of", ("true", held))
            case Not():
                return Call("negated", (self.verdict(condition.operand),))
            case And():
                return self._nested("both", condition.operands)
            case Or():
                return self._nested("either", condition.operands)
            case For():
                timed = condition.index in self._layout.since
                return self.interval(condition) if timed else self.verdict(condition.operand)
            case Once():
                timed = condition.index in self._layout.until
                return self.interval(condition) if timed else self.verdict(condition.operand)
            case Times():
                return self.interval(condition)
            case Since():
                kept = f"m->{self._layout.kept[condition.index]}"
                if not condition.inputs:
                    return kept
                return Call("either", (self.verdict(condition.cause), kept))
            case Begins(operand=lasting):
                since = f"m->{self._layout.since[lasting.index]}"
                return Call("begun", (self.interval(lasting), since))
            case Failsafe():
                return self._failsafe(condition)
            case RuleRef():
                return f"m->{self._layout.verdicts[condition.rule]}"
            case Active():
                return Call("truth_of", ("true", f"m->{self._layout.active[condition.action]}"))

    def _failsafe(self, condition: Failsafe) -> Expression:
        come = [self._has_come(index) for index in condition.inputs]
        due = come if len(come) == 1 else [f"({each})" for each in come]
        operand = self.verdict(condition.operand)
        return Call("failsafe", (operand, Infix("&&", tuple(due))))

    def cause(self, condition: Since) -> Expression:
        """Return the cause of a ``since``; unknown, it is none before its inputs have come."""
        cause = self.verdict(condition.cause)
        if not condition.inputs:
            return cause
        come = [f"m->{self._layout.inputs[index].came}" for index in condition.inputs]
        return Call("heard", (cause, Infix("&&", tuple(come))))

    def _has_come(self, index: int) -> str:
        """Return whether an input is not awaited: it has come, or is missing."""
        fields = self._layout.inputs[index]
        return f"m->{fields.came} || m->{fields.missing}"

    def _nested(self, function: str, operands: Sequence[Condition]) -> Expression:
        """Return a call of two halves: compilers do not take calls nested too deeply."""
        if len(operands) == 1:
            return self.verdict(operands[0])
        half = (len(operands) + 1) // 2
        first, second = operands[:half], operands[half:]
        return Call(function, (self._nested(function, first), self._nested(function, second)))

    def _known(self, condition: Truth | Compare | Within) -> Expression:
        flags = dict.fromkeys(
            f"m->{self._layout.terms[value].known}" for value in walk.changing(compared(condition))
        )
        known = Infix("&&", tuple(flags))
        finding = self._layout.findings.get(condition)
        holds = f"m->{finding.name}" if finding else self.holds(condition)
        return Call("truth_of", (known, holds))

    def holds(self, condition: Condition) -> Expression:
        """Return the comparison of values that are known."""
        match condition:
            case Truth():
                return self._operand(condition.operand)
            case Compare():
                return self._compare(condition.left, condition.operator, condition.right)
            case Within():
                lower: Operator = ">=" if condition.lower_closed else ">"
                upper: Operator = "<=" if condition.upper_closed else "<"
                above = self._compare(condition.operand, lower, condition.lower)
                below = self._compare(condition.operand, upper, condition.upper)
                return Infix("&&", (f"({above})", f"({below})"))
            case _:
                raise AssertionError("no comparison of values")

    def _compare(self, left: ValueExpression, operator: Operator, right: ValueExpression) -> str:
        if left == right:  # known, and so no NaN
            return literal(COMPARE[operator](0, 0))
        kinds = {type_of(self._program, left), type_of(self._program, right)}
        if "text" in kinds:
            return self._compare_text(left, operator, right)
        if kinds == {"bool"}:
            return self._compare_truth(left, operator, right)
        if isinstance(right, Const) and isinstance(right.value, int) and "double" not in kinds:
            return self._compare_integer(left, operator, right.value)
        cast = "double" if "double" in kinds and len(kinds) > 1 else ""
        first, second = self._operand(left, cast), self._operand(right, cast)
        return f"{first} {SYMBOLS[operator]} {second}"

    def _operand(self, value: ValueExpression, cast: str = "") -> str:
        if isinstance(value, Const):
            assert not isinstance(value.value, str)
            return literal(float(value.value) if cast else value.value)
        term = self._layout.terms[value]
        return f"m->{term.name}" if not cast or term.type == cast else f"({cast})m->{term.name}"

    def _compare_truth(
        self, left: ValueExpression, operator: Operator, right: ValueExpression
    ) -> str:
        for constant, other in ((left, right), (right, left)):
            if isinstance(constant, Const):
                straight = bool(constant.value) == (operator == "=")
                return f"{'' if straight else '!'}{self._operand(other)}"
        return f"{self._operand(left)} {SYMBOLS[operator]} {self._operand(right)}"

    def _compare_integer(self, left: ValueExpression, operator: Operator, right: int) -> str:
        """Compare with a constant; the result may be the same for all possible values."""
        unsigned = type_of(self._program, left) == "uint64_t"
        lowest, highest = (0, 2**64 - 1) if unsigned else (-(2**63), 2**63 - 1)
        tried = {lowest, highest, *({right} if lowest <= right <= highest else ())}
        results = {COMPARE[operator](each, right) for each in tried}
        if len(results) == 1:
            return literal(results.pop())
        bound = f"{right}ULL" if unsigned else integer(right)
        return f"{self._operand(left)} {SYMBOLS[operator]} {bound}"

    def _compare_text(
        self, left: ValueExpression, operator: Operator, right: ValueExpression
    ) -> str:
        value, constant = (right, left) if isinstance(left, Const) else (left, right)
        term = self._layout.terms[value]
        assert isinstance(constant, Const)
        place = term.texts.index(str(constant.value)) + 1
        return f"m->{term.name} {SYMBOLS[operator]} {place}U"


def known_of(layout: Layout, condition: Unknown) -> str:
    """Return the flag that the value that a condition asks for is known."""
    if condition.operand is None:
        return layout.inputs[condition.input].known
    return layout.terms[condition.operand].known


@dataclass(frozen=True, slots=True)
class Arguments:
    """The names in a handler.

    Attributes:
        leaves: the arguments, by leaf; an array's elements stand with their count.
        counts: the number of elements, by the leaf of an array.
        computed: the local constants that hold the results of functions with a memory.
        lengths: those that hold the lengths of quaternions, by their parts.
    """

    leaves: dict[int, str]
    counts: dict[int, str]
    computed: dict[Apply, str] = field(default_factory=dict)
    lengths: dict[tuple[ValueExpression, ...], str] = field(default_factory=dict)


def expression(value: ValueExpression, program: Program, arguments: Arguments) -> str:
    """Return a value computed from the arguments of a handler."""
    match value:
        case Const():
            assert not isinstance(value.value, str)
            return literal(value.value)
        case Read():
            return arguments.leaves[value.leaf]
        case Scale():
            operand = as_double(value.operand, program, arguments)
            scaled = f"({operand} * {number(value.factor)})"
            return f"({scaled} + {number(value.offset)})" if value.offset else scaled
        case Compute() | Tuned():
            raise AssertionError("it is read from the fields that hold it, or its operands")
        case Apply():
            if value in arguments.computed:
                return arguments.computed[value]
            if FUNCTIONS[value.function].reads_length:
                array = value.arguments[0]
                assert isinstance(array, Read)
                return f"(int64_t){arguments.counts[array.leaf]}"
            if value.entry is not None:
                arrays = ", ".join(expression(each, program, arguments) for each in value.arguments)
                return f"(int64_t){entries_functions(program)[value].name}({arrays})"
            row = FUNCTIONS[value.function]
            is_cast = row.argument is Argument.NUMBER and type_of(program, value) == "double"
            text_of = as_double if is_cast else expression
            texts = [text_of(each, program, arguments) for each in value.arguments]
            if value.arguments in arguments.lengths:
                texts = [f"{text} / {arguments.lengths[value.arguments]}" for text in texts]
            return f"{function_name(value, program)}({', '.join(texts)})"


def as_double(value: ValueExpression, program: Program, arguments: Arguments) -> str:
    """Return a number of any type as a double; NaN if it is unknown."""
    text = expression(value, program, arguments)
    if type_of(program, value) == "double":
        return text
    there = present(value, program, arguments)
    return f"({there} ? (double){text} : NAN)" if there else f"(double){text}"


def present(value: ValueExpression, program: Program, arguments: Arguments) -> str:
    """Return the condition for an integer to be known: arrays with a minimum have elements."""
    if type_of(program, value) == "double" or not isinstance(value, Apply):
        return ""
    if value.entry is not None:
        first, *others = (
            arguments.counts[each.leaf] for each in value.arguments if isinstance(each, Read)
        )
        there = [f"({first} > 0U)", *(f"({first} == {other})" for other in others)]
        return there[0] if len(there) == 1 else f"({' && '.join(there)})"
    operand = value.arguments[0]
    row = FUNCTIONS[value.function]
    if row.loop is None or row.result is not Result.ELEMENT:
        return present(operand, program, arguments)
    assert isinstance(operand, Read)
    return f"({arguments.counts[operand.leaf]} > 0U)"


def function_name(value: Apply, program: Program) -> str:
    """Return the name of the C function that computes a value; arrays have one per element type."""
    row, first = FUNCTIONS[value.function], value.arguments[0]
    if row.argument is Argument.NUMBER and type_of(program, value) != "double":
        return row.c_integer
    if value.zone is not None:
        return points_name(value)
    if row.argument is Argument.NUMBERS:
        assert isinstance(first, Read)
        return f"{row.c_name}_{program.leaves[first.leaf].type.base}"
    return row.c_name
