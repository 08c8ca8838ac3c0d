"""Literals of message fields for rclpy."""

from __future__ import annotations

import math

from deros.interfaces.types import FLOAT_TYPES, FieldType
from deros.rules.program.ir import Scalar


def literal(type_: FieldType, value: Scalar) -> str:
    """Return the literal that rclpy accepts for a field."""
    if type_.base == "byte":
        assert isinstance(value, int)
        return repr(bytes([value]))
    if type_.base in FLOAT_TYPES:
        assert not isinstance(value, str)
        number = float(value)
        return repr(number) if math.isfinite(number) else f"float({str(number)!r})"
    return repr(value)
