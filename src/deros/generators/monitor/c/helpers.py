"""The helper functions of monitors; those that a monitor does not call are left out.

Each text holds its contract. ``@`` stands for the prefix of public types, ``$`` for that of macros.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from deros.generators.monitor.c.acsl import quantities, scans, windows
from deros.generators.monitor.c.acsl.contracts import wrapped
from deros.generators.monitor.c.acsl.formulas import (
    entries_contract,
    entries_invariants,
    loop_contract,
    loop_invariants,
    step_contract,
)
from deros.generators.monitor.c.code.computed import (
    computed_functions,
    entries_functions,
    points_functions,
)
from deros.generators.monitor.c.code.formulas import (
    entries_text,
    formula_text,
    point_test_text,
    points_text,
    printed,
    shared_texts,
)
from deros.generators.monitor.c.code.value_types import ELEMENTS
from deros.generators.monitor.c.verdicts import VERDICTS
from deros.generators.monitor.computed import ComputedFunction
from deros.generators.text.c import harmless
from deros.interfaces.types import FLOAT_TYPES
from deros.rules.functions.function_forms import LENGTH_OF
from deros.rules.functions.function_texts import C
from deros.rules.functions.functions import FUNCTIONS, Argument, Function
from deros.rules.program.formulas import SHARED
from deros.rules.program.ir import Program, Zone

_IS_NUMBER = """\
/* Returns whether a number is not NaN, with which no comparison is true. */
/*@ assigns \\nothing;
    ensures \\result == 0 <==> \\is_NaN(value); */
static bool is_number(double value)
{
  return value == value;
}
"""

_ARE_NUMBERS = """\
/* Returns whether no element is a NaN. */
/*@ requires \\valid_read(values + (0 .. count - 1));
    assigns \\nothing; */
static bool are_numbers_BASE(const ELEMENT *values, size_t count)
{
  bool numbers = true;
  /*@ loop invariant 0 <= i <= count;
      loop assigns i, numbers;
      loop variant count - i; */
  for (size_t i = 0U; i < count; ++i) {
    if (!is_number((double)values[i])) {
      numbers = false;
    }
  }
  return numbers;
}
"""

_IS_TEXT = """\
/* Returns whether a text is the expected one. */
/*@ requires \\valid_read(text + (0 .. length - 1));
    requires \\valid_read(expected + (0 .. expected_length - 1));
    assigns \\nothing; */
static bool is_text(
  const char *text, size_t length, const char *expected, size_t expected_length)
{
  bool same = (length == expected_length);
  /*@ loop invariant 0 <= i <= expected_length;
      loop assigns i, same;
      loop variant expected_length - i; */
  for (size_t i = 0U; i < expected_length; ++i) {
    if (same) {
      same = (text[i] == expected[i]);
    }
  }
  return same;
}
"""

_PUT = """\
/* Stores a value; returns whether it has changed, or another one had. */
/*@ requires \\valid(place);
    assigns *place;
    ensures *place == value;
    ensures \\result != 0 <==> news != 0 || value != \\old(*place); */
static bool store_KIND(TYPE *place, TYPE value, bool news)
{
  const bool other = (*place != value);
  *place = value;
  return news || other;
}
"""

_EARLIER = """\
/*@ assigns \\nothing;
    ensures \\result <= a && \\result <= b && (\\result == a || \\result == b); */
static int64_t earlier(int64_t a, int64_t b)
{
  return (a < b) ? a : b;
}
"""

_AHEAD = """\
/* The earlier of two deadlines, of which the second counts only if it is in the future. */
/*@ assigns \\nothing;
    ensures \\result == due || (\\result == end && end > now);
    ensures \\result <= due && (end > now ==> \\result <= end); */
static int64_t ahead(int64_t now, int64_t due, int64_t end)
{
  return ((end > now) && (end < due)) ? end : due;
}
"""

_BOUNDED = """\
/* A time within the range that the monitor counts in. */
/*@ assigns \\nothing;
    ensures \\result == (t < 0 ? 0 : t > $_LATEST ? $_LATEST : t); */
