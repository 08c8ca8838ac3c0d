"""The wiring of a system as a networkx graph: nodes, channels and the types of their ends.

The graph is a plain :class:`networkx.MultiDiGraph`, so that all of networkx works on it::

    flat = flatten(system)
    graph = wiring_graph(flat)
    networkx.descendants(graph, node_vertex("/sensors/imu"))

**Vertices** are pairs ``(kind, full name)``; the kind is ``"node"``, ``"topic"``, ``"service"`` or
``"action"``, so that a node and a topic of one name stay apart. Their attributes:

======= =========== ===============================================================================
kind    attribute   meaning
======= =========== ===============================================================================
node    ``node``    the :class:`~deros.systems.flatten.FlatNode`
topic   ``topic``   its first declaration, a :class:`~deros.systems.flatten.FlatTopic`;
                    ``None`` when no ``topics`` section declares it
topic   ``untyped`` a tuple of :class:`UntypedEnd`: wirings through a parameter that no port claims;
                    neither type nor direction of such an end is known, so it is no edge
======= =========== ===============================================================================

**Edges** run the way the data (or the request) flows: publisher to topic, topic to subscription,
client to service, service to server. Their attributes:

========= =========================================================================================
``end``   the :class:`End`: the node and its port
``port``  the port's name as its node description has it
``type``  the port's :class:`~deros.interfaces.types.InterfaceType`
``wired`` ``False`` for a port that is not connected: it talks on its own name all the same
========= =========================================================================================
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import networkx as nx

from deros.models.node import PortKind
from deros.models.qos import overridden, overridden_policy
from deros.systems.safety_nodes import is_gate_node

if TYPE_CHECKING:
    from deros.diagnostics import Span
    from deros.interfaces.types import InterfaceType
    from deros.models.common import QosProfile
    from deros.models.system import ParameterSetting
    from deros.systems.flat import FlatNode, FlatPort, FlatSystem, UntypedWiring

VertexKind = Literal["node", "topic", "service", "action"]
Vertex = tuple[VertexKind, str]

CHANNEL: dict[PortKind, VertexKind] = {
    PortKind.PUBLISHER: "topic",
    PortKind.SUBSCRIPTION: "topic",
    PortKind.CLIENT: "service",
    PortKind.SERVICE: "service",
    PortKind.ACTION_CLIENT: "action",
    PortKind.ACTION: "action",
}
"""The kind of vertex that a port of each kind is connected to."""

_OVERRIDDEN = {PortKind.PUBLISHER: "publisher", PortKind.SUBSCRIPTION: "subscription"}
"""How the parameters of ROS 2 that override a QoS name a port's kind."""

SOURCES = frozenset({PortKind.PUBLISHER, PortKind.CLIENT, PortKind.ACTION_CLIENT})
"""The kinds of port whose edge leaves the node."""


@dataclass(frozen=True, slots=True)
class End:
    """One end of a channel: a port of a node of the running system."""

    node: FlatNode
    port: FlatPort

    @property
    def type(self) -> InterfaceType:
        """The type that the node description gives the port."""
        return self.port.port.type

    @property
    def wired(self) -> bool:
        """Whether the system connects the port: by a ``connect``, or in the list of its topics."""
        return self.port.wiring is not None or self.listing is not None

    @property
    def listing(self) -> ParameterSetting | None:
        """Where the system names the port's topic, if the port is one of several of a list."""
        if self.port.entry is None:
            return None
        settings = self.node.instance.parameters
        return next((each for each in settings if each.name == self.port.named_by), None)

    @property
    def span(self) -> Span:
        """Where the system connects the port, or the node's name where it does not."""
        wiring = self.port.wiring or self.listing
        return wiring.span if wiring is not None else self.node.instance.name_span

    @property
    def name(self) -> str:
        """Node and port for messages, as ``/base/odometry (odom)``.

        Where the node has ports of several kinds of that name, the kind is said, too.
        """
        port = self.port.port
        alike = {other.port.kind for other in self.node.ports if other.port.name == port.name}
        kind = f"{port.kind.word} " if len(alike) > 1 else ""
        return f"{self.node.full_name} ({kind}{port.name})"

    @property
    def qos(self) -> QosProfile | None:
        """The QoS that the node description states, as the system overrides it for a program."""
        overrides = self._overrides()
        stated = self.port.port.qos
        if not overrides:
            return stated
        return overridden(stated, {policy: each.value for policy, each in overrides.items()})

    @property
    def qos_span(self) -> Span:
        """Where the QoS is overridden, else where it is stated, else where the port is declared."""
        for setting in self._overrides().values():
            return setting.span
        qos = self.port.port.qos
        return qos.span if qos is not None and qos.span is not None else self.port.port.span

    @property
    def is_assumed(self) -> bool:
        """Whether the QoS is only assumed, because the description of a program states none."""
        return self.port.port.qos is None and self._is_program

    @property
    def _is_program(self) -> bool:
        return self.node.type is not None and self.node.type.executable is not None

    def _overrides(self) -> dict[str, ParameterSetting]:
        """Return the settings that change the QoS of a program's end; generated nodes read none."""
        entity = _OVERRIDDEN.get(self.port.port.kind)
        settings = self.node.instance.parameters
        if entity is None or not settings or not self._is_program:
            return {}
        found = ((overridden_policy(s.name, self.port.topic, entity), s) for s in settings)
        return {policy: setting for policy, setting in found if policy is not None}


