"""The function table: one row for each function that rules can call.

A row states what a function applies to, the unit of its result, which fields of a message it reads,
and what it computes. To add a function, add a row with one of three forms:

* a ``formula`` of one message (:class:`~deros.rules.program.formulas.Formula`);
* a ``step`` from one message to the next, for a function with a memory
  (:class:`~~deros.rules.functions.function_forms.Step`);
* a ``loop`` over the elements of an array (:class:`~~deros.rules.functions.function_forms.Loop`).

The reference engine interprets the form. The Python and C monitors print it, the ACSL contracts are
derived from it, the decoders read the row's ``leaves``, the random programs of the property tests
draw the row, and the table in the documentation holds its ``usage`` and ``gives``.

A row may name a text of :mod:`.function_texts` that is emitted instead, and a function of
:mod:`.function_values` that is the reference instead; tests compare these with one another. A
target refuses, by name, a function for which it has neither a form nor a text.

Python text defines a function of the module. It returns ``None`` for *unknown* if ``may_be_none``,
else NaN. Its module imports ``math``, ``Sequence``, ``functools`` and ``numpy as np`` as needed. C
text is a C99 definition (``<math.h>``, ``<stddef.h>``) that returns ``NAN`` for *unknown*; an array
is passed as a pointer and a count.

Source: paper, section 4.2, for ``toRad``, ``toDeg``, ``roll`` and ``pitch``.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from fractions import Fraction

from deros.interfaces.types import FieldType
from deros.rules.functions import function_texts as texts
from deros.rules.functions import function_values as values
from deros.rules.functions import memories
from deros.rules.functions.function_forms import Remembered, loop, step
from deros.rules.functions.function_rows import (
    UNIT_PARTS,
    Argument,
    Function,
    Guard,
    Result,
    UnitRule,
)
from deros.rules.functions.scan_rows import SCAN_ROWS
from deros.rules.program.bounds import Ends, bounds_of_absolute, bounds_of_length, type_bounds
from deros.rules.program.formulas import parse

__all__ = [
    "FUNCTIONS",
    "UNIT_PARTS",
    "WRITTEN",
    "Argument",
    "Function",
    "Guard",
    "Result",
    "UnitRule",
    "result_bounds",
    "usage_table",
]


def _of_quaternion(
    name: str,
    evaluate: Callable[..., float | None],
    bounds: tuple[float, float],
    formula: str,
    gives: str,
) -> Function:
    return Function(
        name,
        Argument.QUATERNION,
        Result.FLOAT,
        UnitRule.FIXED,
        unit="rad",
        usage=f"q.{name}()",
        gives=gives,
        leaves=("x", "y", "z", "w"),
        formula=parse(formula),
        evaluate=evaluate,
        bounds=bounds,
        turns=name in ("roll", "yaw"),
        python_of_unit=texts.PYTHON_OF_UNIT[name],
        c_call=name,
    )


def _of_numbers(
    name: str, evaluate: Callable[..., float | None], relation: str, c_call: str
) -> Function:
    return Function(
        name,
        Argument.NUMBERS,
        Result.ELEMENT,
        UnitRule.SAME,
        usage=f"a.{name}()",
        gives=f"its {c_call} element",
        leaves=("",),
        loop=loop("found", math.nan, f"element if first or element {relation} found else found"),
        evaluate=evaluate,
        python_call=f"array_{name}",
        python=texts.PYTHON[name],
        may_be_none=True,
        c_call=c_call,
        c_integer=c_call,
    )


_ROWS = (
    Function(
        "toRad",
        Argument.CONSTANT,
        Result.FLOAT,
        UnitRule.FIXED,
        unit="rad",
        usage="toRad(10 deg)",
        gives="the constant in the other unit",
    ),
    Function(
        "toDeg",
        Argument.CONSTANT,
        Result.FLOAT,
        UnitRule.FIXED,
        unit="deg",
        usage="toDeg(0.1 rad)",
        gives="the constant in the other unit",
    ),
    _of_quaternion(
        "roll",
        values.roll,
        (-math.pi, math.pi),
        "atan2(2.0 * (uw * ux + uy * uz), 1.0 - 2.0 * (ux * ux + uy * uy))",
        "an angle in rad",
    ),
    _of_quaternion(
        "pitch",
        values.pitch,
        (-math.pi / 2.0, math.pi / 2.0),
        "asin(clamped(2.0 * (uw * uy - uz * ux)))",
        "an angle in rad",
    ),
    _of_quaternion(
        "yaw",
        values.yaw,
        (-math.pi, math.pi),
        "atan2(2.0 * (uw * uz + ux * uy), 1.0 - 2.0 * (uy * uy + uz * uz))",
        "an angle in rad",
    ),
    _of_quaternion(
        "tilt",
        values.tilt,
        (0.0, math.pi),
        "2.0 * atan2(sqrt(ux * ux + uy * uy), sqrt(uz * uz + uw * uw))",
        "the angle between the robot's z axis and the vertical, in rad",
    ),
    Function(
        "norm",
        Argument.VECTOR,
        Result.FLOAT,
        UnitRule.SAME,
        usage="v.norm()",
        gives="its length",
        leaves=("x", "y", "z"),
        formula=parse("sqrt(x * x + y * y + z * z)"),
        evaluate=values.norm,
        bounds=(0.0, math.inf),
        bounds_from=bounds_of_length,
        python_call="vector_norm",
        python=texts.PYTHON["norm"],
        c_call="norm",
    ),
    Function(
        "inside",
        Argument.POINT,
        Result.BOOLEAN,
        UnitRule.NONE,
        usage="p.inside(yard)",
        gives="whether it lies in that zone, or on its edge",
        subject="a point: `x` and `y`, of length",
        leaves=("x", "y"),
        of_zone=True,
    ),
    Function(
        "abs",
        Argument.NUMBER,
        Result.ELEMENT,
        UnitRule.SAME,
        usage="x.abs()",
        gives="its absolute value",
        evaluate=values.absolute,
        bounds=(0.0, math.inf),
        bounds_from=bounds_of_absolute,
        python_call="abs",
        c_call="fabs",
        c_integer="magnitude",
    ),
    Function(
        "rate_over",
        Argument.NUMBER,
        Result.FLOAT,
        UnitRule.PER_SECOND,
        usage="x.rate(0.1 sec)",
        gives="its change per second over the last messages that span so much time, by their"
        " header stamps if they have some",
        parameters=(("span", "s"),),
        memory=memories.RateOver,
        over_span=True,
        is_written=False,
        python_call="RateWindow",
        python=texts.PYTHON["rate_over"],
        may_be_none=True,
        python_needs=("rate",),
        c_call="rate_over",
        c=texts.C["rate_over"],
    ),
    Function(
        "rate",
        Argument.NUMBER,
        Result.FLOAT,
        UnitRule.PER_SECOND,
        usage="x.rate()",
        gives="its change per second between the last two arrivals; a span is usually better",
        step=step(
            """
