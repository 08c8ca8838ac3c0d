"""The node types of gates.

:mod:`deros.systems.safety_nodes` defines them; here they are built from a program.
"""

from __future__ import annotations

from deros import codes
from deros.diagnostics import Related, report
from deros.generators.api.protocol import GenerationError
from deros.models.node import NodeType
from deros.rules.compiler.scope.topics import SystemTopics
from deros.rules.program.ir import Gate, Program
from deros.rules.program.outline import program_outline
from deros.systems.safety_nodes import gate_node_types


def gate_nodes(program: Program, topics: SystemTopics, safety_node: NodeType) -> list[NodeType]:
    """Return the nodes of the program's gates, in the package of the safety node.

    Args:
        program: the rules.
        topics: the topics of the used systems, for the QoS of the commands.
        safety_node: the node whose states and heartbeat the gates follow.

    Raises:
        GenerationError: if two gates would get the same name.
    """
    outline = program_outline(program, safety_node.span)
    nodes = gate_node_types(outline, topics.offers, safety_node)
    first: dict[str, Gate] = {}
    for gate, node in zip(program.gates, nodes, strict=True):
        other = first.setdefault(node.name, gate)
        if other is not gate:
            message = f"the gates of {other.target!r} and {gate.target!r} both become {node.name!r}"
            related = (Related(other.span, f"the gate of {other.target!r} is here"),)
            hint = "rename one of the topics"
            raise GenerationError([report(codes.NAME_COLLISION, message, gate.span, hint, related)])
    return nodes
