"""What a row of the function table states; the rows are in :mod:`.functions`."""

from __future__ import annotations

import enum
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from deros.rules.functions import function_values as values
from deros.rules.functions.function_forms import Loop, Step, StepMemory, strict
from deros.rules.functions.memories import Memory
from deros.rules.program.bounds import Ends
from deros.rules.program.formulas import UNKNOWN, Call, Choice, Formula, Name, has_choices


class Argument(enum.Enum):
    """What a function is applied to; the value is how a diagnostic names it."""

    CONSTANT = "a constant angle"
    QUATERNION = "a quaternion"
    VECTOR = "a vector"
    POINT = "a point"
    NUMBER = "a number"
    NUMBERS = "an array of numbers"
    ARRAY = "an array"
    ENTRIES = "the entries of arrays"
    SCAN = "a laser scan"
    INPUT = "an input"
    STAMPED = "an input whose messages have a header"
    ANY = "an input or a function of one"


class Result(enum.Enum):
    """What a function yields."""

    FLOAT = "float"
    INTEGER = "integer"
    ELEMENT = "element"  # the type of the number, or of the array's elements, it is applied to
    BOOLEAN = "boolean"
    DURATION = "duration"
    FREQUENCY = "frequency"


class UnitRule(enum.Enum):
    """Which unit the result has."""

    FIXED = "fixed"  # that of the row
    SAME = "same"  # that of the argument
    PER_SECOND = "per second"  # that of the argument, per second
    NONE = "none"  # it is a plain number


@dataclass(frozen=True, slots=True)
class Guard:
    """A test of a message; if it fails, the message does not count and the input is unknown.

    Attributes:
        arguments: the positions of the function's arguments that the test takes.
        evaluate: the reference.
        python_call: the name that the Python text defines.
        python: the Python text.
        c_call: the name that the C text defines.
        c: the C text.
    """

    arguments: tuple[int, ...]
    evaluate: Callable[..., bool]
    python_call: str
    python: str
    c_call: str
    c: str


@dataclass(frozen=True, slots=True)
class Function:
    """One row of the table.

    Attributes:
        name: as the rules call it.
        argument: what it is applied to.
        result: the kind of its result.
        unit_rule: how the unit of the result follows; ``unit`` is that of a ``FIXED`` one.
        usage: a call, as the documentation shows it.
        gives: the result, in words, as the documentation and emitted docstrings show it.
        subject: what it is applied to, in words, where ``argument`` does not say all.
        leaves: the fields of the argument that it reads, in the order of its arguments; the empty
            name is the argument itself.
        parameters: the units of the constants that follow in parentheses, by name.
        formula, step, loop: what it computes, in one of three forms; names are ``variables``.
        evaluate: the reference, on the leaves, then the parameters, where no form is.
        memory: creates what it remembers between messages, where no step says it.
        over_span: whether its parameter is a span of time, in which it keeps samples by their
            stamps. Its text in C takes them as a ``@_window``.
        reads_length: whether it reads nothing of an array but its length, which is the result.
        over: the row that stands for calls with an argument, where this one has none.
        turns: whether it is an angle that jumps by a full turn.
        is_written: whether rules call it; others are parts of those that rules call.
        nan_is_unknown: whether a NaN in the first leaf makes the input unknown.
        is_single: whether it is one of the ``float32`` of its message, and so is told by a shorter
            decimal.
        is_whole: whether it is a whole number, or unknown, and so is told without decimals.
        bounds: least and greatest result, where the function itself bounds it.
        bounds_from: computes the bounds from those of the leaves.
        bearings: whether its parameters are the ends of a sector, counter-clockwise.
        guard: what a message must satisfy to count.
        told: the functions of the same arguments that causes tell beside this one.
        of_zone: whether a zone is named in its parentheses.
        python_call: what Python text calls with the arguments in order.
        python: the definition that Python text needs; empty for built-ins and printed forms.
        may_be_none: whether the Python text returns ``None`` for *unknown*.
        python_needs: further Python texts that this one calls.
        python_of_unit: of a function of a quaternion, in place of both, lines on the parts ux, uy,
            uz, uw of the normalised quaternion; the last is the result.
        c_call: what C text calls.
        c: the definition that C text needs; empty for the library's and printed forms.
        c_integer: what C text calls for integers, if the function exists for them.
    """

    name: str
    argument: Argument
    result: Result
    unit_rule: UnitRule
    unit: str = ""
    usage: str = ""
    gives: str = ""
    subject: str = ""
    leaves: tuple[str, ...] = ()
    parameters: tuple[tuple[str, str], ...] = ()
    formula: Formula | None = None
    step: Step | None = None
    loop: Loop | None = None
    evaluate: Callable[..., float | None] | None = None
    memory: Callable[[], Memory] | None = None
    over_span: bool = False
    reads_length: bool = False
    over: str = ""
    turns: bool = False
    is_written: bool = True
    nan_is_unknown: bool = True
    is_single: bool = False
    is_whole: bool = False
    bounds: tuple[float, float] = (-math.inf, math.inf)
    bounds_from: Callable[..., Ends] | None = None
    bearings: bool = False
    guard: Guard | None = None
    told: tuple[str, ...] = ()
    of_zone: bool = False
    python_call: str = ""
    python: str = ""
    may_be_none: bool = False
    python_needs: tuple[str, ...] = ()
    python_of_unit: tuple[str, ...] = ()
    c_call: str = ""
    c: str = ""
    c_integer: str = ""

    @property
    def is_stateful(self) -> bool:
        """Whether it remembers something between messages."""
        return self.step is not None or self.memory is not None

    @property
    def c_name(self) -> str:
        """The name of its function in C; not the bare name, which a form may use for a number."""
        return self.c_call or f"{self.name}_of"

    @property
    def variables(self) -> tuple[str, ...]:
        """The names of the arguments in its form; those of a loop are the parameters alone."""
        names = tuple(name for name, _ in self.parameters)
        match self.argument:
            case Argument.NUMBER:
                return ("value", *names)
            case Argument.QUATERNION:
                return UNIT_PARTS
            case Argument.VECTOR:
                return (*self.leaves, *names)
            case _:
                return names

    @property
    def strict_formula(self) -> Formula | None:
        """The formula, made unknown for an unknown number where it would not be so by itself."""
        formula = self.formula
        if formula is None or self.argument is not Argument.NUMBER or not has_choices(formula):
            return formula
        known = Call("known", (Name("value"),))
        return Formula(formula.assignments, Choice(known, formula.result, UNKNOWN))

    def value(self, *arguments: Any) -> float | None:
        """Return the result for known arguments, ``None`` for unknown.

        Raises:
            AssertionError: it is not a function of values.
        """
        if self.evaluate is not None:
            return self.evaluate(*arguments)
        if self.loop is not None:
            elements, *constants = arguments
            if self.result is not Result.ELEMENT:
                elements = [float(each) for each in elements]
            return self.loop.evaluate(self.variables, elements, *constants)
        assert self.formula is not None, f"{self.name} is not a function of values"
        if self.argument is Argument.QUATERNION:
            unit = values.normalised(*arguments)
            return None if unit is None else strict(self.formula, self.variables, *unit)
        return strict(self.formula, self.variables, *arguments)

    def new_memory(self) -> Memory:
        """Return the memory of a function that has seen no message.

        Raises:
            AssertionError: it has no memory.
        """
        if self.step is not None:
            return StepMemory(self.step, self.variables)
        assert self.memory is not None, f"{self.name} has no memory"
        return self.memory()


UNIT_PARTS = ("ux", "uy", "uz", "uw")
"""The parts of a normalised quaternion, as formulas name them."""
