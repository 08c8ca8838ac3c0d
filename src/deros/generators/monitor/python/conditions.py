"""Three-valued conditions as two-valued questions: is it true, is it false?

Both answers are no if the condition is unknown. As unknown numbers are stored as NaN, with which
every comparison is false, most conditions need no test for *unknown* at all: ``speed > 0.5`` is the
question whether it is true, ``speed <= 0.5`` whether it is false.
"""

from __future__ import annotations

import math

from deros.generators.monitor.python.layout import Layout
from deros.generators.text.logic import Atom, Logic, NoneOf, all_of, any_of
from deros.interfaces.types import FLOAT_TYPES, INTEGER_RANGES
from deros.rules.engine.evaluate import COMPARE
from deros.rules.functions.functions import FUNCTIONS, Result
from deros.rules.program import walk
from deros.rules.program.ir import (
    MIRRORED,
    OPPOSITE,
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
    Scalar,
    Scale,
    Since,
    Times,
    Truth,
    Tuned,
    Unknown,
    ValueExpression,
    Within,
)


class Conditions:
    """Emits the conditions of one program. Names are those of local copies of the attributes."""

    def __init__(self, program: Program, layout: Layout, now: str = "t") -> None:
        """Emit for ``program`` with the names of ``layout``; ``now`` is that of the time."""
        self._program = program
        self._layout = layout
        self._now = now
        self.lasting: dict[Condition, str] = {}
        """The conditions of intervals that are up to date, with the end of each."""

    def true(self, condition: Condition) -> Logic:
        """Return the question whether a condition is true."""
        if condition in self.lasting:
            return Atom(f"{self.lasting[condition]} is not NEVER")
        match condition:
            case Truth():
                return self._truth(condition.operand, True)
            case Compare():
                return self._compare(condition.left, condition.operator, condition.right)
            case Within():
                return self._within(condition)
            case Missing():
                return Atom(self._layout.missing[condition.input])
            case Unknown():
                return self._is_unknown(condition)
            case Age():
                return self._age(condition, condition.operator)
            case Frequency():
                return self._frequency(condition, ">=")
            case Not():
                return self.false(condition.operand)
            case And():
                return all_of(self.true(each) for each in condition.operands)
            case Or():
                return any_of(self.true(each) for each in condition.operands)
            case For():
                return Atom(f"{self._now} >= {self._layout.dues[condition.index]}")
            case Once():
                return Atom(f"{self._now} < {self._layout.untils[condition.index]}")
            case Times():
                return Atom(f"{self._now} < {self._layout.turns[condition.index]}[0]")
            case Since():
                return Atom(self._layout.kept[condition.index])
            case Begins():
                return Atom(f"{self._now} < {self._layout.dues[condition.operand.index]} < NEVER")
            case Failsafe():
                unknown = [NoneOf(self.false(condition.operand))]
                expected = [self._is_not_awaited(index) for index in condition.inputs]
                return any_of((self.true(condition.operand), all_of([*unknown, *expected])))
            case RuleRef():
                return Atom(self._layout.verdicts[condition.rule])
            case Active():
                return Atom(f"self._{self._layout.active[condition.action]}")

    def false(self, condition: Condition) -> Logic:
        """Return the question whether a condition is false."""
        match condition:
            case Truth():
                return self._truth(condition.operand, False)
            case Compare():
                opposite = OPPOSITE[condition.operator]
                return self._compare(condition.left, opposite, condition.right)
            case Within():
                return self._outside(condition)
            case Missing():
                return Atom(f"not {self._layout.missing[condition.input]}")
            case Unknown():
                return self._is_not_unknown(condition)
            case Age():
                return self._age(condition, OPPOSITE[condition.operator])
            case Frequency():
                return self._frequency(condition, "<")
            case Not():
                return self.true(condition.operand)
            case And():
                return any_of(self.false(each) for each in condition.operands)
            case Or():
                return all_of(self.false(each) for each in condition.operands)
            case For():
                waiting = Atom(f"{self._now} < {self._layout.dues[condition.index]} < NEVER")
                return any_of((waiting, self.false(condition.operand)))
            case Once():
                over = Atom(f"{self._now} >= {self._layout.untils[condition.index]}")
                return all_of((over, self.false(condition.operand)))
            case Times():
                over = Atom(f"{self._now} >= {self._layout.turns[condition.index]}[0]")
                held = Atom(f"self._{self._layout.held[condition.index]}")
                known = any_of((held, self.false(condition.operand)))
                return over if self.is_always_known(condition.operand) else all_of((over, known))
            case Since():
                ended = Atom(f"{self._layout.kept[condition.index]} is False")
                return all_of((ended, self.false(condition.cause)))
            case Begins(operand=lasting):
                over = Atom(f"{self._now} >= {self._layout.dues[lasting.index]}")
                return any_of((over, self.false(lasting.operand)))
            case Failsafe():
                return self.false(condition.operand)
            case RuleRef():
                return Atom(f"{self._layout.verdicts[condition.rule]} is False")
            case Active():
                return Atom(f"not self._{self._layout.active[condition.action]}")

    def itself(self, condition: Condition) -> str | None:
        """Return the name of what is True, False or None as a condition is; ``None`` without one.

        A value that is calculated may be a Boolean of numpy, which is neither.
        """
        match condition:
            case Truth(operand=Read()):
                return self.value(condition.operand)
            case RuleRef():
                return self._layout.verdicts[condition.rule]
            case Missing():
                return self._layout.missing[condition.input]
            case Active():
                return f"self._{self._layout.active[condition.action]}"
            case _:
                return None

    def is_always_known(self, condition: Condition) -> bool:
        """Return whether a condition is never unknown: it only asks for messages and actions."""
        known = Missing | Frequency | Active | And | Or | Not
        return all(isinstance(each, known) for each in walk.parts(condition))

    def else_false(self, condition: Condition) -> Logic:
        """Return the question whether a condition is false that is known not to be true.

        Where one of several comparisons is enough for it, it is false if their numbers are known.
        """
        simple = isinstance(condition, Compare)
        return (None if simple else self._known(condition)) or self.false(condition)

    def _known(self, condition: Condition) -> Logic | None:
        match condition:
            case Compare() | Within() if self._is_of_numbers(condition):
                changing = walk.changing(walk.compared(condition))
                values = dict.fromkeys(map(self.value, changing))
                return all_of(Atom(f"{each} == {each}") for each in values) if values else None
            case Not(operand=Compare() | Within()):
                return self._known(condition.operand)
            case Or():
                found = [self._known(each) for each in condition.operands]
                parts = dict.fromkeys(each for each in found if each is not None)
                return all_of(parts) if None not in found else None
            case For():
                known = self._known(condition.operand)
                began = Atom(f"{self._layout.dues[condition.index]} is not NEVER")
                return None if known is None else any_of((began, known))
            case _:
                return None

    def _is_of_numbers(self, part: Compare | Within) -> bool:
        if isinstance(part, Within):
            return True
        return self._is_number(part.left) and self._is_number(part.right)

    # Unknown ------------------------------------------------------------------------------------

    def _is_unknown(self, condition: Unknown) -> Logic:
        """Return the question whether a value is unknown: it is missing, or came without one."""
        silent, missing = self._silence(condition.input)
        if condition.operand is None:
            unknown = f"not {self._layout.known[condition.input]}"
        else:
            value = self.value(condition.operand)
            unknown = f"{value} != {value}"  # NaN differs from itself
        return any_of((Atom(missing), all_of((Atom(f"not {silent}"), Atom(unknown)))))

    def _is_not_unknown(self, condition: Unknown) -> Logic:
        silent, missing = self._silence(condition.input)
        if condition.operand is None:
            known = self._layout.known[condition.input]
        else:
            value = self.value(condition.operand)
            known = f"{value} == {value}"
        return all_of((Atom(f"not {missing}"), any_of((Atom(silent), Atom(known)))))

    def _silence(self, index: int) -> tuple[str, str]:
        return self._layout.silent[index], self._layout.missing[index]

    def _is_not_awaited(self, index: int) -> Logic:
        """Return the question whether an input has come, or is missing."""
        silent, missing = self._layout.silent[index], self._layout.missing[index]
        return any_of((Atom(f"not {silent}"), Atom(missing)))

    # Comparisons --------------------------------------------------------------------------------

    def _truth(self, operand: ValueExpression, wanted: bool) -> Logic:
        if isinstance(operand, Const):
            return Atom(str(bool(operand.value) is wanted))
        name = self.value(operand)
        return Atom(name if wanted else f"{name} is False")

    def _compare(self, left: ValueExpression, operator: Operator, right: ValueExpression) -> Logic:
        if isinstance(left, Const):
            left, operator, right = right, MIRRORED[operator], left
        if isinstance(left, Const) and isinstance(right, Const):
            return Atom(str(COMPARE[operator](left.value, right.value)))
        if self._is_number(left):
            return _compare_numbers(self.value(left), operator, self.value(right))
        if isinstance(right, Const) and isinstance(right.value, bool):
            return self._truth(left, right.value is (operator == "="))
        sides = [self.value(each) for each in (left, right) if not isinstance(each, Const)]
        if operator == "=":
            sides.pop()  # None equals nothing that is known
        known = [Atom(f"{side} is not None") for side in sides]
        sign = "==" if operator == "=" else operator
        return all_of([*known, Atom(f"{self.value(left)} {sign} {self.value(right)}")])

    def _within(self, condition: Within) -> Logic:
        lower, operand, upper = self._interval(condition)
        above = "<=" if condition.lower_closed else "<"
        below = "<=" if condition.upper_closed else "<"
        return Atom(f"{lower} {above} {operand} {below} {upper}")

    def _outside(self, condition: Within) -> Logic:
        lower, operand, upper = self._interval(condition)
        below = Atom(f"{operand} {'<' if condition.lower_closed else '<='} {lower}")
        above = Atom(f"{operand} {'>' if condition.upper_closed else '>='} {upper}")
        # Beyond one bound is not outside while the other bound is unknown; NaN differs from itself.
        known = [
            Atom(f"{self.value(bound)} == {self.value(bound)}")
            for bound in walk.changing((condition.lower, condition.upper))
        ]
        return all_of([any_of((below, above)), *known])

    def _interval(self, condition: Within) -> tuple[str, str, str]:
        return (
            self.value(condition.lower),
            self.value(condition.operand),
            self.value(condition.upper),
        )

    def _frequency(self, condition: Frequency, operator: Operator) -> Logic:
        first = f"{self._layout.stamps[condition.input]}[-{condition.messages}]"
        return Atom(f"{self._now} - {first} {operator} {condition.elapsed_ns:_}")

    def _age(self, condition: Age, operator: Operator) -> Logic:
        age = f"{self._now} - {self._layout.counted[condition.input]}"
        return _compare_numbers(age, operator, f"{condition.bound_ns:_}")

    # Values -------------------------------------------------------------------------------------

    def value(self, value: ValueExpression) -> str:
        """Return the text of a value; scaled ones are written out."""
        match value:
            case Const():
                return literal(value.value)
            case Scale():
                return scaled(self.value(value.operand), value)
            case _:
                return self._layout.values[value].name

    def _is_number(self, value: ValueExpression) -> bool:
        match value:
            case Const():
                return not isinstance(value.value, bool | str)
            case Scale() | Compute() | Tuned():
                return True
            case Apply():
                return FUNCTIONS[value.function].result is not Result.BOOLEAN
            case Read():
                base = self._program.leaves[value.leaf].type.base
                return base in INTEGER_RANGES or base in FLOAT_TYPES


def _compare_numbers(left: str, operator: Operator, right: str) -> Logic:
    if operator == "!=":  # NaN differs from everything, but unknown is not known to differ
        return any_of((Atom(f"{left} < {right}"), Atom(f"{left} > {right}")))
    sign = "==" if operator == "=" else operator
    return Atom(f"{left} {sign} {right}")


def literal(value: Scalar) -> str:
    """Return a constant as Python writes it."""
    if isinstance(value, float) and math.isinf(value):
        return "math.inf" if value > 0 else "-math.inf"
    return repr(value)


def scaled(operand: str, scale: Scale) -> str:
    """Return ``operand * factor + offset`` for an operand given as text."""
    if isinstance(scale.operand, Scale) and scale.operand.offset:
        operand = f"({operand})"
    product = f"{operand} * {literal(scale.factor)}"
    if not scale.offset:
        return product
    sign = "-" if scale.offset < 0 else "+"
    return f"{product} {sign} {literal(abs(scale.offset))}"
