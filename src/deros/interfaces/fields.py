"""Field paths of messages, such as ``position[2]`` or ``twist.twist.linear.x``.

A path is a tuple of field names and array indices, ``("position", 2)``.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import FieldType, InterfaceType, MessageDefinition
from deros.names.names import near

FieldPath = Sequence[str | int]

_PART = re.compile(r"\w+")


@dataclass(frozen=True, slots=True)
class ResolvedField:
    """The field that a path names.

    Attributes:
        type: the field's type; of the element where the path ends with an index.
        parent: the message whose field it is, which also holds the constants that may be compared
            with it; ``None`` for the empty path, which is the whole message.
        name: the field's name in ``parent``, without index.
        around: the types of all messages that the field is inside of, the outermost first.
    """

    type: FieldType
    parent: MessageDefinition | None
    name: str
    around: tuple[InterfaceType, ...] = ()


@dataclass(frozen=True, slots=True)
class FieldError:
    """The reason why a path does not name a field.

    Attributes:
        position: index in the path of the first part that does not fit.
        message: what is wrong, as a sentence without a full stop.
        candidates: names that may have been meant: near matches, or else all the fields there are.
    """

    position: int
    message: str
    candidates: tuple[str, ...] = ()


def resolve(
    store: InterfaceStore, kind: InterfaceType, path: FieldPath
) -> ResolvedField | FieldError:
    """Follow ``path`` from the root of the message type ``kind``."""
    here = ResolvedField(FieldType(kind), None, "")
    for position, part in enumerate(path):
        found = (
            _element(here, part, path[:position])
            if isinstance(part, int)
            else _field(store, here, part, path[:position])
        )
        if isinstance(found, _Refusal):
            return FieldError(position, found.message, found.candidates)
        here = found
    return here


def parse_path(text: str) -> tuple[str | int, ...]:
    """Return the path that is spelt so: ``covariance[3]`` is ``("covariance", 3)``."""
    return tuple(int(part) if part.isdecimal() else part for part in _PART.findall(text))


def without_indices(path: FieldPath) -> tuple[str, ...]:
    """Return the path of all elements at once: they share a unit."""
    return tuple(part for part in path if isinstance(part, str))


def format_path(path: FieldPath) -> str:
    """Return the spelling of a path, as ``poses[0].position.x``."""
    text = ""
    for part in path:
        if isinstance(part, int):
            text += f"[{part}]"
        else:
            text += f".{part}" if text else part
    return text


def leaves(
    store: InterfaceStore, kind: InterfaceType
) -> Iterator[tuple[tuple[str, ...], FieldType]]:
    """Yield every primitive field of a message, nested ones included, with its path, in order.

    An array counts as one leaf, also one of messages, and so does a message that is not known.
    """
    definition = store.message(kind)
    for name, field_type in definition.fields if definition else ():
        base = field_type.base
        if isinstance(base, str) or field_type.is_array or store.message(base) is None:
            yield (name,), field_type
            continue
        for path, leaf in leaves(store, base):
            yield (name, *path), leaf


@dataclass(frozen=True, slots=True)
class _Refusal:
    message: str
    candidates: tuple[str, ...] = ()


def _element(here: ResolvedField, index: int, before: FieldPath) -> ResolvedField | _Refusal:
    kind = here.type
    if not kind.is_array:
        return _Refusal(f"{_named(here, before)} is not an array")
    if index < 0:
        return _Refusal("indices start at 0")
    if kind.size is not None and index >= kind.size:
        at_most = "has" if kind.array == "fixed" else "has at most"
        return _Refusal(
            f"{_named(here, before)} {at_most} {kind.size} elements, 0 to {kind.size - 1}"
        )
    return replace(here, type=kind.element)


def _field(
    store: InterfaceStore, here: ResolvedField, name: str, before: FieldPath
) -> ResolvedField | _Refusal:
    kind = here.type
    if kind.is_array:
        return _Refusal(f"{_named(here, before)} is an array: an index is needed before '.{name}'")
    if isinstance(kind.base, str):
        return _Refusal(f"{_named(here, before)} has no fields")
    definition = store.message(kind.base)
    if definition is None:
        return _Refusal(f"the message type {kind.base.short} is not known")
    found = definition.field(name)
    if found is None:
        names = [field_name for field_name, _ in definition.fields]
        candidates = tuple(near(name, names) or names)
        return _Refusal(f"{kind.base.short} has no field '{name}'", candidates)
    return ResolvedField(found, definition, name, (*here.around, kind.base))


def _named(here: ResolvedField, before: FieldPath) -> str:
    return f"'{format_path(before)}' ({here.type})" if before else f"the message ({here.type})"
