"""Fields of messages as rclpy gives them, and as the monitor takes them."""

from __future__ import annotations

import math

from deros.interfaces.fields import FieldPath, ResolvedField, resolve
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import FLOAT_TYPES, INTEGER_RANGES, FieldType, InterfaceType
from deros.monitor.ir import Scalar

_HEADER = InterfaceType("std_msgs", "msg", "Header")


def reading(store: InterfaceStore, kind: InterfaceType, path: FieldPath) -> str:
    """Return the expression that reads the field at ``path`` of the message ``msg``.

    It is NaN where the message's array is too short. ``byte`` comes out as an integer, and what
    rclpy holds as NumPy (arrays of fixed length) as Python's own numbers: a ``float32`` of NumPy
    would make its comparisons in single precision.
    """
    text, tests = "msg", []
    here, is_numpy = FieldType(kind), False
    for position, part in enumerate(path):
        before = here
        found = resolve(store, kind, path[: position + 1])
        assert isinstance(found, ResolvedField), found
        here = found.type
        if isinstance(part, str):
            text += f".{part}"
            continue
        is_numpy = before.array == "fixed" and _is_numeric(before)
        if before.array != "fixed":
            tests.append(f"len({text}) > {part}")
        text += f"[{part}]"
    value = _converted(text, here, is_numpy)
    return f"{value} if {' and '.join(tests)} else math.nan" if tests else value


def _converted(text: str, kind: FieldType, is_numpy: bool) -> str:
    if kind.base == "byte":
        return f"[item[0] for item in {text}]" if kind.is_array else f"{text}[0]"
    if kind.array == "fixed" and _is_numeric(kind):
        return f"{text}.tolist()"
    if is_numpy:
        return f"{'float' if kind.base in FLOAT_TYPES else 'int'}({text})"
    return text


def _is_numeric(kind: FieldType) -> bool:
    return kind.base in FLOAT_TYPES or (kind.base in INTEGER_RANGES and kind.base != "byte")


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
    return definition is not None and definition.field("header") == FieldType(_HEADER)
