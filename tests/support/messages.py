"""Random messages of rclpy, random paths into them, and what is found there."""

from __future__ import annotations

import importlib
import math
import random
import struct
from functools import cache
from typing import Any

from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import FLOAT_TYPES, INTEGER_RANGES, FieldType, InterfaceType

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


# Messages -----------------------------------------------------------------------------------------


def random_message(kind: InterfaceType, rng: random.Random) -> Any:
    """Return a message with arbitrary values, and with arrays of up to four elements."""
    message = message_class(kind)()
    for name, type_ in _fields(kind):
        setattr(message, name, _value(type_, rng))
    return message


def _value(type_: FieldType, rng: random.Random) -> Any:
    if not type_.is_array:
        return _element(type_, rng)
    longest = min(type_.size or _LONGEST, _LONGEST)
    length = type_.size if type_.array == "fixed" else rng.randint(0, longest)
    return [_element(type_.element, rng) for _ in range(length or 0)]


def _element(type_: FieldType, rng: random.Random) -> Any:
    base = type_.base
    if isinstance(base, InterfaceType):
        return random_message(base, rng)
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


@cache
def _fields(kind: InterfaceType) -> tuple[tuple[str, FieldType], ...]:
    definition = STORE.message(kind)
    assert definition is not None, kind
    return definition.fields


# Paths --------------------------------------------------------------------------------------------


def random_path(kind: InterfaceType, rng: random.Random) -> Path | None:
    """Return the path of a primitive or an array, or ``None`` for a message without fields."""
    if not _fields(kind):
        return None
    name, type_ = rng.choice(_fields(kind))
    rest = _random_rest(type_, rng)
    return None if rest is None else (name, *rest)


def _random_rest(type_: FieldType, rng: random.Random) -> Path | None:
    if not type_.is_array:
        return random_path(type_.base, rng) if isinstance(type_.base, InterfaceType) else ()
    if rng.random() < 0.3:
        return ()
    index = rng.randrange(min(type_.size or _LONGEST, _LONGEST))
    rest = _random_rest(type_.element, rng)
    return None if rest is None else (index, *rest)


def read(message: Any, kind: InterfaceType, path: Path) -> Any:
    """Return what a message of rclpy has at a path, in the terms of rules.

    That is a number, a boolean, a text, a list of them, or the number of messages of an array; NaN
    for an element that is not there.
    """
    here, type_ = message, FieldType(kind)
    for step in path:
        if isinstance(step, str):
            assert isinstance(type_.base, InterfaceType)
            type_ = dict(_fields(type_.base))[step]
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
