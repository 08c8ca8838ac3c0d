"""A gate as a node type: the C++ twin of the Python target's."""

from __future__ import annotations

import dataclasses

from deros.generators.gate import nodes as gate_nodes_of
from deros.generators.text.cpp import cpp_identifier
from deros.generators.text.identifiers import Emitted, check_collisions
from deros.metamodels.node import NodeType
from deros.metamodels.safety_nodes import DIAGNOSTICS, cpp_twin
from deros.monitor.ir import Program
from deros.monitor.topics import SystemTopics


def gate_nodes(program: Program, topics: SystemTopics, safety_node: NodeType) -> list[NodeType]:
    """Return the nodes of the program's gates, in the package of the safety node in C++.

    Args:
        program: the rules.
        topics: what the used systems tell of the topics, for the QoS of the commands.
        safety_node: the safety node as the Python target has it: its twin in C++ runs by the same
            name, and so gates in either language heed the one as the other.

    Raises:
        GenerationError: if two gates, or two ports of one, would get one name.
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
    """Return what of a gate's node is like that of any node: its parameters and its diagnostics.

    The other ports hand over messages as bytes; the gate opens them itself.
    """
    ports = tuple(port for port in node.ports if port.name == DIAGNOSTICS)
    return dataclasses.replace(node, ports=ports)
