"""Commands as plain data: finite ones, limited ones and zeros.

A message is a mapping from field names to values; a nested message is a mapping, an array a
sequence. Traces hold messages in the same form.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from deros.interfaces.durations import NS_PER_S
from deros.interfaces.fields import FieldPath
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import (
    FLOAT_TYPES,
    STRING_TYPES,
    FieldType,
    InterfaceType,
)
from deros.rules.program.ir import Limit, Scalar, StopField

Message = Mapping[str, Any]

TIME = InterfaceType("builtin_interfaces", "msg", "Time")
HEADER = InterfaceType("std_msgs", "msg", "Header")
QUATERNION = InterfaceType("geometry_msgs", "msg", "Quaternion")
LAYOUT = InterfaceType("std_msgs", "msg", "MultiArrayLayout")

NO_ROTATION = {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}
"""A quaternion of four zeros is not a rotation, and breaks computations with it."""


def is_finite(value: Any) -> bool:
    """Return whether no number in a message is NaN or infinite."""
    if isinstance(value, float):
        return math.isfinite(value)
    if isinstance(value, Mapping):
        return all(map(is_finite, value.values()))
    if isinstance(value, Sequence) and not isinstance(value, str):
        return all(map(is_finite, value))
    return True


def is_zero(store: InterfaceStore, kind: InterfaceType, message: Message) -> bool:
    """Return whether a command is zero: all numbers that :func:`zero` changes are 0.

    Booleans are false. Texts, the layout of arrays and headers do not count; nor does the ``w`` of
    a quaternion without rotation.
    """
    if kind == QUATERNION:
        return not (message["x"] or message["y"] or message["z"])
    definition = store.message(kind)
    assert definition is not None, f"{kind} was known when the gate was built"
    return all(_is_zero_field(store, field, message[name]) for name, field in definition.fields)


def _is_zero_field(store: InterfaceStore, kind: FieldType, value: Any) -> bool:
    if kind.base in (HEADER, LAYOUT) or kind.base in STRING_TYPES:
        return True
    values = value if kind.is_array else [value]
    if isinstance(kind.base, InterfaceType):
        return all(is_zero(store, kind.base, each) for each in values)
    return not any(values)


def is_sent(
    store: InterfaceStore, kind: InterfaceType, message: Message, sent: Iterable[StopField]
) -> bool:
    """Return whether a command has the fields of what is sent, and is zero otherwise."""
    rest = message
    for each in sent:
        value = value_at(message, each.path)
        wanted = each.value
        if wanted is None:
            if value:
                return False
            continue
        if value is None or value != wanted:
            return False
        rest = put(rest, each.path, each.zero)
    return is_zero(store, kind, rest)


def sent(message: Message, fields: Iterable[StopField]) -> Message:
    """Return zeros with the fields of what is sent, as far as their arrays are long enough."""
    for each in fields:
        if each.value is None:
            message = put(message, each.path, [])
        elif value_at(message, each.path) is not None:
            message = put(message, each.path, each.value)
    return message


def limited(message: Message, limits: Iterable[Limit]) -> Message:
    """Return the message within all limits: itself, if it is within them already."""
    for limit in limits:
        value, (lower, upper) = value_at(message, limit.path), limit.interval
        if value is not None and not lower <= value <= upper:
            message = put(message, limit.path, lower if value < lower else upper)
    return message


def value_at(message: Message, path: FieldPath) -> Any:
    """Return the value at ``path``; ``None`` if an array is too short for it."""
    value: Any = message
    for step in path:
        if isinstance(step, int) and step >= len(value):
            return None
        value = value[step]
    return value


def put(value: Any, path: FieldPath, new: Scalar | Sequence[Any]) -> Any:
    """Return a copy of a message with a new value at ``path``."""
    if not path:
        return new
    step, rest = path[0], path[1:]
    if isinstance(step, int):
        return [put(each, rest, new) if i == step else each for i, each in enumerate(value)]
    return {**value, step: put(value[step], rest, new)}


def zero(store: InterfaceStore, kind: InterfaceType, last: Message | None, t_ns: int) -> Message:
    """Return the zero command, in the form of the ``last`` command if there is one.

    Numbers are 0 and booleans false. Texts, such as the frame, and the lengths and the layout of
    arrays are those of the last command. Quaternions are the identity; the stamps of headers are
    ``t_ns``.
    """
    return _zero_message(store, kind, last or {}, t_ns)


def _zero_message(store: InterfaceStore, kind: InterfaceType, last: Message, t_ns: int) -> Message:
    if kind == QUATERNION:
        return NO_ROTATION
    if kind == LAYOUT and last:
        return last
    definition = store.message(kind)
    assert definition is not None, f"{kind} was known when the gate was built"
    made = {
        name: _zero_field(store, field, last.get(name), t_ns) for name, field in definition.fields
    }
    if kind == HEADER:
        seconds, nanoseconds = divmod(t_ns, NS_PER_S)
        made["stamp"] = {"sec": seconds, "nanosec": nanoseconds}
    return made


def _zero_field(store: InterfaceStore, kind: FieldType, last: Any, t_ns: int) -> Any:
    if not kind.is_array:
        return _zero_value(store, kind, last, t_ns)
    if last is None:
        last = [None] * (kind.size or 0) if kind.array == "fixed" else []
    return [_zero_value(store, kind.element, each, t_ns) for each in last]


def _zero_value(store: InterfaceStore, kind: FieldType, last: Any, t_ns: int) -> Any:
    if isinstance(kind.base, InterfaceType):
        return _zero_message(store, kind.base, last or {}, t_ns)
    if kind.base in STRING_TYPES:
        return last or ""
    if kind.base == "bool":
        return False
    return 0.0 if kind.base in FLOAT_TYPES else 0
