"""Types and literals of message fields in C++."""

from __future__ import annotations

import math
import struct

from deros.generators.text.cpp import cpp_double, cpp_string
from deros.interfaces.types import FLOAT_TYPES, INTEGER_RANGES
from deros.rules.program.ir import Scalar

NUMBERS = {
    "bool": "bool",
    "byte": "std::uint8_t",
    "char": "std::uint8_t",
    "float32": "float",
    "float64": "double",
} | {name: f"std::{name}_t" for name in INTEGER_RANGES if name not in ("byte", "char")}
"""The C++ type of each primitive that is not a string."""


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
    """Return the literal of a value for comparison with a field of a primitive type."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _wide_string(value) if base == "wstring" else cpp_string(value)
    return number(base, value)


def _wide_string(text: str) -> str:
    units = struct.iter_unpack("<H", text.encode("utf-16-le"))
    listed = ", ".join(f"{unit:#06x}" for (unit,) in units)
    return f"std::u16string{{{listed}}}"
