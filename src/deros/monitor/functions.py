"""The function table: all that the rules' functions are, one row each.

A row says what a function may be applied to, what it yields in which unit, which fields of a
message it reads, and what it computes: once as the reference, in
:mod:`deros.monitor.function_values`, once as the text that each target emits. Adding a function is
adding a row. Source: paper, section 4.2, for ``toRad``, ``toDeg``, ``roll`` and ``pitch``.

Python text is the definition of a module-level function that returns ``None`` for *unknown*; its
module imports ``math`` and, from ``collections.abc``, ``Sequence``, and as the text needs them
``functools`` and ``numpy as np``. C text is a C99 definition
(``<math.h>``, ``<stddef.h>``) that returns ``NAN`` for *unknown*; an array is passed as a pointer
and a count.
"""

from __future__ import annotations

import enum
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction

from deros.interfaces.types import FieldType
from deros.monitor import function_texts as texts
from deros.monitor import function_values as values
from deros.monitor import memories
from deros.monitor.bounds import Ends, bounds_of_absolute, bounds_of_length, type_bounds


class Argument(enum.Enum):
    """What a function is applied to; the value is how a diagnostic names it."""

    CONSTANT = "a constant angle"
    QUATERNION = "a quaternion"
    VECTOR = "a vector"
    NUMBER = "a number"
    NUMBERS = "an array of numbers"
    ARRAY = "an array"
    SCAN = "a laser scan"
    INPUT = "an input"
    ANY = "an input or a function of one"


class Result(enum.Enum):
    """What a function yields."""

    FLOAT = "float"
    INTEGER = "integer"
    ELEMENT = "element"  # the type of the number, or of the array's elements, it is applied to
    BOOLEAN = "boolean"
    DURATION = "duration"


class UnitRule(enum.Enum):
    """Which unit the result has."""

    FIXED = "fixed"  # that of the row
    SAME = "same"  # that of the argument
    PER_SECOND = "per second"  # that of the argument, per second
    NONE = "none"  # it is a plain number


@dataclass(frozen=True, slots=True)
class Guard:
    """A test of a message without which the whole input is unknown and does not count.

    Attributes:
        arguments: which of the function's arguments the test takes.
        evaluate: the reference.
        python_call: the name that Python text defines.
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
        unit_rule: how the unit of the result comes about; ``unit`` is that of a ``FIXED`` one.
        leaves: the fields of the argument that it reads, in the order of its arguments; the empty
            name is the argument itself.
        parameters: the units of the constants that follow in parentheses, by name.
        evaluate: the reference, on the leaves, then the parameters. ``None`` where the compiler
            folds the function away (conversions) or the monitor itself keeps the answer.
        memory: what it remembers from message to message, and computes its result with.
        over: the row that stands for calls with an argument, where this one has none.
        turns: whether it is an angle that jumps by a full turn where it begins anew.
        is_written: whether rules call it; others are made of what they call.
        nan_is_unknown: whether a NaN in the first leaf makes the input unknown.
        bounds: least and greatest result, where the function itself bounds it.
        bounds_from: of a function whose bounds follow from those of its leaves, how they do.
        bearings: whether its parameters are the ends of a sector, counter-clockwise.
        guard: what a message must satisfy to count at all.
        python_call: what Python text calls with the arguments in order.
        python: the definition that Python text needs; empty for what Python has built in.
        python_of_unit: of a function of a quaternion, in place of both, lines on the parts ux, uy,
            uz, uw of the quaternion brought to length 1; the last is the result.
        c_call: what C text calls.
        c: the definition that C text needs.
    """

    name: str
    argument: Argument
    result: Result
    unit_rule: UnitRule
    unit: str = ""
    leaves: tuple[str, ...] = ()
    parameters: tuple[tuple[str, str], ...] = ()
    evaluate: Callable[..., float | None] | None = None
    memory: Callable[[], memories.Memory] | None = None
    over: str = ""
    turns: bool = False
    is_written: bool = True
    nan_is_unknown: bool = True
    bounds: tuple[float, float] = (-math.inf, math.inf)
    bounds_from: Callable[..., Ends] | None = None
    bearings: bool = False
    guard: Guard | None = None
    python_call: str = ""
    python: str = ""
    python_of_unit: tuple[str, ...] = ()
    c_call: str = ""
    c: str = ""


def _of_quaternion(
    name: str, evaluate: Callable[..., float | None], bounds: tuple[float, float]
) -> Function:
    return Function(
        name,
        Argument.QUATERNION,
        Result.FLOAT,
        UnitRule.FIXED,
        unit="rad",
        leaves=("x", "y", "z", "w"),
        evaluate=evaluate,
        bounds=bounds,
        turns=name in ("roll", "yaw"),
        python_of_unit=texts.PYTHON_OF_UNIT[name],
        c_call=name,
        c=texts.C[name],
    )


