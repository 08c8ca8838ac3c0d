"""The topics of the used systems: their types, publishers, subscriptions and units."""

from __future__ import annotations

from collections.abc import Iterable

from deros.models.rules import Rules
from deros.models.system import Subsystem, System
from deros.names.graph_names import resolve_name
from deros.systems.arguments.variants import Variants
from deros.systems.flat import FlatSystem
from deros.systems.flatten import flatten
from deros.systems.known_topics import KnownTopic, TopicTable

__all__ = ["KnownTopic", "SystemTopics", "declared_shared"]


class SystemTopics(TopicTable):
    """The topics of all used systems, by graph name.

    Of a system that is computed from arguments, that is its usual variant. A topic that is there in
    others only is known as it is in the first of them.

    Attributes:
        systems: the used systems, flattened.
        are_all: whether all of these systems, and all that they contain, could be loaded: then a
            topic that is not here is in none of them.
    """

    def __init__(self, systems: Iterable[System], complete: bool = True) -> None:
        """Flatten each system once, however often it is used."""
        once = {id(each): each for each in systems}.values()
        self.systems: list[FlatSystem] = [flatten(each) for each in once]
        self.are_all = complete and all(map(_is_whole, once))
        super().__init__(self.systems, self.are_all)
        for each in once:
            if each.is_computed:
                variants = Variants(each)
                for number in variants.numbers:
                    self.add_unknown(variants.flat(number))


def _is_whole(part: System | Subsystem) -> bool:
    """Return whether every system that a system uses as a subsystem could be loaded."""
    inner = (each for each in part.members if isinstance(each, Subsystem))
    return all(
        (each.system_name is None or each.system is not None)
        and (each.system is None or _is_whole(each.system))
        and _is_whole(each)
        for each in inner
    )


def declared_shared(rules: Rules, topics: TopicTable) -> frozenset[str]:
    """Return the topics of which an input, or a system, says that several nodes publish them."""
    inputs = {resolve_name(i.term.topic.text, "/") for i in rules.inputs if i.any_publishers}
    return frozenset(inputs | {each.name for each in topics if each.any_publishers})
