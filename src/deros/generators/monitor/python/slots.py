"""What a handler stores: values, with what tells whether they are news, and times of messages.

A number says nothing new to the rules while it stays in its *cell*: the numbers that compare with
all bounds in the rules as it does. A value that rules compute with, that they compare with another
value, or with a constant that is tuned, has no cell: there every other number is news.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from deros.generators.monitor.python.conditions import literal
from deros.generators.monitor.python.layout import Cell, Layout, inputs_of
from deros.generators.text.logic import Atom, Logic, all_of, any_of, lay_out
from deros.generators.text.python import lay_out_call
from deros.interfaces.types import FLOAT_TYPES
from deros.rules.functions.functions import FUNCTIONS, Result
from deros.rules.program import walk
from deros.rules.program.formulas import calls
from deros.rules.program.ir import (
    Apply,
    Compare,
    Condition,
    Const,
    Frequency,
    Program,
    Read,
    Tuned,
    Unknown,
    ValueExpression,
    Within,
)


@dataclass(frozen=True, slots=True)
class Slot:
    """A value that a handler stores.

    Attributes:
        attribute: that holds it.
        local: what is stored.
        is_signed: whether -0.0 is another value than 0.0.
        cell: the numbers that are nothing new, if the value has its cell.
    """

    attribute: str
    local: str
    is_signed: bool = False
    cell: Cell | None = None

    def is_new(self) -> list[Logic]:
        """Return the tests of which one is true if the value tells the rules anything new."""
        if self.cell is not None:
            return [Atom(f"not {self._is_inside()}")]
        if self.local == "True":
            return [Atom(f"not {self.attribute}")]
        return [Atom(f"{self.local} != {self.attribute}"), *self._signs("!=")]

    def is_old(self) -> list[Logic]:
        """Return the tests that are all true if the value tells the rules nothing new."""
        if self.cell is not None:
            return [Atom(self._is_inside())]
        if self.local == "True":
            return [Atom(self.attribute)]
        return [Atom(f"{self.local} == {self.attribute}"), *self._signs("==")]

    def _is_inside(self) -> str:
        assert self.cell is not None
        return f"self._{self.cell.low} <= {self.local} <= self._{self.cell.high}"

    def _signs(self, operator: str) -> list[Logic]:
        signs = [f"math.copysign(1.0, {each})" for each in (self.local, self.attribute)]
        return [Atom(f" {operator} ".join(signs))] if self.is_signed else []


def stores(slots: Iterable[Slot], indent: int) -> list[str]:
    """Return the statements that store values."""
    return [f"{' ' * indent}{each.attribute} = {each.local}" for each in slots]


def stores_of_news(
    slots: Sequence[Slot],
    computed: Sequence[str],
    running: Sequence[Logic],
    fresh: str,
    indent: int,
) -> list[str]:
    """Return the statements that store values, and go on if one of them is news.

    Args:
        slots: the values.
        computed: the statements that compute with them.
        running: whether the monitor is running, if that is to be asked.
        fresh: the statement that notes news; without it the handler returns if there is none.
        indent: of the statements.
    """
    kept = [each for each in slots if each.cell is not None]
    others = [each for each in slots if each.cell is None]
    news = [*stores(others, indent), *_cell_lines(kept, indent), *computed]
    if fresh:
        test: Logic = any_of(part for each in slots for part in each.is_new())
        inner = (f"    {line}" for line in (*news, f"{' ' * indent}{fresh}"))
        return [*lay_out(indent, "if ", test, ":"), *inner, *stores(kept, indent)]
    # Where a value has its cell, the monitor is running.
    test = all_of((*(part for each in slots for part in each.is_old()), *([] if kept else running)))
    is_old = [*lay_out(indent, "if ", test, ":"), f"{' ' * indent}    return"]
    return [*stores(kept, indent), *is_old, *news]


def _cell_lines(slots: Iterable[Slot], indent: int) -> Iterator[str]:
    """Yield the statements that store between which numbers each value is nothing new."""
    for each in slots:
        assert each.cell is not None
        head = f"self._{each.cell.low}, self._{each.cell.high} = cell("
        yield from lay_out_call(indent, head, [each.local, *map(literal, each.cell.bounds)])


def timed_topics(program: Program, layout: Layout) -> frozenset[str]:
    """Return the topics of which each message is news, as rules ask when the messages come."""
    timed = (*layout.counted, *layout.stamps)
    return frozenset(program.inputs[index].topic for index in timed)


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


# Cells --------------------------------------------------------------------------------------------


CELL = '''\
def cell(value: float, *bounds: float) -> tuple[float, float]:
    """
    Return the least and the greatest number that compare with all bounds as a value does.

    The bounds ascend. Where the value is NaN, no number is between the results.
    """
    if value != value:
        return NAN, NAN
    low, high = -math.inf, math.inf
    for bound in bounds:
        if bound < value:
            low = math.nextafter(bound, math.inf)
        elif bound > value:
            high = math.nextafter(bound, -math.inf)
            break
        else:
            return value, value
    return low, high
'''
"""The function that the emitted monitor has if a value of it has a cell."""


def lay_out_cells(program: Program, layout: Layout) -> dict[ValueExpression, Cell]:
    """Name the attributes of the cells, of those values that have one.

    Handlers are given, and functions return, Python's numbers. Beside a float32 of numpy the ends
    of a cell would be rounded, onto the bounds themselves.
    """
    timed = timed_topics(program, layout)
    compared: dict[ValueExpression, set[float]] = {}
    others: set[ValueExpression] = {
        operand for each in layout.computed for operand in each.operands
    }
    for condition in walk.conditions(program):
        for value, bounds in _compared(condition):
            if bounds is None:
                others.add(value)
            else:
                compared.setdefault(value, set()).update(bounds)
    cells: dict[ValueExpression, Cell] = {}
    for value, slot in layout.values.items():
        if value not in others and _is_float(program, value):
            topics = {program.inputs[index].topic for index in inputs_of(program, value)}
            if topics.isdisjoint(timed):
                low = layout.names.new(slot.name, "low")
                high = layout.names.new(slot.name, "high")
                cells[value] = Cell(low, high, tuple(sorted(compared.get(value, ()))))
    return cells


def _compared(condition: Condition) -> Iterator[tuple[ValueExpression, list[float] | None]]:
    """Yield what a condition itself compares, with the bounds if it compares with nothing else."""
    sides: list[ValueExpression]
    match condition:
        case Compare():
            sides = [condition.left, condition.right]
        case Within():
            sides = [condition.operand, condition.lower, condition.upper]
        case Unknown(operand=Apply() as operand):
            sides = [operand]
        case _:
            return
    changing = [each for each in sides if not isinstance(each, Const)]
    constants = (each.value for each in sides if isinstance(each, Const))
    bounds: list[float] = [each for each in constants if not isinstance(each, str)]
    for value in walk.compared(condition):
        yield value, bounds if changing == [value] else None


def _is_float(program: Program, value: ValueExpression) -> bool:
    """Return whether a value is a number that seldom comes twice; a float holds each of them."""
    if isinstance(value, Apply):
        result = FUNCTIONS[value.function].result
        is_element = result is Result.ELEMENT and _is_float(program, value.arguments[0])
        return (result is Result.FLOAT or is_element) and not may_be_wide(program, value)
    return isinstance(value, Read) and program.leaves[value.leaf].type.base in FLOAT_TYPES
