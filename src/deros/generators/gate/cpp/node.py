"""The node types of gates in C++."""

from __future__ import annotations

import dataclasses

from deros.generators.gate import nodes as gate_nodes_of
from deros.generators.text.cpp import cpp_identifier
from deros.generators.text.identifiers import Emitted, check_collisions
from deros.models.node import NodeType
from deros.rules.compiler.scope.topics import SystemTopics
from deros.rules.program.ir import Program
from deros.systems.safety_nodes import DIAGNOSTICS, cpp_twin


def gate_nodes(program: Program, topics: SystemTopics, safety_node: NodeType) -> list[NodeType]:
    """Return the nodes of the program's gates, in the package of the safety node in C++.

    Args:
        program: the rules.
        topics: the topics of the used systems, for the QoS of the commands.
        safety_node: the safety node of the Python target. The one in C++ has the same name at run
            time, so gates in either language follow either of them.

    Raises:
        GenerationError: if two gates, or two ports of one, would get the same name.
    """
    nodes = gate_nodes_of.gate_nodes(program, topics, safety_node)
    for node in nodes:
        check_collisions(
            (
                Emitted(cpp_identifier(port.name), f"port {port.name!r}", port.name_span)
                for port in node.ports
            ),
            f"the gate {node.name}",
        )
    return [cpp_twin(node) for node in nodes]


def base_node(node: NodeType) -> NodeType:
    """Return the part of a gate's node for the node generator: its parameters and diagnostics.

    The other ports pass messages as bytes; the gate opens them itself.
    """
    ports = tuple(port for port in node.ports if port.name == DIAGNOSTICS)
    return dataclasses.replace(node, ports=ports)
