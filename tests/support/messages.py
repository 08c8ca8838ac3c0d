"""Random messages, random paths into them, what is found there, and random types of messages."""

from __future__ import annotations

import importlib
import math
import random
import struct
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import (
    FLOAT_TYPES,
    INTEGER_RANGES,
    PRIMITIVES,
    FieldType,
    InterfaceType,
    MessageDefinition,
)

Path = tuple[str | int, ...]

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
            return rng.randint(*INTEGER_RANGES[base])
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


def random_paths(store: Store, kind: InterfaceType, rng: random.Random) -> list[Path]:
    """Return up to five paths, each of a primitive or an array; maybe none."""
    drawn = (_random_path(store, kind, rng) for _ in range(rng.randint(1, 5)))
    return list(dict.fromkeys(path for path in drawn if path is not None))


def _random_path(store: Store, kind: InterfaceType, rng: random.Random) -> Path | None:
    known = fields(store, kind)
    if not known:
        return None
    name, type_ = rng.choice(known)
    rest = _random_rest(store, type_, rng)
    return None if rest is None else (name, *rest)


def _random_rest(store: Store, type_: FieldType, rng: random.Random) -> Path | None:
    if not type_.is_array:
        base = type_.base
        return _random_path(store, base, rng) if isinstance(base, InterfaceType) else ()
    if rng.random() < 0.3:
        return ()
    index = rng.randrange(min(type_.size or _LONGEST, _LONGEST))
    rest = _random_rest(store, type_.element, rng)
    return None if rest is None else (index, *rest)


def read(store: Store, message: Any, kind: InterfaceType, path: Path) -> Any:
    """Return what a message has at a path, in the terms of rules.

    That is a number, a boolean, a text, a list of them, or the number of messages of an array; NaN
    for an element that is not there.
    """
    here, type_ = message, FieldType(kind)
    for step in path:
        if isinstance(step, str):
            assert isinstance(type_.base, InterfaceType)
            type_ = dict(fields(store, type_.base))[step]
            here = getattr(here, step)
        elif step < len(here):
            type_, here = type_.element, here[step]
        else:
            return math.nan
    if not type_.is_array:
        return _plain(here, type_)
    if isinstance(type_.base, InterfaceType):
        return len(here)
    return [_plain(each, type_) for each in here]


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
