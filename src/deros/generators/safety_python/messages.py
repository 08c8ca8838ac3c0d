"""Fields of messages as rclpy takes them."""

from __future__ import annotations

import math

from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import FLOAT_TYPES, FieldType, InterfaceType
from deros.monitor.commands import HEADER
from deros.monitor.ir import Scalar


def literal(kind: FieldType, value: Scalar) -> str:
    """Return the literal that rclpy takes for a field."""
    if kind.base == "byte":
        assert isinstance(value, int)
        return repr(bytes([value]))
    if kind.base in FLOAT_TYPES:
        assert not isinstance(value, str)
        number = float(value)
        return repr(number) if math.isfinite(number) else f"float({str(number)!r})"
    return repr(value)


def is_stamped(store: InterfaceStore, kind: InterfaceType) -> bool:
    """Tell whether messages of a type have a header with a time stamp."""
    definition = store.message(kind)
    return definition is not None and definition.field("header") == FieldType(HEADER)