change = (value - last) / elapsed
last = value
change
""",
            Remembered("last", "the value before"),
            exact_integers=True,
            forgets_time=False,
        ),
        over="rate_over",
        python_call="rate_per_second",
        python=texts.PYTHON["rate"],
        may_be_none=True,
        c_call="rate",
        c=texts.C["rate"],
    ),
    Function(
        "previous",
        Argument.NUMBER,
        Result.FLOAT,
        UnitRule.SAME,
        usage="x.previous()",
        gives="its value at the message before; unknown until there are two",
        step=step(
            """
former = last
last = value
former
""",
            Remembered("last", "the value before"),
            keeps_integers=True,
        ),
        bounds_from=lambda operand: operand,
    ),
    Function(
        "unwrapped",
        Argument.NUMBER,
        Result.FLOAT,
        UnitRule.SAME,
        parameters=(("turn", "rad"),),
        step=step(
            """
way = remainder(value - last, turn)
total = total + way if known(way) else double(value)
last = value
total
""",
            Remembered("last", "the value before"),
            Remembered("total", "the angle without its jumps", None),
            exact_integers=True,
        ),
        is_written=False,
        python_call="unwrapped",
        python=texts.PYTHON["unwrapped"],
        c_call="unwrapped",
        c=texts.C["unwrapped"],
    ),
    _of_numbers("min", values.least, "<", "least"),
    _of_numbers("max", values.greatest, ">", "greatest"),
    Function(
        "count",
        Argument.ARRAY,
        Result.INTEGER,
        UnitRule.NONE,
        usage="a.count()",
        gives="its length",
        leaves=("",),
        evaluate=values.count,
        reads_length=True,
        nan_is_unknown=False,
        bounds=(0.0, math.inf),
        python_call="len",
    ),
    Function(
        "matches",
        Argument.ENTRIES,
        Result.INTEGER,
        UnitRule.NONE,
        usage="count(valid and not free)",
        gives="how many entries satisfy the condition; `any(…)`, `all(…)`: whether one, all do",
        subject="arrays of flags or numbers, of one message",
        is_written=False,
        bounds=(0.0, math.inf),
    ),
    *SCAN_ROWS,
    Function(
        "latency",
        Argument.STAMPED,
        Result.FLOAT,
        UnitRule.FIXED,
        unit="s",
        usage="i.latency()",
        gives="the time from the stamp of its last message to the receipt, negative for a stamp in"
        " the future; unknown for a stamp of zero",
        evaluate=values.latency,
        python_call="latency_of",
        python=texts.PYTHON["latency"],
        may_be_none=True,
        python_needs=("stamp_of",),
        c_call="latency",
        c=texts.C["latency"],
    ),
    Function(
        "age",
        Argument.INPUT,
        Result.DURATION,
        UnitRule.FIXED,
        unit="s",
        usage="i.age()",
        gives="the time since its last message; compared with a constant only",
        subject="an input with a timeout",
        bounds=(0.0, math.inf),
    ),
    Function(
        "frequency",
        Argument.INPUT,
        Result.FREQUENCY,
        UnitRule.FIXED,
        unit="Hz",
        usage="i.frequency(10)",
        gives="so many messages, by the time since the first of the last so many; compared with a"
        " constant only",
        parameters=(("messages", "1"),),
        bounds=(0.0, math.inf),
    ),
    Function(
        "missing",
        Argument.INPUT,
        Result.BOOLEAN,
        UnitRule.NONE,
        usage="i.missing()",
        gives="whether the timeout has passed",
        subject="an input with a timeout",
    ),
    Function(
        "unknown",
        Argument.ANY,
        Result.BOOLEAN,
        UnitRule.NONE,
        usage="x.unknown()",
        gives="whether its value is unknown, for whatever reason",
        subject="an input with a timeout, or a function of one",
    ),
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


def usage_table() -> str:
    """Return the table of the documentation: how each function is written, on what, what it gives.

    Functions in a row that apply to the same and give the same share a line.
    """
    lines: dict[tuple[str, str], list[str]] = {}
    for row in FUNCTIONS.values():
        if row.usage:
            subject = row.subject or _SUBJECTS.get(row.argument, row.argument.value)
            lines.setdefault((subject, row.gives), []).append(f"`{row.usage}`")
    rows = [f"| {', '.join(usages)} | {on} | {gives} |" for (on, gives), usages in lines.items()]
    return "\n".join(["| function | of | value |", "|---|---|---|", *rows])


_SUBJECTS = {Argument.CONSTANT: "a constant"}
