"""The topics of the used systems: their types, publishers, subscriptions and units."""

from __future__ import annotations

from collections.abc import Iterable

from deros.models.rules import Rules
from deros.models.system import System
from deros.names.graph_names import resolve_name
from deros.systems.flat import FlatSystem
from deros.systems.flatten import flatten
from deros.systems.known_topics import KnownTopic, TopicTable
from deros.systems.variants import Variants

__all__ = ["KnownTopic", "SystemTopics", "declared_shared"]


class SystemTopics(TopicTable):
    """The topics of all used systems, by graph name; ``systems`` are those, flattened.

    Of a system that is computed from arguments, that is its usual variant. A topic that is there in
    others only is known as it is in the first of them.
    """

    def __init__(self, systems: Iterable[System], complete: bool = True) -> None:
        """Flatten each system once, however often it is used."""
        once = {id(each): each for each in systems}.values()
        self.systems: list[FlatSystem] = [flatten(each) for each in once]
        super().__init__(self.systems, complete)
        for each in once:
            if each.is_computed:
                variants = Variants(each)
                for number in variants.numbers:
                    self.add_unknown(variants.flat(number))


def declared_shared(rules: Rules, topics: TopicTable) -> frozenset[str]:
    """Return the topics of which an input, or a system, says that several nodes publish them."""
    inputs = {resolve_name(i.term.topic.text, "/") for i in rules.inputs if i.any_publishers}
    return frozenset(inputs | {each.name for each in topics if each.any_publishers})
