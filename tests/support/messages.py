"""Random messages, random paths into them, what is found there, and random types of messages."""

from __future__ import annotations

import importlib
import math
import random
import struct
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

from deros.interfaces.fields import FieldPath, Key, PathStep
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import (
    FLOAT_TYPES,
    INTEGER_RANGES,
    PRIMITIVES,
    STRING_TYPES,
    FieldType,
    InterfaceType,
    MessageDefinition,
)

STORE = InterfaceStore()

_TEXTS = ("", "a", "base_link", "odom \u00e9", "\u20ac\U0001f600", "x" * 300)
_LONGEST = 4


def message_class(kind: InterfaceType) -> type:
    """Return rclpy's class of a message type."""
    found: type = getattr(importlib.import_module(f"{kind.package}.msg"), kind.name)
    return found


def message_types(*packages: str) -> list[InterfaceType]:
    """Return all message types of some packages, in the order of their names."""
    return [
        InterfaceType(package, "msg", name)
        for package in packages
        for name in sorted(STORE.names(package, "msg"))
    ]


class Store(Protocol):
    """Whatever has definitions of messages."""

    def message(self, kind: InterfaceType) -> MessageDefinition | None:
        """Return the definition of a type."""


@dataclass(frozen=True)
class Messages:
    """Random messages of the types of a store.

    Attributes:
        store: where their definitions are.
        new: makes a message of a type, whose fields are then set.
    """

    store: Store = STORE
    new: Callable[[InterfaceType], Any] = lambda kind: message_class(kind)()

    def draw(self, kind: InterfaceType, rng: random.Random) -> Any:
        """Return a message with arbitrary values, and with arrays of up to four elements."""
        message = self.new(kind)
        for name, type_ in fields(self.store, kind):
            setattr(message, name, self._value(type_, rng))
        return message

    def _value(self, type_: FieldType, rng: random.Random) -> Any:
        if not type_.is_array:
            return self._element(type_, rng)
        longest = min(type_.size or _LONGEST, _LONGEST)
        length = type_.size if type_.array == "fixed" else rng.randint(0, longest)
        return [self._element(type_.element, rng) for _ in range(length or 0)]

    def _element(self, type_: FieldType, rng: random.Random) -> Any:
        base = type_.base
        if isinstance(base, InterfaceType):
            return self.draw(base, rng)
        if base == "byte":
            return bytes([rng.randrange(256)])
        if base in INTEGER_RANGES:
            return rng.choice((rng.randint(*INTEGER_RANGES[base]), 0, 1))
        if base in FLOAT_TYPES:
            special = (math.nan, math.inf, -math.inf, -0.0, float(rng.randint(-9, 9)))
            value = rng.choice((rng.uniform(-1e6, 1e6), *special))
            return value if base == "float64" else struct.unpack("f", struct.pack("f", value))[0]
        if base == "bool":
            return rng.random() < 0.5
        return rng.choice(_TEXTS)[: type_.string_bound]


def fields(store: Store, kind: InterfaceType) -> tuple[tuple[str, FieldType], ...]:
    """Return the fields of a type that there is."""
    definition = store.message(kind)
    assert definition is not None, kind
    return definition.fields


# Paths --------------------------------------------------------------------------------------------


def random_paths(
    store: Store, kind: InterfaceType, rng: random.Random, *, keys: bool = False
) -> list[FieldPath]:
    """Return up to five paths, each of a primitive or an array, some with ``keys``; maybe none."""
    drawn = (_random_path(store, kind, rng, keys) for _ in range(rng.randint(1, 5)))
    return list(dict.fromkeys(path for path in drawn if path is not None))


def _random_path(
    store: Store, kind: InterfaceType, rng: random.Random, with_keys: bool
) -> FieldPath | None:
    known = fields(store, kind)
    if not known:
        return None
    name, type_ = rng.choice(known)
    rest = _random_rest(store, kind, type_, rng, with_keys)
    return None if rest is None else (name, *rest)