static int64_t bounded(int64_t t)
{
  return (t < 0) ? 0 : earlier(t, $_LATEST);
}
"""

_COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
_STORED = {"truth": "bool", "integer": "int64_t", "unsigned": "uint64_t", "text": "uint32_t"}

_LOOP = """\
  /*@ loop invariant 0 <= i <= count;
      loop assigns LOOP;
      loop variant count - i; */
"""


def helper_texts(program: Program, text: str) -> list[str]:
    """Return the definitions that ``text`` needs, in an order in which each can be compiled."""
    needed: list[str] = []
    known = dict(_all(program))
    wanted = _COMMENT.sub("", text)  # which quote the rules
    for name in reversed(known):
        if re.search(rf"\b{name}\(", wanted):
            needed.append(known[name])
            wanted += _COMMENT.sub("", known[name])
    return needed[::-1]


def helper_names(program: Program) -> frozenset[str]:
    """Return the names of all helper functions that the monitor of a program may have."""
    return frozenset(name for name, _ in _all(program))


def _all(program: Program) -> Iterator[tuple[str, str]]:
    """Yield every helper by its name; none calls a later one."""
    yield "is_number", _IS_NUMBER
    yield "earlier", _EARLIER
    yield "ahead", _AHEAD
    yield "bounded", _BOUNDED
    for base in sorted(FLOAT_TYPES):
        yield f"are_numbers_{base}", _of_elements(_ARE_NUMBERS, base)
    yield "is_text", _IS_TEXT
    for kind, type_ in _STORED.items():
        yield f"store_{kind}", _PUT.replace("KIND", kind).replace("TYPE", type_)
    parameters = {"length_of": LENGTH_OF[0], **{name: each for name, (each, _) in SHARED.items()}}
    for name, text in shared_texts():
        yield name, quantities.contract(name, parameters[name]) + text
    rows = [row for row in FUNCTIONS.values() if row.argument in _OF_NUMBERS and printed(row)]
    for row in rows:
        if not row.is_stateful:
            yield row.c_name, _contract(row) + printed(row)
    yield "magnitude", _MAGNITUDE + C["magnitude"]
    for row in rows:
        if row.step is not None:
            yield row.c_name, _contract(row) + printed(row)
    yield "between", windows.BETWEEN + C["between"]
    yield "stamp_of", windows.STAMP_OF + C["stamp_of"]
    yield "latency", windows.LATENCY + C["latency"]
    yield "base_of", windows.BASE_OF + windows.with_loop("base_of", C["base_of"])
    yield "drop", windows.DROP + windows.with_loop("drop", C["drop"])
    yield "keep", windows.KEEP + C["keep"]
    yield "rate_over", windows.RATE_OVER + C["rate_over"]
    for row, base in quantities.loops_of(program):
        yield f"{row.c_name}_{base}", _of_array(row, base)
    for each in computed_functions(program).values():
        text = formula_text(each.name, each.parameters, each.formula)
        said = "\n".join(wrapped(f"/* {harmless(_says(each))} */"))
        yield each.name, f"{said}\n{quantities.contract(each.name, each.parameters)}{text}"
    for entries in entries_functions(program).values():
        said = "\n".join(wrapped(f"/* How many entries satisfy: {harmless(entries.wording)} */"))
        body = _with_loop(entries_text(entries), "i, found", entries_invariants(entries))
        yield entries.name, f"{said}\n{entries_contract(entries)}{body}"
    yield "in_sector", scans.IN_SECTOR + C["in_sector"]
    yield "beam", scans.BEAM + C["beam"]
    for points in points_functions(program):
        said = "\n".join(wrapped(f"/* {harmless(_says_zone(points.wording, points.zone))} */"))
        test = scans.point_test_contract(points) + point_test_text(points)
        yield points.test, f"{said}\n{test}"
        loop = scans.points_loop(points)
        yield loop.name, loop.contract + _with_loop(points_text(points), loop.assigned, loop.kept)
    for scan in scans.LOOPS:
        yield scan.name, scan.contract + _with_loop(C[scan.name], scan.assigned, scan.kept)
    yield from VERDICTS.items()


def _says(function: ComputedFunction) -> str:
    """Return what a function computes; of a zone, where it is declared and as what."""
    zone = function.zone
    if zone is None:
        return function.wording
    return _says_zone(f"{function.wording} as 1 or 0", zone)


def _says_zone(wording: str, zone: Zone) -> str:
    """Return what is asked of a zone, and where it is declared and as what."""
    line = "" if zone.span is None else f", declared in line {zone.span.line}"
    description = f": {zone.description}" if zone.description else ""
    return f"{wording}; zone {zone.name}{line}{description}"


_OF_NUMBERS = (Argument.NUMBER, Argument.QUATERNION, Argument.VECTOR)
"""What functions without a loop are applied to."""


def _contract(row: Function) -> str:
    """Return the contract of a function without a loop."""
    if row.c:
        return _BY_HAND.get(row.c_name, "/*@ assigns \\nothing; */\n")
    if row.step is not None:
        return step_contract(row, row.step)
    return quantities.contract(row.c_name, row.variables)


def _of_array(row: Function, base: str) -> str:
    """Return a function of arrays, with its contract, for one type of elements."""
    if row.loop is None:
        return _of_elements(_ARRAY + row.c, base)
    is_proved = base in quantities.PROVED
    kept = loop_invariants(row, row.loop, base, is_proved)
    text = _with_loop(printed(row), f"i, {row.loop.accumulator}", kept)
    return loop_contract(row, base, is_proved) + _of_elements(text, base)


_ARRAY = """\
/*@ requires \\valid_read(values + (0 .. count - 1));
    assigns \\nothing; */
