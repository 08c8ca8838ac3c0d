"""The fields of commands that gates check, set to zero and limit."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import (
    FLOAT_TYPES,
    STRING_TYPES,
    FieldType,
    InterfaceType,
    MessageDefinition,
)
from deros.rules.program.commands import HEADER, LAYOUT, QUATERNION

Fields = tuple[tuple[str, FieldType], ...]
"""Fields of one message: their names and types."""


@dataclass(frozen=True, slots=True)
class CommandType:
    """A message type in a command, the command's own included.

    Attributes:
        type: its name in ROS 2.
        finite: the fields that are floats, or messages with floats in them.
        zeros: the fields that zero changes; of a header, that is its stamp.
        numbers: those of them that are 0 in a zero command; headers are not among them.
        stamped: whether it, or a message in it, has a header that takes the time.
    """

    type: InterfaceType
    finite: Fields
    zeros: Fields
    numbers: Fields
    stamped: bool

    def is_one(self, field: str) -> bool:
        """Return whether zero sets a field to 1: a quaternion of four zeros is not a rotation."""
        return self.type == QUATERNION and field == "w"


def command_types(store: InterfaceStore, kind: InterfaceType) -> tuple[CommandType, ...]:
    """Return a message type and the types nested in it, innermost first.

    Types without numbers are left out.
    """
    found: dict[InterfaceType, CommandType] = {}
    _collect(store, kind, found)
    return tuple(found.values())


def _collect(
    store: InterfaceStore, kind: InterfaceType, found: dict[InterfaceType, CommandType]
) -> None:
    definition = store.message(kind)
    assert definition is not None, kind
    nested = [f.base for _, f in definition.fields if isinstance(f.base, InterfaceType)]
    for base in nested:
        if base not in found and base not in (HEADER, LAYOUT):  # they command nothing
            _collect(store, base, found)
    finite = tuple(_finite(definition, found))
    zeros = tuple(_zeros(definition, found))
    if finite or zeros:
        parts = [found.get(base) for base in nested]
        stamped = HEADER in nested or any(part.stamped for part in parts if part)
        numbers = tuple(_numbers(kind, zeros, found))
        found[kind] = CommandType(kind, finite, zeros, numbers, stamped)


def _finite(
    definition: MessageDefinition, found: dict[InterfaceType, CommandType]
) -> Iterator[tuple[str, FieldType]]:
    for name, field in definition.fields:
        if isinstance(field.base, str):
            is_looked_at = field.base in FLOAT_TYPES
        else:
            is_looked_at = field.base in found and bool(found[field.base].finite)
        if is_looked_at:
            yield name, field


def _zeros(
    definition: MessageDefinition, found: dict[InterfaceType, CommandType]
) -> Iterator[tuple[str, FieldType]]:
    for name, field in definition.fields:
        if isinstance(field.base, str):
            is_changed = field.base not in STRING_TYPES
        else:
            is_changed = field.base == HEADER or (
                field.base in found and bool(found[field.base].zeros)
            )
        if is_changed:
            yield name, field


def _numbers(
    kind: InterfaceType, zeros: Fields, found: dict[InterfaceType, CommandType]
) -> Iterator[tuple[str, FieldType]]:
    for name, field in zeros:
        if kind == QUATERNION and name == "w":
            continue  # of no rotation it is 1
        if isinstance(field.base, str) or (field.base in found and found[field.base].numbers):
            yield name, field
