"""A third-party generator: it needs only this function and one entry point."""

from __future__ import annotations

from deros.generators.api.protocol import Context, File, Files, Option, Options
from deros.generators.api.registry import generator
from deros.models.node import PortKind
from deros.models.system import System
from deros.systems.flatten import flatten


@generator("rossystem", "dot", (Option("rank-dir", "direction of the graph: LR, TB, RL or BT"),))
def dot(model: System, context: Context, options: Options) -> Files:  # noqa: ARG001
    """The nodes and topics of a system as a Graphviz graph."""
    lines = [f"digraph {model.name} {{", f"  rankdir={options.get('rank-dir', 'LR')};"]
    for node in flatten(model).nodes:
        for end in node.ports:
            ends = (node.full_name, end.topic)
            if end.port.kind is PortKind.SUBSCRIPTION:
                ends = (end.topic, node.full_name)
            lines.append('  "{}" -> "{}";'.format(*ends))
    return {f"{model.name}.dot": File("\n".join([*lines, "}", ""]))}