"""

_MAGNITUDE = """\
/*@ requires value > INT64_MIN;
    assigns \\nothing;
    ensures \\result == \\abs(value); */
"""

_RATE = """\
/* The change per second since the message before; NaN for two at the same time. */
/*@ requires \\valid(last) && \\valid(last_t) && \\separated(last, last_t);
    requires 0 <= t <= INT64_MAX && 0 <= *last_t <= INT64_MAX;
    assigns *last, *last_t;
    ensures *last_t == t;
    ensures same(*last, value);
    check ensures t == \\old(*last_t) ==> \\is_NaN(\\result);
    check ensures t != \\old(*last_t) ==> same(\\result,
      CHANGE); */
""".replace("CHANGE", quantities.change_per_second("\\old(*last)", "t - \\old(*last_t)"))


_BY_HAND = {"rate": _RATE, "unwrapped": windows.UNWRAPPED}
"""The contracts of functions with a memory whose text is written by hand."""


def _of_elements(text: str, base: str) -> str:
    floats = base in FLOAT_TYPES
    result = "double" if floats else ("uint64_t" if base == "uint64" else "int64_t")
    return (
        text.replace("BASE", base)
        .replace("ELEMENT", ELEMENTS[base])
        .replace("RESULT", result)
        .replace("NONE", "NAN" if floats else "0")
    )


def _with_loop(text: str, assigned: str, kept: Iterable[str] = ()) -> str:
    """Return a function's text with the annotation of its loop."""
    start = text.index("  for (")
    bounds, rest = _LOOP.replace("LOOP", assigned).split("\n", 1)
    lines = [bounds]
    for each in kept:
        if "\n" in each:
            lines.append(f"      loop invariant {each};".replace("\n", "\n      "))
        else:
            lines += wrapped(f"loop invariant {each};", 6)
    return text[:start] + "\n".join([*lines, rest]) + text[start:]
