"""The functions for the fields of commands in Python: finite, zero, limited, sent."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from deros.generators.gate.view import SendWords, TypeBase
from deros.generators.text.identifiers import snake_case
from deros.interfaces.fields import FieldPath, format_path
from deros.interfaces.message_fields import field_type, unsized_arrays
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import FLOAT_TYPES, INTEGER_RANGES, FieldType, InterfaceType
from deros.rules.compiler.gates.command_types import CommandType, command_types
from deros.rules.program.commands import HEADER
from deros.rules.program.ir import Scalar


@dataclass(frozen=True, slots=True)
class TypeView(TypeBase):
    """The functions for one type; their names begin with ``prefix``, empty for the command's."""

    prefix: str


@dataclass(frozen=True, slots=True)
class NumberField:
    """A field with limits or a ramp.

    Attributes:
        name: its identifier.
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
    """Return the views of a message type and of the nested types with numbers, innermost first."""
    views: dict[InterfaceType, TypeView] = {}
    for each in command_types(store, kind):
        finite = tuple(_is_finite(name, field, views) for name, field in each.finite)
        zeros = tuple(_make_zero(each, name, field, views) for name, field in each.zeros)
        tests = tuple(_is_zero(name, field, views) for name, field in each.numbers)
        prefix = "" if each.type == kind else _prefix(each.type, views)
        views[each.type] = TypeView(each.type, finite, zeros, tests, each.stamped, prefix)
    return tuple(views.values())


def _prefix(kind: InterfaceType, views: Mapping[InterfaceType, TypeView]) -> str:
    """Return the type's name in lower case; with that of its package where it is taken."""
    name = snake_case(kind.name)
    taken = {view.prefix for view in views.values()}
    return f"{kind.package}_{name}_" if f"{name}_" in taken else f"{name}_"


def _is_finite(name: str, field: FieldType, views: Mapping[InterfaceType, TypeView]) -> str:
    base = field.base
    test = "isfinite" if isinstance(base, str) else f"{views[base].prefix}is_finite"
    return f"all(map({test}, msg.{name}))" if field.is_array else f"{test}(msg.{name})"


def _is_zero(name: str, field: FieldType, views: Mapping[InterfaceType, TypeView]) -> str:
    base, place = field.base, f"msg.{name}"
    if isinstance(base, InterfaceType):
        test = f"{views[base].prefix}is_zero"
        return f"all(map({test}, {place}))" if field.is_array else f"{test}({place})"
    if base == "byte":
        return f"not any(map(ord, {place}))" if field.is_array else f"not ord({place})"
    return f"not any({place})" if field.is_array else f"not {place}"


def _make_zero(
    command: CommandType, name: str, field: FieldType, views: Mapping[InterfaceType, TypeView]
) -> str:
    place = f"msg.{name}"
    if command.is_one(name):
        return f"{place} = 1.0  # zero would be no rotation at all"
    if isinstance(field.base, str):
        return _zero_of_primitive(place, field)
    each = "each" if field.is_array else place
    if field.base == HEADER:
        statement = f"{each}.stamp = stamp"
    else:
        view = views[field.base]
        statement = f"{view.prefix}make_zero({each}{', stamp' if view.stamped else ''})"
    return f"for each in {place}:\n    {statement}" if field.is_array else statement


def _zero_of_primitive(place: str, field: FieldType) -> str:
    if field.array == "fixed" and is_held_by_numpy(field):
        return f"{place}.fill(0)"
    zero = {"bool": "False", "byte": r"b'\x00'"}.get(str(field.base))
    zero = zero or ("0.0" if field.base in FLOAT_TYPES else "0")
    return f"{place} = [{zero}] * len({place})" if field.is_array else f"{place} = {zero}"


def is_held_by_numpy(field: FieldType) -> bool:
    """Return whether rclpy holds an array of fixed length of this type as a NumPy array."""
    return field.base in FLOAT_TYPES or (field.base in INTEGER_RANGES and field.base != "byte")


# Single fields ------------------------------------------------------------------------------------


def number_field(
    store: InterfaceStore, kind: InterfaceType, path: FieldPath, name: str
) -> NumberField:
    """Return the view of the field at ``path``, by the identifier ``name``."""
    place = f"msg.{format_path(path)}"
    tests = [
        f"len(msg.{format_path(array)}) > {index}"
        for array, index in unsized_arrays(store, kind, path)
    ]
    here, holder = field_type(store, kind, path), field_type(store, kind, path[:-1])
    read, written = place, name
    if here.base == "byte":
        read, written = f"{place}[0]", f"bytes([{name}])"
    elif holder.array == "fixed" and is_held_by_numpy(holder):
        read = f"{'float' if here.base in FLOAT_TYPES else 'int'}({place})"
    if tests:
        read += f" if {' and '.join(tests)} else None"
    return NumberField(name, format_path(path), read, place, written)


# What lines send ----------------------------------------------------------------------------------


def _literal(field: FieldType, value: Scalar) -> str:
    return repr(bytes([int(value)])) if field.base == "byte" else repr(value)


SEND_WORDS = SendWords(
    message="msg",
    negation="not ",
    conjunction=" and ",
    longer=lambda array, count: f"len({array}) > {count}",
    empty=lambda array: f"len({array}) == 0",
    assigned=lambda place, field, value: (
        f"{place} = {'[]' if value is None else _literal(field, value)}"
    ),
    guarded=lambda condition, statement: f"if {condition}:\n    {statement}",
    literal=_literal,
)
"""How the functions for commands set and test the fields of what lines send."""
