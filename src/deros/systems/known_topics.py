"""Topics of the used systems: their type, ends, units and QoS."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from deros.diagnostics import Span
from deros.interfaces.fields import FieldPath, without_indices
from deros.interfaces.standard_topics import standard_topic
from deros.interfaces.types import InterfaceType
from deros.models.node import FieldUnit, PortKind
from deros.systems.flat import FlatPort, FlatSystem, FlatTopic, UntypedWiring
from deros.systems.safety_qos import Offers


@dataclass(slots=True)
class KnownTopic:
    """One topic of the used systems.

    Attributes:
        name: its graph name.
        declarations: where the systems declare it.
        publishers: the ports that publish on it.
        subscriptions: the ports that subscribe to it.
        untyped: the wirings to it through parameters that no port claims: their type, and whether
            the node publishes or subscribes, is not known.
        types: the types that the used systems give it, each with the place of the first to do so.
    """

    name: str
    declarations: list[FlatTopic] = field(default_factory=list)
    publishers: list[FlatPort] = field(default_factory=list)
    subscriptions: list[FlatPort] = field(default_factory=list)
    untyped: list[UntypedWiring] = field(default_factory=list)
    types: dict[InterfaceType, Span] = field(default_factory=dict)

    @property
    def external(self) -> bool:
        """Whether the topic has ends outside the model, or in libraries and tools."""
        if any(each.declaration.external for each in self.declarations):
            return True
        return standard_topic(self.name, self.type) is not None

    @property
    def any_publishers(self) -> bool:
        """Whether a system says that several nodes are meant to publish it."""
        return any(each.declaration.any_publishers for each in self.declarations)

    @property
    def offers(self) -> Offers:
        """The QoS that publishers offer: stated, and pinned by the first declaration with a QoS."""
        pins = (each.declaration.qos for each in self.declarations)
        return Offers(
            [each.port.qos for each in self.publishers],
            next((qos for qos in pins if qos is not None), None),
            self.external or bool(self.untyped),
        )

    @property
    def type(self) -> InterfaceType | None:
        """The pinned type, else the publishers', else the subscriptions', else ``None``."""
        pinned = (each.declaration.type for each in self.declarations)
        ends = (flat.port.type for flat in (*self.publishers, *self.subscriptions))
        return next((kind for kind in (*pinned, *ends) if kind is not None), None)

    @property
    def place(self) -> Span:
        """The first mention of the topic in the systems."""
        if self.declarations:
            return self.declarations[0].declaration.name_span
        for flat in (*self.publishers, *self.subscriptions):
            return flat.wiring.target_span if flat.wiring else flat.port.name_span
        return self.untyped[0].wiring.target_span

    def unit_of(self, path: FieldPath) -> str | None:
        """Return the unit that the systems and their nodes declare for a field, or ``None``."""
        return next((each.unit for each in self._declared(path)), None)

    def is_wrapping(self, path: FieldPath) -> bool:
        """Return whether a field is declared as wrapping."""
        return any(each.wrapping for each in self._declared(path))

    def _declared(self, path: FieldPath) -> Iterator[FieldUnit]:
        """Yield what is declared for a field: of the topic, by publishers, by subscriptions."""
        wanted = without_indices(path)
        ports = (flat.port.units for flat in (*self.publishers, *self.subscriptions))
        topics = (each.declaration.units for each in self.declarations)
        for units in (*topics, *ports):
            yield from (each for each in units if each.field_path == wanted)


class TopicTable:
    """The topics of several systems, by graph name.

    ``complete`` is false when a system or a part of one could not be loaded, so that a topic which
    seems to lack something may well have it.
    """

    def __init__(self, systems: Iterable[FlatSystem], complete: bool = True) -> None:
        """Collect the topics of all systems."""
        self.complete = complete
        self._topics: dict[str, KnownTopic] = {}
        for system in systems:
            self._add(system)

    def get(self, name: str) -> KnownTopic | None:
        """Return the topic with the graph name ``name``, or ``None``."""
        return self._topics.get(name)

    def offers(self, name: str) -> Offers:
        """Return what the publishers of the topic with the graph name ``name`` offer."""
        known = self.get(name)
        return known.offers if known is not None else Offers()

    @property
    def names(self) -> Iterable[str]:
        """All graph names, in the order of their first mention."""
        return self._topics.keys()

    def __iter__(self) -> Iterator[KnownTopic]:
        """Yield all topics, in the order of their first mention."""
        return iter(self._topics.values())

    def add_unknown(self, system: FlatSystem) -> None:
        """Take over the topics of a system that have not been known before."""
        for topic in self._topics_of(system):
            if topic.name not in self._topics:
                self._topics[topic.name] = topic
                if topic.type is not None:
                    topic.types.setdefault(topic.type, topic.place)

    def _add(self, system: FlatSystem) -> None:
        for own in self._topics_of(system):
            known = self._topics.setdefault(own.name, KnownTopic(own.name))
            known.declarations += own.declarations
            known.publishers += own.publishers
            known.subscriptions += own.subscriptions
            known.untyped += own.untyped
            if own.type is not None:
                known.types.setdefault(own.type, own.place)

    def _topics_of(self, flat: FlatSystem) -> Iterable[KnownTopic]:
        found: dict[str, KnownTopic] = {}

        def topic(name: str) -> KnownTopic:
            return found.setdefault(name, KnownTopic(name))

        for declared in flat.topics:
            topic(declared.name).declarations.append(declared)
        for node in flat.nodes:
            self.complete &= node.type is not None
            for port in node.ports:
                if port.port.kind is PortKind.PUBLISHER:
                    topic(port.topic).publishers.append(port)
                elif port.port.kind is PortKind.SUBSCRIPTION:
                    topic(port.topic).subscriptions.append(port)
            for untyped in node.untyped:
                topic(untyped.topic).untyped.append(untyped)
        return found.values()
