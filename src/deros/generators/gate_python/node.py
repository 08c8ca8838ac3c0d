"""A gate as a node type: it hears commands, actions and the heartbeat, and commands the robot."""

from __future__ import annotations

from deros import codes
from deros.diagnostics import Related, SourceFile, report
from deros.generators.protocol import GenerationError
from deros.generators.safety_python.node import (
    DIAGNOSTICS,
    DIAGNOSTICS_TYPE,
    HEARTBEAT_TYPE,
    RESET,
    TRIGGER,
    made_port,
)
from deros.metamodels import safety_qos
from deros.metamodels.node import NodeType, Parameter, ParameterType, Port, PortKind
from deros.monitor.gates import gate_node_name
from deros.monitor.ir import Gate, Program
from deros.monitor.topics import SystemTopics

PROCESS_PARAMETERS = ("realtime_priority", "lock_memory", "garbage_collection")
"""The parameters that a gate has in common with the safety node."""


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
        parameters=(
            *(p for p in safety_node.parameters if p.name in PROCESS_PARAMETERS),
            _losses_in_simulated_time(gate),
        ),
        ports=tuple(_ports(gate, program, topics, safety_node)),
    )


def _losses_in_simulated_time(gate: Gate) -> Parameter:
    description = (
        "Under use_sim_time, count losses and the period of zeros on /clock, for tests: where it"
        " stands, nothing is lost"
    )
    return Parameter(
        "losses_in_simulated_time",
        ParameterType.BOOL,
        False,
        gate.span,
        gate.span,
        read_only=True,
        description=description,
    )


def _ports(gate: Gate, program: Program, topics: SystemTopics, safety_node: NodeType) -> list[Port]:
    description = "What safety lets through"
    target = made_port(
        PortKind.PUBLISHER, gate.target, gate.type, gate.span, safety_qos.GATE_TARGET, description
    )
    qos = safety_qos.gate_source_qos(topics.offers(gate.source))
    source = made_port(
        PortKind.SUBSCRIPTION, gate.source, gate.type, gate.span, qos, "What is asked for"
    )
    ports = {source.name: source}
    for line in gate.lines:
        binding = program.actions[line.action].binding if line.action is not None else None
        if binding is not None:
            state = made_port(
                PortKind.SUBSCRIPTION, binding.topic, binding.type, line.span, safety_qos.STATE, ""
            )
            ports.setdefault(state.name, state)
        if line.lost == "heartbeat":
            name = heartbeat_port(safety_node)
            beat = made_port(
                PortKind.SUBSCRIPTION,
                name,
                HEARTBEAT_TYPE,
                line.span,
                safety_qos.GATE_HEARTBEAT,
                "",
            )
            ports.setdefault(name, beat)
    diagnostics = made_port(
        PortKind.PUBLISHER,
        DIAGNOSTICS,
        DIAGNOSTICS_TYPE,
        gate.span,
        safety_qos.DIAGNOSTICS,
        "What applies",
    )
    if gate.is_latching:
        description = "Ends the zeros that last until a reset, once their causes are over"
        reset = made_port(PortKind.SERVICE, RESET, TRIGGER, gate.span, None, description)
        return [target, diagnostics, *ports.values(), reset]
    return [target, diagnostics, *ports.values()]
