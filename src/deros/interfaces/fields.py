"""Field paths of messages: ``twist.linear.x``, ``position[2]``, ``status[name = "lidar"].level``.

A path is a tuple of field names, array indices and keys, ``("position", 2)``.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import (
    INTEGER_RANGES,
    STRING_TYPES,
    FieldType,
    InterfaceType,
    MessageDefinition,
)
from deros.names.names import near

_LONGEST_NAME = 40


@dataclass(frozen=True, slots=True)
class Key:
    """A step to an element of an array by what it is called: ``[name = "lidar"]``.

    Of an array of messages, it is the first one whose field ``name`` has the value; of any other
    array the one at the place where ``name``, an array beside it, first has the value.
    """

    name: str
    value: str | int

    def __str__(self) -> str:
        """Return what variables for the element are called after: the value, or its beginning."""
        return str(self.value)[:_LONGEST_NAME]


PathStep = str | int | Key
FieldPath = tuple[PathStep, ...]

BRACKETS = (
    r"\[\s*(?:(?P<index>\d+)|(?P<key>[^\W\d]\w*)\s*==?\s*"
    r'(?P<value>-?\d+|"(?:[^"\\\n]|\\.)*"))\s*\]'
)
"""An index or a key, as it is written."""

STEP = re.compile(rf"(?P<name>[^\W\d]\w*)|{BRACKETS}")
"""A step of a path, as it is written."""


@dataclass(frozen=True, slots=True)
class ResolvedField:
    """The field that a path names.

    Attributes:
        type: the field's type; of the element where the path ends with an index or a key.
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
        before = path[:position]
        match part:
            case int():
                found = _element(here, part, before)
            case Key():
                found = _keyed(store, here, part, before)
            case _:
                found = _field(store, here, part, before)
        if isinstance(found, _Refusal):
            return FieldError(position, found.message, found.candidates)
        here = found
    return here


def parse_path(text: str) -> tuple[PathStep, ...]:
    """Return the path that is spelt so: ``covariance[3]`` is ``("covariance", 3)``.

    Raises:
        ValueError: a key has a backslash that means nothing.
    """
    return tuple(step_of(found) for found in STEP.finditer(text))


def step_of(found: re.Match[str], text_of: Callable[[str], str] = json.loads) -> PathStep:
    """Return the step that was found; ``text_of`` reads a text in quotes."""
    if found["index"]:
        return int(found["index"])
    if found["key"]:
        value = found["value"]
        return Key(found["key"], text_of(value) if value[0] == '"' else int(value))
    return found["name"]


def without_indices(path: FieldPath) -> tuple[str, ...]:
    """Return the path of all elements at once: they share a unit."""
    return tuple(part for part in path if isinstance(part, str))


def format_path(path: FieldPath) -> str:
    """Return the spelling of a path, as ``poses[0].position.x``."""
    return format_steps(path).removeprefix(".")


def format_steps(path: FieldPath) -> str:
    """Return the spelling of a path behind what it is a part of, as ``.x`` or ``[0].x``."""
    return "".join(map(_spelling, path))


def _spelling(step: PathStep) -> str:
    match step:
        case int():
            return f"[{step}]"
        case Key():
            return f"[{step.name} = {_value_text(step)}]"
        case _:
            return f".{step}"


def _value_text(key: Key) -> str:
    return json.dumps(key.value, ensure_ascii=False)


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


def _keyed(
    store: InterfaceStore, here: ResolvedField, key: Key, before: FieldPath
) -> ResolvedField | _Refusal:
    kind, array = here.type, _named(here, before)
    if not kind.is_array:
        return _Refusal(f"{array} is not an array")
    inside = isinstance(kind.base, InterfaceType)
    definition = store.message(kind.base) if isinstance(kind.base, InterfaceType) else here.parent
    if definition is None:
        return _Refusal(f"the message type {kind.base} is not known")
    known = {name: each for name, each in definition.fields if each.is_array is not inside}
    found = known.get(key.name)
    if found is None or not (found.base in STRING_TYPES or found.base in INTEGER_RANGES):
        bases = STRING_TYPES if isinstance(key.value, str) else INTEGER_RANGES.keys()
        fit = [name for name, each in known.items() if each.base in bases]
        candidates = tuple(near(key.name, fit) or fit)
        where = f"the elements of {array} have" if inside else f"beside {array} there is"
        lacking = f"no {'field' if inside else 'array'} '{key.name}' of texts or whole numbers"
        return _Refusal(f"{where} {lacking}", candidates)
    least, greatest = INTEGER_RANGES.get(str(found.base), (0, -1))
    if not (
        found.base in STRING_TYPES if isinstance(key.value, str) else least <= key.value <= greatest
    ):
        return _Refusal(f"'{key.name}' is a {found}, which is never {_value_text(key)}")
    return replace(here, type=kind.element)


def _field(
    store: InterfaceStore, here: ResolvedField, name: str, before: FieldPath
) -> ResolvedField | _Refusal:
    kind = here.type
    if kind.is_array:
        return _Refusal(
            f"{_named(here, before)} is an array: an index or a key is needed before '.{name}'"
        )
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
