"""Topics with ends in every ROS 2 system: transforms, time, logs, tools.

``standard_topics.json`` holds them as data, each with the reason why nothing is said to be missing
there: its other end is in libraries, tools or an operator's hands, and not in a system description.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, lru_cache
from pathlib import Path
from typing import Any, NamedTuple

from deros.interfaces.types import InterfaceType


@dataclass(frozen=True, slots=True)
class StandardTopic:
    """An entry of the table.

    Attributes:
        name: its graph name; with ``anywhere``, the end of it in every namespace. For a topic that
            is derived from another one, what it has behind the other's name.
        types: the types that it has, as ``package/Type``; none where these differ.
        why: whom it is for.
        anywhere: whether it is there in every namespace.
        fixed: whether client libraries or tools rely on the type.
        of: the type of the topic that it is derived from.
    """

    name: str
    types: frozenset[str]
    why: str
    anywhere: bool = False
    fixed: bool = False
    of: str = ""

    def has(self, kind: InterfaceType | None) -> bool:
        """Return whether the topic may have a type; an unknown type is accepted."""
        return kind is None or not self.types or _text(kind) in self.types


TypeOf = Callable[[str], InterfaceType | None]
"""Returns the type of a topic, or ``None`` if it is unknown or there is no such topic."""


def standard_topic(name: str, kind: InterfaceType | None) -> StandardTopic | None:
    """Return the entry of a topic that has ends outside every model, or ``None``.

    One of another type than the entry's is something else of the same name.
    """
    for entry in _entries(name):
        if entry.has(kind) and (kind is not None or not entry.of):
            return entry
    return None


def is_shown_only(kind: InterfaceType) -> bool:
    """Return whether messages of a type are for tools, so that no subscription is missing."""
    return _text(kind) in _table().shown


def is_operated(kind: InterfaceType) -> bool:
    """Return whether messages of a type come from an operator, so that no publisher is missing."""
    return _text(kind) in _table().operated


def has_topic_of_its_own(kind: InterfaceType) -> bool:
    """Return whether messages of a type are for one standard topic, as transforms are."""
    return _text(kind) in _table().fixed


def wrong_type(name: str, kind: InterfaceType, type_of: TypeOf) -> StandardTopic | None:
    """Return the entry of a topic that has another type than it has everywhere else, or ``None``.

    A topic in a namespace may be private, and so may a derived one without its origin.
    """
    for entry in _entries(name):
        if entry.of:
            origin = type_of(name.removesuffix(entry.name))
            applies = origin is not None and _text(origin) == entry.of
        else:
            applies = name == entry.name
        if applies and not entry.has(kind):
            return entry
    return None


@lru_cache(maxsize=1 << 14)
def _entries(name: str) -> tuple[StandardTopic, ...]:
    table = _table()
    found = []
    if (entry := table.named.get(name)) is not None:
        found.append(entry)
    for depth in (1, 2):
        parts = name.rsplit("/", depth)
        if len(parts) > depth and parts[0]:
            entry = table.named.get("/" + "/".join(parts[1:]))
            if entry is not None and entry.anywhere:
                found.append(entry)
    found += (each for each in table.derived if name.endswith(each.name))
    return tuple(found)


def _text(kind: InterfaceType) -> str:
    return f"{kind.package}/{kind.name}"


class _Table(NamedTuple):
    """The table of standard topics.

    Attributes:
        named: the topics by their names.
        derived: those whose names are made of another topic's.
        shown: the types that are for tools alone.
        operated: the types that come from an operator.
        fixed: the types that have one topic each.
    """

    named: dict[str, StandardTopic]
    derived: tuple[StandardTopic, ...]
    shown: frozenset[str]
    operated: frozenset[str]
    fixed: frozenset[str]


@cache
def _table() -> _Table:
    path = Path(__file__).with_name("standard_topics.json")
    table: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    named = [
        StandardTopic(
            each["name"],
            frozenset(each["types"]),
            each["why"],
            each.get("anywhere", False),
            each.get("fixed", False),
        )
        for each in table["topics"]
    ]
    derived = tuple(
        StandardTopic(each["ending"], frozenset(each["types"]), each["why"], of=each["of"])
        for each in table["derived"]
    )
    return _Table(
        {each.name: each for each in named},
        derived,
        shown=frozenset(table["shown"]["types"]),
        operated=frozenset(table["operated"]["types"]),
        fixed=frozenset(kind for each in named if each.fixed for kind in each.types),
    )