def _random_rest(
    store: Store, kind: InterfaceType, type_: FieldType, rng: random.Random, with_keys: bool
) -> FieldPath | None:
    """Return the rest of a path behind a field of a message of type ``kind``."""
    if not type_.is_array:
        base = type_.base
        if not isinstance(base, InterfaceType):
            return ()
        return _random_path(store, base, rng, with_keys)
    if rng.random() < 0.3:
        return ()
    step: PathStep = rng.randrange(min(type_.size or _LONGEST, _LONGEST))
    keys = _keys(store, kind, type_) if with_keys else []
    if keys and rng.random() < 0.5:
        name, base = rng.choice(keys)
        least, greatest = INTEGER_RANGES.get(base, (0, 0))
        number = rng.choice((0, 1, least, greatest))
        step = Key(name, rng.choice(_TEXTS) if base in STRING_TYPES else number)
    rest = _random_rest(store, kind, type_.element, rng, with_keys)
    return None if rest is None else (step, *rest)


def _keys(store: Store, kind: InterfaceType, array: FieldType) -> list[tuple[str, str]]:
    """Return what names the elements of an array of a message, with its primitive."""
    inside = isinstance(array.base, InterfaceType)
    known = fields(store, array.base if isinstance(array.base, InterfaceType) else kind)
    fit = STRING_TYPES | set(INTEGER_RANGES)
    return [
        (name, str(each.base))
        for name, each in known
        if each.is_array is not inside and each.base in fit
    ]


def read(store: Store, message: Any, kind: InterfaceType, path: FieldPath) -> Any:
    """Return what a message has at a path, in the terms of rules.

    That is a number, a boolean, a text, a list of them, or the number of messages of an array; NaN
    for an element that is not there.
    """
    here, type_, around = message, FieldType(kind), message
    for step in path:
        if isinstance(step, str):
            assert isinstance(type_.base, InterfaceType)
            type_ = dict(fields(store, type_.base))[step]
            around, here = here, getattr(here, step)
            continue
        index = step
        if isinstance(index, Key):
            index = _place(around, here, type_, index)
        if index >= len(here):
            return math.nan
        type_, here = type_.element, here[index]
    if not type_.is_array:
        return _plain(here, type_)
    if isinstance(type_.base, InterfaceType):
        return len(here)
    return [_plain(each, type_) for each in here]


def _place(around: Any, array: Any, type_: FieldType, key: Key) -> int:
    """Return the index of the element of an array with a key; its length for none."""
    if isinstance(type_.base, InterfaceType):
        called = [getattr(each, key.name) for each in array]
    else:
        called = list(getattr(around, key.name))
    names = [each[0] if isinstance(each, bytes) else each for each in called]
    return names.index(key.value) if key.value in names else len(array)


def _plain(value: Any, type_: FieldType) -> Any:
    if type_.base == "byte":
        return value[0]
    if type_.base in FLOAT_TYPES:
        return float(value)
    return int(value) if type_.base in INTEGER_RANGES else value


# Definitions --------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Definitions:
    """Message types made up for a test, the last of which may hold all others."""

    definitions: dict[InterfaceType, MessageDefinition]

    @classmethod
    def draw(cls, rng: random.Random) -> Definitions:
        """Return one to four types with arbitrary fields."""
        made: dict[InterfaceType, MessageDefinition] = {}
        for number in range(rng.randint(1, 4)):
            kind = InterfaceType("made_up", "msg", f"Type{number}")
            drawn = ((f"field_{n}", _field_type(list(made), rng)) for n in range(rng.randint(0, 5)))
            made[kind] = MessageDefinition(kind, tuple(drawn))
        return cls(made)

    @property
    def last(self) -> InterfaceType:
        """The type that was made last."""
        return list(self.definitions)[-1]

    def message(self, kind: InterfaceType) -> MessageDefinition | None:
        """Return a definition, as an InterfaceStore does."""
        return self.definitions.get(kind)


def _field_type(known: list[InterfaceType], rng: random.Random) -> FieldType:
    # Primitives of all sizes are as likely as messages, so that alignment varies.
    bases: list[str | InterfaceType] = [*known, *known, *rng.sample(sorted(PRIMITIVES), 4)]
    base = rng.choice(bases)
    size = rng.choice((1, 2, 3, 5, 70 if base in PRIMITIVES else 2))
    types = FieldType(base), FieldType(base, "unbounded"), FieldType(base, "bounded", size)
    return rng.choice((*types, FieldType(base), FieldType(base, "fixed", size)))
