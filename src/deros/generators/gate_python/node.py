"""A gate as a node type: it hears commands, actions and the heartbeat, and commands the robot."""

from __future__ import annotations

from deros import codes
from deros.diagnostics import Related, SourceFile, Span, report
from deros.generators.protocol import GenerationError
from deros.generators.safety_python.node import is_reliable
from deros.interfaces.types import InterfaceType
from deros.metamodels.common import QosProfile
from deros.metamodels.node import NodeType, Port, PortKind
from deros.monitor.gates import gate_node_name
from deros.monitor.ir import Gate, Program
from deros.monitor.topics import SystemTopics

PROCESS_PARAMETERS = ("realtime_priority", "lock_memory", "garbage_collection")
"""The parameters that a gate has in common with the safety node."""

DIAGNOSTICS = "/diagnostics"
"""The topic on which a gate tells what it does."""

_DIAGNOSTICS = InterfaceType("diagnostic_msgs", "msg", "DiagnosticArray")
_UINT64 = InterfaceType("std_msgs", "msg", "UInt64")
_STATE_QOS = QosProfile(reliability="reliable", durability="transient_local", depth=1)
_RELIABLE_QOS = QosProfile(reliability="reliable", depth=10)
_BEST_EFFORT_QOS = QosProfile(reliability="best_effort", depth=10)


def gate_nodes(program: Program, topics: SystemTopics, safety_node: NodeType) -> list[NodeType]:
    """Return the nodes of the program's gates, in the package of the safety node.

    Args:
        program: the rules.
        topics: what the used systems tell of the topics, for the QoS of the commands.
        safety_node: the node whose states and heartbeat the gates heed.
    """
    nodes = [_node(gate, program, topics, safety_node) for gate in program.gates]
    first: dict[str, Gate] = {}
    for gate, node in zip(program.gates, nodes, strict=True):
        other = first.setdefault(node.name, gate)
        if other is not gate:
            message = f"the gates of {other.target!r} and {gate.target!r} both become {node.name!r}"
            related = (Related(other.span, f"the gate of {other.target!r} is here"),)
            hint = "rename one of the topics"
            raise GenerationError([report(codes.NAME_COLLISION, message, gate.span, hint, related)])
    return nodes


def heartbeat_port(safety_node: NodeType) -> str:
    """Return the name of a gate's port for the heartbeat: where the safety node has its own."""
    return f"{safety_node.name}/heartbeat"


def _node(gate: Gate, program: Program, topics: SystemTopics, safety_node: NodeType) -> NodeType:
    name = gate_node_name(gate.target)
    described = f"Lets commands from {gate.source} through to {gate.target} as far as it is safe"
    return NodeType(
        name,
        safety_node.package,
        SourceFile(f"{name}.rnd", ""),
        gate.span,
        gate.span,
        gate.span,
        description=gate.description or described,
        parameters=tuple(p for p in safety_node.parameters if p.name in PROCESS_PARAMETERS),
        ports=tuple(_ports(gate, program, topics, safety_node)),
    )


def _ports(gate: Gate, program: Program, topics: SystemTopics, safety_node: NodeType) -> list[Port]:
    description = "What safety lets through"
    target = _port(
        PortKind.PUBLISHER, gate.target, gate.type, gate.span, _RELIABLE_QOS, description
    )
    qos = _source_qos(topics, gate.source)
    source = _port(
        PortKind.SUBSCRIPTION, gate.source, gate.type, gate.span, qos, "What is asked for"
    )
    ports = {source.name: source}
    for line in gate.lines:
        binding = program.actions[line.action].binding if line.action is not None else None
        if binding is not None and binding.topic not in ports:
            topic, kind = binding.topic, binding.type
            port = _port(PortKind.SUBSCRIPTION, topic, kind, line.span, _STATE_QOS, "")
            ports[port.name] = port
        if line.lost == "heartbeat":
            name = heartbeat_port(safety_node)
            kept = ports.get(name)
            port = _port(PortKind.SUBSCRIPTION, name, _UINT64, line.span, _RELIABLE_QOS, "")
            ports[name] = kept or port
    diagnostics = _port(
        PortKind.PUBLISHER, DIAGNOSTICS, _DIAGNOSTICS, gate.span, _RELIABLE_QOS, "What applies"
    )
    return [target, diagnostics, *ports.values()]


def _port(
    kind: PortKind,
    name: str,
    interface: InterfaceType,
    span: Span,
    qos: QosProfile,
    description: str,
) -> Port:
    return Port(kind, name, interface, span, span, span, qos=qos, description=description)


def _source_qos(topics: SystemTopics, topic: str) -> QosProfile:
    """Return a profile that every publisher meets; never one that has an old command replayed."""
    known = topics.get(topic)
    stated = [flat.port.qos for flat in known.publishers] if known else []
    return _RELIABLE_QOS if stated and all(map(is_reliable, stated)) else _BEST_EFFORT_QOS
