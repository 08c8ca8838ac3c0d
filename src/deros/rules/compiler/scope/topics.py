"""The topics of the used systems: their types, publishers, subscriptions and units."""

from __future__ import annotations

from collections.abc import Iterable

from deros.models.system import System
from deros.systems.flat import FlatSystem
from deros.systems.flatten import flatten
from deros.systems.known_topics import KnownTopic, TopicTable

__all__ = ["KnownTopic", "SystemTopics"]


class SystemTopics(TopicTable):
    """The topics of all used systems, by graph name; ``systems`` are those, flattened."""

    def __init__(self, systems: Iterable[System], complete: bool = True) -> None:
        """Flatten each system once, however often it is used."""
        once = {id(each): each for each in systems}.values()
        self.systems: list[FlatSystem] = [flatten(each) for each in once]
        super().__init__(self.systems, complete)
