"""Topics that a topic without an end was probably meant to be."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from itertools import chain
from typing import TYPE_CHECKING, Generic, Protocol, TypeVar

from deros.names.topic_likeness import LikelyTopics

if TYPE_CHECKING:
    from deros.interfaces.types import InterfaceType
    from deros.systems.flat import FlatNode
    from deros.validators.wiring.graph import End

_ONE_SIDED = 0.05
"""What it adds to a likeness that the other topic lacks just the end that is there too many."""


class Topic(Protocol):
    """The interface of a topic."""

    @property
    def name(self) -> str:
        """Its graph name."""

    @property
    def type(self) -> InterfaceType:
        """Its type."""

    @property
    def sources(self) -> Sequence[End]:
        """Its publishers."""

    @property
    def sinks(self) -> Sequence[End]:
        """Its subscriptions."""


T = TypeVar("T", bound=Topic)


class Robots:
    """The repeated parts of a system, each in its own namespace.

    Nodes of one type and one name that stand in several namespaces make these repetitions of each
    other: of ``/left/arm/elbow`` and ``/right/arm/elbow``, they are ``/left`` and ``/right``.
    """

    def __init__(self, nodes: Iterable[FlatNode]) -> None:
        """Find the namespaces that repeat each other; linear in the number of nodes."""
        places: dict[tuple[str, str], set[tuple[str, ...]]] = defaultdict(set)
        for node in nodes:
            namespace = tuple(node.namespace.strip("/").split("/"))
            places[node.instance.type_name, node.instance.name].add(namespace)
        self._roots: set[str] = set()
        for alike in places.values():
            if len(alike) > 1:
                self._add(alike)

    def _add(self, namespaces: Iterable[tuple[str, ...]]) -> None:
        """Note the parts up to the first in which the namespaces differ."""
        for depth, parts in enumerate(zip(*namespaces, strict=False), start=1):
            if len(set(parts)) > 1:
                self._roots.update("/" + "/".join(each[:depth]) for each in namespaces)
                return

    def of(self, name: str) -> str | None:
        """Return the repeated part that a node or a topic belongs to, or ``None``."""
        if not self._roots:
            return None
        end = name.find("/", 1)
        while end != -1:
            if name[:end] in self._roots:
                return name[:end]
            end = name.find("/", end + 1)
        return None

    def are_apart(self, first: str, second: str) -> bool:
        """Return whether two full names belong to two different parts."""
        one, other = self.of(first), self.of(second)
        return one is not None and other is not None and one != other


class Partners(Generic[T]):
    """The topics of a system, to find those that one of them was probably meant to be.

    A partner has the same type. It joins two different nodes, and not those of two repeated parts.
    """

    def __init__(self, topics: Iterable[T], robots: Robots) -> None:
        """Hold the topics."""
        self._robots = robots
        self._fed: dict[InterfaceType, dict[str, T]] = defaultdict(dict)
        self._read: dict[InterfaceType, dict[str, T]] = defaultdict(dict)
        for topic in topics:
            if topic.sources:
                self._fed[topic.type][topic.name] = topic
            if topic.sinks:
                self._read[topic.type][topic.name] = topic
        self._likely: dict[tuple[InterfaceType, bool], LikelyTopics] = {}

    def fed_for(self, read: T, allow: Callable[[T], bool]) -> list[T]:
        """Return up to three published topics that a subscribed one was meant to be, best first."""
        candidates = self._fed.get(read.type, {})

        def rank(name: str) -> float | None:
            fed = candidates[name]
            if not self.can_join(fed, read) or not allow(fed):
                return None
            return 0.0 if fed.sinks else _ONE_SIDED

        return [candidates[name] for name in self._best(read, True, candidates, rank)]

    def read_for(self, fed: T, allow: Callable[[T], bool]) -> list[T]:
        """Return up to three subscribed topics that a published one was meant to be, best first."""
        candidates = self._read.get(fed.type, {})

        def rank(name: str) -> float | None:
            read = candidates[name]
            if not self.can_join(fed, read) or not allow(read):
                return None
            return 0.0 if read.sources else _ONE_SIDED

        return [candidates[name] for name in self._best(fed, False, candidates, rank)]

    def can_join(self, fed: T, read: T) -> bool:
        """Return whether one topic in the place of two would join nodes that belong together."""
        name = fed.sources[0].node.full_name
        is_one = all(end.node.full_name == name for end in chain(fed.sources, read.sinks))
        if is_one or self._robots.are_apart(fed.name, read.name):
            return False
        return any(
            not self._robots.are_apart(source.node.full_name, sink.node.full_name)
            for source in fed.sources[:3]
            for sink in read.sinks[:3]
        )

    def _best(
        self,
        topic: T,
        fed: bool,
        candidates: dict[str, T],
        rank: Callable[[str], float | None],
    ) -> list[str]:
        key = (topic.type, fed)
        if key not in self._likely:
            self._likely[key] = LikelyTopics(candidates)
        return self._likely[key].best(topic.name, rank)
