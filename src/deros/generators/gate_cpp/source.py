"""Small pieces of the emitted C++ that only gates need: numbers of all widths, conditions."""

from __future__ import annotations

import math
import struct
from collections.abc import Sequence

from deros.diagnostics import Span
from deros.generators.cpp_source import (
    LINE_LENGTH,
    Text,
    cpp_double,
    cpp_string,
    expression,
    is_reserved,
    wrapped,
)
from deros.generators.monitor_python.names import Names
from deros.generators.monitor_python.source import origin
from deros.interfaces.types import FLOAT_TYPES, INTEGER_RANGES
from deros.monitor.ir import Scalar

NUMBERS = {
    "bool": "bool",
    "byte": "std::uint8_t",
    "char": "std::uint8_t",
    "float32": "float",
    "float64": "double",
} | {name: f"std::{name}_t" for name in INTEGER_RANGES if name not in ("byte", "char")}
"""The C++ type of every primitive that is no text."""

_OURS = """applying begin bounded command follow is_heartbeat_lost is_input_lost is_latched is_new
is_zero keep limit limits message may_release no_limit settle std t zero LATEST LINES LONG_AGO
NEVER PERIOD REFUSING"""


class CppNames(Names):
    """Hands out identifiers of C++ that differ from each other and from the templates' own."""

    def __init__(self) -> None:
        """Start with the names that the templates use."""
        super().__init__(frozenset(_OURS.split()))

    def new(self, *parts: str | int, endings: Sequence[str] = ()) -> str:
        """Return an identifier of ``parts`` that is free, as it is and with each of ``endings``."""
        name = super().new(*parts, endings=endings)
        if is_reserved(name):
            name = super().new(name, "value", endings=endings)
        return name


# Literals -----------------------------------------------------------------------------------------


def number(base: str, value: int | float) -> str:
    """Return the literal of a number in a field of a primitive type.

    >>> number("float32", 0.10000000149011612), number("uint32", 5), number("int8", -5)
    ('0.1F', '5U', '-5')
    """
    if base == "float32":
        return f"{_shortest(value)}F" if math.isfinite(value) else cpp_double(value)
    if base in FLOAT_TYPES:
        return cpp_double(value)
    if value == -(2**63):
        return "std::numeric_limits<std::int64_t>::min()"  # there is no literal below zero
    return f"{value}U" if base in ("uint32", "uint64") else str(value)


def _shortest(value: float) -> str:
    """Return the shortest text that reads back as a number of single precision."""
    texts = (repr(float(f"{value:.{digits}g}")) for digits in range(1, 10))
    return next(text for text in texts if _single(float(text)) == _single(value))


def _single(value: float) -> bytes:
    return struct.pack("f", value)


def scalar(base: str, value: Scalar) -> str:
    """Return the literal that a field of a primitive type is compared with."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _wide_string(value) if base == "wstring" else cpp_string(value)
    return number(base, value)


def _wide_string(text: str) -> str:
    units = struct.iter_unpack("<H", text.encode("utf-16-le"))
    listed = ", ".join(f"{unit:#06x}" for (unit,) in units)
    return f"std::u16string{{{listed}}}"


# Layout -------------------------------------------------------------------------------------------


def string_lines(text: str, indent: int) -> str:
    """Return a string literal that begins in column ``indent``, in parts where it is too long."""
    lines = expression(Text(text), indent + 1, ",")[:-1].replace("\n ", "\n")
    return f"({lines})" if "\n" in lines else lines  # else a comma might seem to be forgotten


def condition(operands: Sequence[str], indent: int) -> str:
    """Return the head of an ``if`` whose operands all have to hold."""
    line = f"if ({' && '.join(operands)}) {{"
    if indent + len(line) <= LINE_LENGTH:
        return line
    blanks = " " * indent
    glue = f" &&\n{blanks}  "
    return f"if ({glue.join(operands)})\n{blanks}{{"


def origin_comment(indent: int, title: str, span: Span) -> list[str]:
    """Return the comment above a block: its title, its origin and the source's text."""
    lead = f"{' ' * indent}// "
    lines = [f"{lead}{line}" for line in wrapped(f"{title} ({origin(span)})", len(lead))]
    for text in span.text.splitlines():
        lines += [f"{lead}  {line}" for line in wrapped(text, len(lead) + 2)]
    return lines
