"""What a handler stores: values, with what tells whether they are new, and times of messages."""

from __future__ import annotations

from dataclasses import dataclass

from deros.generators.monitor.python.layout import Layout
from deros.generators.text.logic import Atom, Logic
from deros.interfaces.types import FLOAT_TYPES
from deros.rules.functions.functions import FUNCTIONS, Result
from deros.rules.program import walk
from deros.rules.program.formulas import calls
from deros.rules.program.ir import Apply, Frequency, Program, Read, Tuned, ValueExpression


@dataclass(frozen=True, slots=True)
class Slot:
    """A value that a handler stores: the attribute, what is stored, and whether -0.0 is not 0.0."""

    attribute: str
    local: str
    is_signed: bool = False

    def is_new(self) -> list[Logic]:
        """Return the tests of which one is true if the value is another one than before."""
        if self.local == "True":
            return [Atom(f"not {self.attribute}")]
        return [Atom(f"{self.local} != {self.attribute}"), *self._signs("!=")]

    def is_old(self) -> list[Logic]:
        """Return the tests that are all true if the value is the one from before."""
        if self.local == "True":
            return [Atom(self.attribute)]
        return [Atom(f"{self.local} == {self.attribute}"), *self._signs("==")]

    def _signs(self, operator: str) -> list[Logic]:
        signs = [f"math.copysign(1.0, {each})" for each in (self.local, self.attribute)]
        return [Atom(f" {operator} ".join(signs))] if self.is_signed else []


def signed_values(program: Program, layout: Layout) -> frozenset[ValueExpression]:
    """Return the values of which -0.0 is another one than 0.0: ``atan2`` alone tells them apart."""
    return frozenset(
        operand
        for value in layout.computed
        if "atan2" in calls(value.formula)
        for operand in value.operands
        if not isinstance(operand, Tuned)
        if _has_signed_zero(program, operand)
    )


def _has_signed_zero(program: Program, value: Read | Apply) -> bool:
    """Return whether -0.0 is one of a value's numbers."""
    if isinstance(value, Apply):
        return FUNCTIONS[value.function].result in (Result.FLOAT, Result.ELEMENT)
    return program.leaves[value.leaf].type.base in FLOAT_TYPES


def may_be_wide(program: Program, value: ValueExpression) -> bool:
    """Return whether a value is, or may be, an integer that a double does not hold."""
    match value:
        case Read():
            return program.leaves[value.leaf].type.base in ("int64", "uint64")
        case Apply():
            row = FUNCTIONS[value.function]
            keeps = row.step is not None and row.step.keeps_integers
            is_so = keeps or row.result is Result.ELEMENT
            return is_so and may_be_wide(program, value.arguments[0])
    return False


def stamp_lines(program: Program, index: int, attribute: str, local: str) -> list[str]:
    """Return the statements that add a message to those of an input.

    Args:
        program: the rules.
        index: of the input.
        attribute: the name of what holds the times.
        local: the name of a variable that is free.
    """
    lines = [f"{local} = self._{attribute} = (*self._{attribute}[1:], t)"]
    looked: dict[Frequency, None] = {}
    for condition in walk.conditions(program):
        if isinstance(condition, Frequency) and condition.input == index:
            looked[condition] = None
    for each in looked:
        end = f"{local}[-{each.messages}] + {each.elapsed_ns:_}"
        lines += [f"if t < {end} < self._due:", f"    self._due = {end}"]
    return lines
