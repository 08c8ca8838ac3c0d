"""The modules of gates, for the package of their safety node."""

from __future__ import annotations

from collections.abc import Sequence

from deros.generators.api.protocol import File
from deros.generators.gate.python.view import GateView, gate_view, nanoseconds
from deros.generators.node.interface import node_description
from deros.generators.runtime.python.interface import PythonRuntime
from deros.generators.text.notice import licensed_python
from deros.generators.text.python import call, expression, mark_long_lines
from deros.generators.text.templates import environment
from deros.interfaces.store import InterfaceStore
from deros.models.node import NodeType
from deros.rules.program.ir import Program

MODULES = ("message", "table")
"""The suffixes of a gate's modules other than that of its node."""

RUNTIME = (
    "clock_choice",
    "endpoints",
    "gate_limits",
    "gate_logic",
    "gate_ramps",
    "gate_report",
    "gate_runner",
    "gate_sources",
    "gate_table",
    "instance",
    "one_shot_timer",
    "process",
    "publishers",
    "realtime",
    "regular_file",
    "safety_source",
    "start_order",
    "target_publishers",
    "waker",
)
"""The runtime modules of gates; the safety node needs most of them, too."""


def gate_files(
    program: Program,
    nodes: Sequence[NodeType],
    safety_node: NodeType,
    store: InterfaceStore,
    runtime: PythonRuntime,
) -> dict[str, File]:
    """Return the modules of the gates of ``program``, and the descriptions of their nodes.

    Args:
        program: the rules.
        nodes: the nodes of its gates, in order.
        safety_node: the node whose states and heartbeat they follow.
        store: the message definitions.
        runtime: the runtime of the package, with the notice for the headers.

    Raises:
        GenerationError: if two ports of a gate would get the same name.
    """
    files: dict[str, File] = {}
    for gate, node in zip(program.gates, nodes, strict=True):
        view = gate_view(gate, node, program, store, safety_node, runtime.module)
        root = f"{node.package}/{node.package}/{view.node.module}"
        files[f"{node.package}/{node.name}.rnd"] = File(node_description(node))
        files[f"{root}.py"] = File(render("node", view, runtime.notice))
        for module in MODULES:
            files[f"{root}_{module}.py"] = File(render(module, view, runtime.notice))
    if nodes:
        files |= runtime.files(nodes[0].package, RUNTIME)
    return files


def render(module: str, view: GateView, copyright_line: str = "") -> str:
    """Return the text of one module of a gate: its ``node``, or one of :data:`MODULES`."""
    templates = environment("deros.generators.gate.python")
    text = templates.get_template(f"{module}.py.j2").render(
        gate=view,
        node=view.node,
        call=call,
        expression=expression,
        nanoseconds=nanoseconds,
    )
    return mark_long_lines(licensed_python(text, copyright_line))
