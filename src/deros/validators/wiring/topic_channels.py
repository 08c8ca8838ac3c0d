"""Topics, services and actions with their ends."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from deros.diagnostics import Span
from deros.interfaces.standard_topics import standard_topic
from deros.models.system import Topic
from deros.names.graph_names import resolve_name
from deros.systems.flat import FlatSystem, FlatTopic
from deros.validators.wiring.graph import End, Vertex, publishers, subscribers

if TYPE_CHECKING:
    import networkx as nx

    from deros.interfaces.types import InterfaceType


@dataclass(frozen=True, slots=True)
class Channel:
    """A topic, service or action with its ends; ``open`` when the model cannot know them all.

    ``pin`` is the outermost declaration that gives the topic a type.
    """

    vertex: Vertex
    declared: FlatTopic | None
    pin: Topic | None
    sources: list[End]
    sinks: list[End]
    open: bool

    @property
    def name(self) -> str:
        """Its graph name."""
        return self.vertex[1]

    @property
    def type(self) -> InterfaceType:
        """The type of the first end; only for channels that have one."""
        return (self.sources or self.sinks)[0].type

    @property
    def known_type(self) -> InterfaceType | None:
        """The pinned type, else that of the first end; ``None`` for a topic without either."""
        if self.pin is not None:
            return self.pin.type
        return self.type if self.sources or self.sinks else None

    @property
    def undeclared(self) -> bool:
        """Whether a wiring names an undeclared topic, which is a separate finding."""
        return self.declared is None and any(end.wired for end in (*self.sources, *self.sinks))

    @property
    def span(self) -> Span:
        """Where it is declared, else its first connection."""
        if self.declared is not None:
            return self.declared.declaration.name_span
        return (self.sources or self.sinks)[0].span


def channel_of(
    graph: nx.MultiDiGraph[Vertex], vertex: Vertex, guessed: set[str], pins: Mapping[str, Topic]
) -> Channel:
    """Return the channel of a vertex.

    Args:
        graph: the wiring.
        vertex: a topic, service or action.
        guessed: the topics whose ends are not all known.
        pins: the declarations that give topics their types.
    """
    attributes = graph.nodes[vertex]
    declared: FlatTopic | None = attributes.get("topic")
    if vertex[0] != "topic":
        # A service has no declaration; an external topic of its name counts as one.
        declared = graph.nodes.get(("topic", vertex[1]), {}).get("topic")
    sources, sinks = publishers(graph, vertex), subscribers(graph, vertex)
    pin = pins.get(vertex[1]) if vertex[0] == "topic" else None
    is_open = (
        (declared is not None and declared.declaration.external)
        or bool(attributes.get("untyped"))
        or vertex[1] in guessed
        or (vertex[0] == "topic" and _is_standard(vertex[1], pin, [*sources, *sinks]))
    )
    return Channel(vertex, declared, pin, sources, sinks, is_open)


def pinned_types(flat: FlatSystem) -> dict[str, Topic]:
    """Return the declaration that gives each topic its type: the first, which is the outermost."""
    pins: dict[str, Topic] = {}
    for topic in flat.topics:
        if topic.declaration.type is not None:
            pins.setdefault(topic.name, topic.declaration)
    return pins


def _is_standard(name: str, pin: Topic | None, ends: list[End]) -> bool:
    """Return whether a topic has ends in libraries, tools or operators, outside any model."""
    kind = pin.type if pin is not None else None
    if kind is None and ends:
        kind = ends[0].type
    return standard_topic(name, kind) is not None


def targets_of_unknown_ports(flat: FlatSystem) -> set[str]:
    """Return the topics wired to ports that are not known, which other findings report.

    Whether such a port publishes or subscribes is unknown, so nothing is reported missing there.
    """
    targets: set[str] = set()
    for node in flat.nodes:
        known = {id(port.wiring) for port in node.ports}
        for wiring in node.instance.wirings:
            if id(wiring) not in known:
                targets.add(resolve_name(wiring.target, node.namespace, node.instance.name))
    return targets