def _of_numbers(name: str, evaluate: Callable[..., float | None]) -> Function:
    return Function(
        name,
        Argument.NUMBERS,
        Result.ELEMENT,
        UnitRule.SAME,
        leaves=("",),
        evaluate=evaluate,
        python_call=f"array_{name}",
        python=texts.PYTHON[name],
        c_call={"min": "least", "max": "greatest"}[name],
        c=texts.C[name],
    )


_ROWS = (
    Function("toRad", Argument.CONSTANT, Result.FLOAT, UnitRule.FIXED, unit="rad"),
    Function("toDeg", Argument.CONSTANT, Result.FLOAT, UnitRule.FIXED, unit="deg"),
    _of_quaternion("roll", values.roll, (-math.pi, math.pi)),
    _of_quaternion("pitch", values.pitch, (-math.pi / 2.0, math.pi / 2.0)),
    _of_quaternion("yaw", values.yaw, (-math.pi, math.pi)),
    _of_quaternion("tilt", values.tilt, (0.0, math.pi)),
    Function(
        "norm",
        Argument.VECTOR,
        Result.FLOAT,
        UnitRule.SAME,
        leaves=("x", "y", "z"),
        evaluate=values.norm,
        bounds=(0.0, math.inf),
        bounds_from=bounds_of_length,
        python_call="vector_norm",
        python=texts.PYTHON["norm"],
        c_call="norm",
        c=texts.C["norm"],
    ),
    Function(
        "abs",
        Argument.NUMBER,
        Result.ELEMENT,
        UnitRule.SAME,
        evaluate=values.absolute,
        bounds=(0.0, math.inf),
        bounds_from=bounds_of_absolute,
        python_call="abs",
        c_call="fabs",
    ),
    Function(
        "rate",
        Argument.NUMBER,
        Result.FLOAT,
        UnitRule.PER_SECOND,
        evaluate=values.rate,
        memory=memories.Rate,
        over="rate_over",
        python_call="rate_per_second",
        python=texts.PYTHON["rate"],
        c_call="rate",
        c=texts.C["rate"],
    ),
    Function(
        "rate_over",
        Argument.NUMBER,
        Result.FLOAT,
        UnitRule.PER_SECOND,
        parameters=(("span", "s"),),
        memory=memories.RateOver,
        is_written=False,
        python=texts.PYTHON["rate_over"],
        c_call="rate_over",
        c=texts.C["rate_over"],
    ),
    Function(
        "unwrapped",
        Argument.NUMBER,
        Result.FLOAT,
        UnitRule.SAME,
        memory=memories.Unwrapped,
        is_written=False,
        python_call="unwrapped",
        python=texts.PYTHON["unwrapped"],
        c_call="unwrapped",
        c=texts.C["unwrapped"],
    ),
    _of_numbers("min", values.least),
    _of_numbers("max", values.greatest),
    Function(
        "count",
        Argument.ARRAY,
        Result.INTEGER,
        UnitRule.NONE,
        leaves=("",),
        evaluate=values.count,
        nan_is_unknown=False,
        bounds=(0.0, math.inf),
        python_call="len",
    ),
    Function(
        "nearest",
        Argument.SCAN,
        Result.FLOAT,
        UnitRule.FIXED,
        unit="m",
        leaves=("ranges", "angle_min", "angle_increment", "range_min", "range_max"),
        parameters=(("start", "rad"), ("end", "rad")),
        evaluate=values.nearest,
        nan_is_unknown=False,
        bounds=(0.0, math.inf),
        bearings=True,
        guard=Guard(
            (0, 3),
            values.scan_usable,
            "scan_usable",
            texts.PYTHON["scan_usable"],
            "scan_usable",
            texts.C["scan_usable"],
        ),
        python_call="scan_nearest",
        python=texts.PYTHON["nearest"],
        c_call="nearest",
        c=texts.C["nearest"],
    ),
    Function(
        "age", Argument.INPUT, Result.DURATION, UnitRule.FIXED, unit="s", bounds=(0.0, math.inf)
    ),
    Function("missing", Argument.INPUT, Result.BOOLEAN, UnitRule.NONE),
    Function("unknown", Argument.ANY, Result.BOOLEAN, UnitRule.NONE),
)

FUNCTIONS: Mapping[str, Function] = {row.name: row for row in _ROWS}
"""Every function of the intermediate form, by its name."""

WRITTEN: Mapping[str, Function] = {row.name: row for row in _ROWS if row.is_written}
"""Every function that rules call, by its name."""


def result_bounds(row: Function, kind: FieldType, *arguments: Ends) -> Ends:
    """Return what bounds the result: the function where it does, else the type."""
    if row.bounds_from is not None:
        return row.bounds_from(*arguments)
    if row.bounds == (-math.inf, math.inf):
        return type_bounds(kind)
    least, greatest = row.bounds
    return (
        Fraction(least) if math.isfinite(least) else least,
        Fraction(greatest) if math.isfinite(greatest) else greatest,
    )
