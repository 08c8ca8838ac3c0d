"""The forms of functions: of one message, with a memory, and over the elements of an array.

A row of the function table has one of them. The reference engine interprets it, the targets print
it, and what is proved of the printed C is derived from it. See :mod:`deros.rules.program.formulas`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from deros.rules.program.formulas import Formula, Name, evaluate, parse

ELAPSED = "elapsed"
"""In a step, the seconds since the message before; unknown for the first one."""

ELEMENT, FIRST, COUNT = "element", "first", "count"
"""In a loop, the present element, whether it is the first one, and in its result their number."""


@dataclass(frozen=True, slots=True)
class Remembered:
    """A number that a function remembers.

    Attributes:
        name: in the formula, and at the end of the names in emitted monitors.
        comment: what it is, for those who read a monitor.
        initial: its value before the first message, and again when the input becomes unknown. A
            ``None`` is not stored anywhere: the formula does not depend on it at the first message.
    """

    name: str
    comment: str
    initial: float | None = math.nan


@dataclass(frozen=True, slots=True)
class Step:
    """How the memory and the result of a function follow from a message.

    Attributes:
        memory: what it remembers.
        formula: assigns the memory anew, and gives the result. A name is the new value after its
            assignment, and the old one before. ``elapsed`` is the time since the last message.
        exact_integers: whether integers are subtracted as they are, and the difference is rounded,
            if anything; else they are rounded first.
        keeps_integers: whether an integer that a double does not hold stays as it is.
        forgets_time: whether ``elapsed`` is unknown at the first message. A formula that does not
            depend on it then may leave it undefined.
    """

    memory: tuple[Remembered, ...]
    formula: Formula
    exact_integers: bool = False
    keeps_integers: bool = False
    forgets_time: bool = True

    @property
    def is_timed(self) -> bool:
        """Whether the formula reads the time since the last message."""
        return ELAPSED in self.formula.names

    @property
    def copied(self) -> dict[str, str]:
        """By the name of a remembered number, the argument that it is a copy of."""
        names = {each.name for each in self.memory}
        return {
            name: value.name
            for name, value in self.formula.assignments
            if name in names and isinstance(value, Name) and value.name not in names
        }

    @property
    def result_field(self) -> str:
        """The remembered number that is the result; empty if there is none."""
        result = self.formula.result
        names = {each.name for each in self.memory}
        return result.name if isinstance(result, Name) and result.name in names else ""


@dataclass(frozen=True, slots=True)
class Loop:
    """How the result of a function follows from the elements of an array, first to last.

    Attributes:
        accumulator: the name of what is carried from element to element.
        initial: its value before the first element; NaN if the first element sets it.
        each: the accumulator after an element, from ``element``, ``first``, the parameters and the
            accumulator before.
        result: from the accumulator, ``count`` and the parameters.
    """

    accumulator: str
    initial: float
    each: Formula
    result: Formula

    def evaluate(
        self, parameters: Sequence[str], values: Sequence[float], *constants: float
    ) -> float | None:
        """Return the result for an array, ``None`` for unknown."""
        names: dict[str, float] = dict(zip(parameters, constants, strict=True))
        carried: float = self.initial
        for place, element in enumerate(values):
            here = {**names, self.accumulator: carried, FIRST: place == 0, ELEMENT: element}
            carried = evaluate(self.each, here)
        result = evaluate(self.result, {**names, self.accumulator: carried, COUNT: len(values)})
        return None if math.isnan(result) else result


def step(text: str, *memory: Remembered, **options: bool) -> Step:
    """Return the step that a text says."""
    return Step(memory, parse(text), **options)


def loop(accumulator: str, initial: float, each: str, result: str = "") -> Loop:
    """Return the loop that texts say; the result is the accumulator where nothing else is said."""
    return Loop(accumulator, initial, parse(each), parse(result or accumulator))


class StepMemory:
    """The memory of a function that has a step, as the reference engine keeps it."""

    def __init__(self, step: Step, parameters: Sequence[str]) -> None:
        """Remember no message; ``parameters`` are the names of the arguments."""
        self.result: float | None = None
        self._step = step
        self._parameters = tuple(parameters)
        self._at_ns: int | None = None
        self._numbers = {
            each.name: math.nan if each.initial is None else each.initial for each in step.memory
        }

    def follow(self, t_ns: int, *arguments: float | None) -> None:
        """Take the arguments of a message that came at ``t_ns``."""
        names = dict(self._numbers)
        names[ELAPSED] = math.nan if self._at_ns is None else (t_ns - self._at_ns) / 1e9
        for name, value in zip(self._parameters, arguments, strict=True):
            known = math.nan if value is None else value
            is_kept = self._step.keeps_integers and known != float(known)
            is_exact = self._step.exact_integers or is_kept
            names[name] = known if is_exact else float(known)
        result = evaluate(self._step.formula, names)
        self._at_ns = t_ns
        self._numbers = {name: names[name] for name in self._numbers}
        self.result = None if math.isnan(result) else result


LENGTH_OF = (
    ("x", "y", "z", "w"),
    parse(
        """
length = sqrt(x * x + y * y + z * z + w * w)
length if length > 0.0 and length < inf else unknown
"""
    ),
)
"""The length of a quaternion, and its parameters; unknown for one that has no attitude."""


def strict(formula: Formula, parameters: Sequence[str], *arguments: float) -> float | None:
    """Return the value of a formula of known arguments, ``None`` for unknown."""
    names = {name: float(value) for name, value in zip(parameters, arguments, strict=True)}
    result = evaluate(formula, names)
    return None if math.isnan(result) else result
