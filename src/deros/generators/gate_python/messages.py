"""What a gate does to the fields of a command: looks for NaN, makes zeros of them, limits them."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass

from deros.generators.monitor_python.names import Names
from deros.interfaces.fields import FieldPath, ResolvedField, format_path, resolve
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import (
    FLOAT_TYPES,
    INTEGER_RANGES,
    STRING_TYPES,
    FieldType,
    InterfaceType,
    MessageDefinition,
)
from deros.monitor.commands import HEADER, LAYOUT, QUATERNION

_WORD = re.compile(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])")


@dataclass(frozen=True, slots=True)
class TypeView:
    """The functions for one message type.

    Attributes:
        type: its name in ROS 2.
        prefix: of the functions' names; empty for the command itself.
        finite: the operands whose conjunction tells whether each float in it is finite.
        zeros: the statements that make zeros of it.
        stamped: whether it, or a message in it, has a header that takes the time.
    """

    type: InterfaceType
    prefix: str
    finite: tuple[str, ...]
    zeros: tuple[str, ...]
    stamped: bool


@dataclass(frozen=True, slots=True)
class LimitedField:
    """A field that a limit of the gate speaks of.

    Attributes:
        name: an identifier that tells it from the other ones.
        path: its spelling in the rules.
        read: the expression of its value in the message ``msg``; ``None`` where the message's array
            is too short.
        target: what a new value is assigned to, and ``written`` the value as rclpy takes it.
    """

    name: str
    path: str
    read: str
    target: str
    written: str


# Whole messages -----------------------------------------------------------------------------------


def type_views(store: InterfaceStore, kind: InterfaceType) -> tuple[TypeView, ...]:
    """Return the views of a message type and of those in it, the innermost first.

    Types that have no number, and so nothing to look at or to change, are left out.
    """
    found: dict[InterfaceType, TypeView] = {}
    _view(store, kind, found, "")
    return tuple(found.values())


def _view(
    store: InterfaceStore, kind: InterfaceType, found: dict[InterfaceType, TypeView], prefix: str
) -> None:
    definition = store.message(kind)
    assert definition is not None, kind
    nested = [f.base for _, f in definition.fields if isinstance(f.base, InterfaceType)]
    for base in nested:
        if base not in found and base not in (HEADER, LAYOUT):  # they command nothing
            _view(store, base, found, _prefix(base, found))
    finite = tuple(_finite(definition, found))
    zeros = tuple(_zeros(definition, found))
    if finite or zeros:
        parts = [found.get(base) for base in nested]
        stamped = HEADER in nested or any(part.stamped for part in parts if part)
        found[kind] = TypeView(kind, prefix, finite, zeros, stamped)


def _prefix(kind: InterfaceType, found: dict[InterfaceType, TypeView]) -> str:
    """Return the type's name in lower case; with that of its package where it is taken."""
    name = _WORD.sub("_", kind.name).lower()
    taken = {view.prefix for view in found.values()}
    return f"{kind.package}_{name}_" if f"{name}_" in taken else f"{name}_"


def _finite(definition: MessageDefinition, found: dict[InterfaceType, TypeView]) -> Iterable[str]:
    for name, field in definition.fields:
        if isinstance(field.base, str):
            test = "isfinite" if field.base in FLOAT_TYPES else None
        else:
            view = found.get(field.base)
            test = f"{view.prefix}is_finite" if view and view.finite else None
        if test is None:
            continue
        yield f"all(map({test}, msg.{name}))" if field.is_array else f"{test}(msg.{name})"


def _zeros(definition: MessageDefinition, found: dict[InterfaceType, TypeView]) -> Iterable[str]:
    for name, field in definition.fields:
        if field.base in STRING_TYPES:
            continue
        each = "each" if field.is_array else f"msg.{name}"
        if definition.type == QUATERNION and name == "w":
            yield "msg.w = 1.0  # zero would be no rotation at all"
            continue
        if isinstance(field.base, str):
            yield _zero_of_primitive(f"msg.{name}", field)
            continue
        if field.base == HEADER:
            statement = f"{each}.stamp = stamp"
        elif (view := found.get(field.base)) and view.zeros:
            statement = f"{view.prefix}make_zero({each}{', stamp' if view.stamped else ''})"
        else:
            continue
        yield f"for each in msg.{name}:\n    {statement}" if field.is_array else statement


def _zero_of_primitive(place: str, field: FieldType) -> str:
    if field.array == "fixed" and is_held_by_numpy(field):
        return f"{place}.fill(0)"
    zero = {"bool": "False", "byte": r"b'\x00'"}.get(str(field.base))
    zero = zero or ("0.0" if field.base in FLOAT_TYPES else "0")
    return f"{place} = [{zero}] * len({place})" if field.is_array else f"{place} = {zero}"


def is_held_by_numpy(field: FieldType) -> bool:
    """Tell whether rclpy holds an array of fixed length of this type as a NumPy array."""
    return field.base in FLOAT_TYPES or (field.base in INTEGER_RANGES and field.base != "byte")


# Single fields ------------------------------------------------------------------------------------


def limited_fields(
    store: InterfaceStore, kind: InterfaceType, paths: Iterable[FieldPath], names: Names
) -> tuple[LimitedField, ...]:
    """Return the views of the fields at ``paths``, each once, in the order first named."""
    return tuple(
        _limited_field(store, kind, path, names.new(*path))
        for path in dict.fromkeys(tuple(path) for path in paths)
    )


def _limited_field(
    store: InterfaceStore, kind: InterfaceType, path: FieldPath, name: str
) -> LimitedField:
    text, tests = "msg", []
    is_numpy = False
    for position, part in enumerate(path):
        if isinstance(part, str):
            text += f".{part}"
            continue
        array = _resolved(store, kind, path[:position])
        is_numpy = array.array == "fixed" and is_held_by_numpy(array)
        if array.array != "fixed":
            tests.append(f"len({text}) > {part}")
        text += f"[{part}]"
    here = _resolved(store, kind, path)
    read, written = text, name
    if here.base == "byte":
        read, written = f"{text}[0]", f"bytes([{name}])"
    elif is_numpy:
        read = f"{'float' if here.base in FLOAT_TYPES else 'int'}({text})"
    if tests:
        read += f" if {' and '.join(tests)} else None"
    return LimitedField(name, format_path(path), read, text, written)


def _resolved(store: InterfaceStore, kind: InterfaceType, path: FieldPath) -> FieldType:
    found = resolve(store, kind, path)
    assert isinstance(found, ResolvedField), found
    return found.type
