"""Constants as C writes them."""

from __future__ import annotations

import math


def number(value: float) -> str:
    """Return the literal of a double: the shortest text that reads back as the same number."""
    if math.isnan(value):
        return "NAN"
    if math.isinf(value):
        return "-INFINITY" if value < 0 else "INFINITY"
    return repr(value)


def integer(value: int) -> str:
    """Return the literal of an ``int64_t``."""
    if value == -(2**63):
        return "(-INT64_C(9223372036854775807) - INT64_C(1))"
    return f"INT64_C({value})" if value >= 0 else f"-INT64_C({-value})"


def literal(value: bool | int | float) -> str:
    """Return the literal of a constant."""
    if isinstance(value, bool):
        return "true" if value else "false"
    return integer(value) if isinstance(value, int) else number(value)