@dataclass(frozen=True, slots=True)
class UntypedEnd:
    """A wiring through a string parameter that no port claims, with the node that it belongs to."""

    node: FlatNode
    wiring: UntypedWiring


def node_vertex(full_name: str) -> Vertex:
    """Return the vertex of the node called ``full_name``."""
    return ("node", full_name)


def topic_vertex(name: str) -> Vertex:
    """Return the vertex of the topic with the graph name ``name``."""
    return ("topic", name)


def wiring_graph(flat: FlatSystem) -> nx.MultiDiGraph[Vertex]:
    """Build the graph of a system in time linear in its size; see the module for what it holds.

    Two nodes of one full name, which a check reports, share a vertex; their edges stay apart.
    """
    graph: nx.MultiDiGraph[Vertex] = nx.MultiDiGraph()
    for topic in flat.topics:
        vertex = topic_vertex(topic.name)
        if vertex not in graph:
            graph.add_node(vertex, topic=topic, untyped=())
    for node in flat.nodes:
        here = node_vertex(node.full_name)
        if here not in graph:
            graph.add_node(here, node=node)
        for port in node.ports:
            _connect(graph, here, End(node, port))
        for wiring in node.untyped:
            vertex = topic_vertex(wiring.topic)
            if vertex not in graph:
                graph.add_node(vertex, topic=None, untyped=())
            graph.nodes[vertex]["untyped"] += (UntypedEnd(node, wiring),)
    return graph


def _connect(graph: nx.MultiDiGraph[Vertex], here: Vertex, end: End) -> None:
    port = end.port.port
    channel: Vertex = (CHANNEL[port.kind], end.port.topic)
    if channel not in graph:
        if channel[0] == "topic":
            graph.add_node(channel, topic=None, untyped=())
        else:
            graph.add_node(channel)
    source, target = (here, channel) if port.kind in SOURCES else (channel, here)
    graph.add_edge(source, target, end=end, port=port.name, type=port.type, wired=end.wired)


def is_one_gate(node: FlatNode, other: FlatNode) -> bool:
    """Return whether two nodes are gates of one ``safety`` statement to one topic.

    The rules declare a gate to it twice, which is reported there.
    """
    if node.statement is None or node.statement is not other.statement:
        return False
    if node.path != other.path:  # of a system that is used twice
        return False
    return not _targets(node).isdisjoint(_targets(other))


def _targets(node: FlatNode) -> set[str]:
    """Return the topic that a gate publishes commands on; nothing for any other node."""
    ends = node.ports if node.type is not None else ()
    return {
        end.topic
        for end in ends
        if end.port.kind is PortKind.PUBLISHER
        and node.type is not None
        and is_gate_node(node.type.name, end.port.name)
    }


def channels(graph: nx.MultiDiGraph[Vertex]) -> Iterator[Vertex]:
    """Yield the topics, services and actions: declared topics first, in the order written."""
    return (vertex for vertex in graph if vertex[0] != "node")


def publishers(graph: nx.MultiDiGraph[Vertex], channel: Vertex) -> list[End]:
    """Return the ends that feed ``channel``: publishers of a topic, clients of a service."""
    return [edge["end"] for edges in graph.pred[channel].values() for edge in edges.values()]


def subscribers(graph: nx.MultiDiGraph[Vertex], channel: Vertex) -> list[End]:
    """Return the ends that ``channel`` feeds: subscriptions of a topic, servers of a service."""
    return [edge["end"] for edges in graph.succ[channel].values() for edge in edges.values()]
