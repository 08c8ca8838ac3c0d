"""What a system amounts to at run time: every node by its full name, every topic by its graph name.

Names resolve as ROS 2 resolves them (ROS 2 design, "Topic and Service name mapping"): an absolute
name stands as it is, a relative one is put under the namespace where it is written, ``~/x`` under
the node's own full name. An absolute ``namespace`` replaces the enclosing one, a relative one
extends it. An imported system used as ``subsystem left : Arm namespace /left`` is flattened under
``/left``.
"""

from __future__ import annotations

from dataclasses import dataclass

from deros.metamodels.common import Value
from deros.metamodels.node import NodeType, ParameterType, Port, PortKind
from deros.metamodels.remapping import remappings, wired_ends
from deros.metamodels.system import NodeInstance, Subsystem, System, Topic, Wiring


def resolve_name(name: str, namespace: str, node_name: str = "") -> str:
    """Return the graph name that ``name`` means under ``namespace``, for the node ``node_name``."""
    if name.startswith("/"):
        return name
    if name == "~" or name.startswith("~/"):
        return f"{resolve_name(node_name, namespace)}{name[1:]}"
    return f"{namespace.rstrip('/')}/{name}"


@dataclass(frozen=True, slots=True)
class FlatPort:
    """A port of a node at run time.

    ``topic`` is the graph name it ends on. Without a ``wiring`` that is its own name, because ROS 2
    lets an unwired port talk there all the same. ``requested`` is the full name that the node's
    code asks for; where ``sets_parameter``, the wiring has told it the topic.
    """

    port: Port
    topic: str
    wiring: Wiring | None
    requested: str
    sets_parameter: bool = False


@dataclass(frozen=True, slots=True)
class UntypedWiring:
    """A wiring through a string parameter that no port claims: its topic is known, its type not."""

    wiring: Wiring
    topic: str


@dataclass(frozen=True, slots=True)
class FlatNode:
    """One node of the running system.

    Attributes:
        path: the subsystems that hold it, outermost first.
        parameters: what the system sets, wirings through parameters included.
        remappings: pairs of a port's own name and the graph name it is connected to, one for each
            name, or one for topics and one for services where these go elsewhere. A port ``via`` a
            parameter has none: its wiring sets the parameter.
    """

    instance: NodeInstance
    type: NodeType | None
    path: tuple[str, ...]
    namespace: str
    full_name: str
    ports: tuple[FlatPort, ...]
    untyped: tuple[UntypedWiring, ...]
    parameters: tuple[tuple[str, Value], ...]
    remappings: tuple[tuple[str, str], ...]


@dataclass(frozen=True, slots=True)
class FlatTopic:
    """A declared topic under its graph name."""

    name: str
    declaration: Topic
    path: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class FlatSystem:
    """All nodes and declared topics of a system, imports expanded, in the order written."""

    system: System
    nodes: tuple[FlatNode, ...]
    topics: tuple[FlatTopic, ...]

    def topic(self, name: str) -> FlatTopic | None:
        """Return the first declaration of the graph name ``name``, or ``None``."""
        return next((topic for topic in self.topics if topic.name == name), None)


def flatten(system: System) -> FlatSystem:
    """Expand ``system``; unknown node types, ports and systems are left out, not reported here."""
    nodes: list[FlatNode] = []
    topics: list[FlatTopic] = []
    _walk(system.topics, system.members, "/", (), (system,), nodes, topics)
    return FlatSystem(system, tuple(nodes), tuple(topics))


def _walk(
    declared: tuple[Topic, ...],
    members: tuple[NodeInstance | Subsystem, ...],
    namespace: str,
    path: tuple[str, ...],
    open_systems: tuple[System, ...],
    nodes: list[FlatNode],
    topics: list[FlatTopic],
) -> None:
    topics.extend(FlatTopic(resolve_name(t.name, namespace), t, path) for t in declared)
    for member in members:
        inner = namespace
        if member.namespace is not None:
            inner = resolve_name(member.namespace, namespace)
        if isinstance(member, NodeInstance):
            nodes.append(_flat_node(member, inner, path))
            continue
        here = (*path, member.name)
        _walk(member.topics, member.members, inner, here, open_systems, nodes, topics)
        used = member.system
        # A system that uses itself is reported as a cyclic import; expanding it would never end.
        if used is not None and not any(used is one for one in open_systems):
            _walk(used.topics, used.members, inner, here, (*open_systems, used), nodes, topics)


def _flat_node(instance: NodeInstance, namespace: str, path: tuple[str, ...]) -> FlatNode:
    def full(name: str) -> str:
        return resolve_name(name, namespace, instance.name)

    node_type = instance.type
    settings: dict[str, Value] = {p.name: p.value for p in instance.parameters}
    by_port: dict[tuple[PortKind, str], Wiring] = {}
    by_parameter: dict[str, Wiring] = {}
    for wiring in instance.wirings if node_type else ():
        assert node_type is not None
        for port, parameter in wired_ends(node_type, wiring):
            if port is not None:
                by_port.setdefault((port.kind, port.name), wiring)
            if parameter and is_topic_parameter(node_type, parameter):
                by_parameter.setdefault(parameter, wiring)
    # The wiring wins over a `param` for the same parameter; contradicting it is reported elsewhere.
    settings.update((name, full(wiring.target)) for name, wiring in by_parameter.items())

    flat_ports: list[FlatPort] = []
    claimed: set[str] = set()
    for port in node_type.ports if node_type else ():
        found = by_parameter.get(port.via) if port.via is not None else None
        if found is not None and port.via is not None:
            claimed.add(port.via)
            topic = full(found.target)
            flat_ports.append(FlatPort(port, topic, found, topic, sets_parameter=True))
            continue
        requested = full(_default_topic(port, node_type, settings))
        found = by_port.get((port.kind, port.name))
        topic = requested if found is None else full(found.target)
        flat_ports.append(FlatPort(port, topic, found, requested))
    untyped = tuple(
        UntypedWiring(wiring, full(wiring.target))
        for name, wiring in by_parameter.items()
        if name not in claimed
    )
    return FlatNode(
        instance,
        node_type,
        path,
        namespace,
        resolve_name(instance.name, namespace),
        tuple(flat_ports),
        untyped,
        tuple(settings.items()),
        remappings(flat_ports),
    )


def _default_topic(port: Port, node_type: NodeType | None, settings: dict[str, Value]) -> str:
    """Return the name an unwired port uses: its parameter's value if it has one, else its own."""
    if port.via is None or node_type is None:
        return port.name
    parameter = node_type.parameter(port.via)
    value = settings.get(port.via, parameter.default if parameter else None)
    return value if isinstance(value, str) and value else port.name


def is_topic_parameter(node_type: NodeType, name: str) -> bool:
    """Tell whether ``name`` is a string parameter of the type: it may hold a topic's name."""
    parameter = node_type.parameter(name)
    return parameter is not None and parameter.type is ParameterType.STRING
