"""Gates in C++: their sources, and what the package of the safety node needs to build them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from deros.generators.api.protocol import File
from deros.generators.gate.cpp.node import base_node
from deros.generators.gate.cpp.view import GateView, gate_view, nanoseconds
from deros.generators.node.cpp.interface import Provided
from deros.generators.node.interface import node_description
from deros.generators.runtime.cpp.interface import CppRuntime
from deros.generators.text.c import lay_out_if
from deros.generators.text.cpp import (
    LINE_LENGTH,
    arguments,
    call,
    comment,
    cpp_header,
    cpp_string,
    cpp_type,
    expression,
    include_lines,
    mark_long_lines,
)
from deros.generators.text.notice import licensed_cpp
from deros.generators.text.templates import environment
from deros.interfaces.store import InterfaceStore
from deros.models.node import NodeType
from deros.rules.program.ir import Program
from deros.systems.safety_nodes import RESET, TRIGGER

_SHARED = (
    *("clock_choice", "digest", "endpoints", "event_loop", "instance", "ports", "process"),
    *("publishers", "realtime", "regular_file", "simulated_time", "start_order", "text", "worker"),
)
"""The runtime sources that gates share with the safety node."""

_OWN = ("gate_logic", "gate_report", "gate_runner", "safety_source", "target_publishers")
"""The runtime sources of gates alone."""

_HEADERS = ("gate_limits", "gate_numbers", "gate_sources", "gate_table")
"""The runtime headers of gates that have no source."""

_NEEDS = ("builtin_interfaces", "diagnostic_msgs", "rcutils", "rosgraph_msgs")


@dataclass(frozen=True, slots=True)
class Gates:
    """The gates of one package.

    Attributes:
        nodes: the nodes for ``package_files``.
        provided: the argument ``provided`` of ``package_files``.
        files: their files, besides those of ``package_files`` and the runtime of the safety node.
    """

    nodes: list[NodeType] = field(default_factory=list)
    provided: dict[str, Provided] = field(default_factory=dict)
    files: dict[str, File] = field(default_factory=dict)


def gate_files(
    program: Program,
    nodes: Sequence[NodeType],
    safety_node: NodeType,
    store: InterfaceStore,
    runtime: CppRuntime,
    copyright_line: str = "",
) -> Gates:
    """Return the gates of ``program`` for the package of the safety node in C++.

    Args:
        program: the rules.
        nodes: the nodes of its gates, in order, as :func:`gate_nodes` returns them.
        safety_node: the node whose states and heartbeat they follow, as in the Python target.
        store: the message definitions.
        runtime: the runtime of the package.
        copyright_line: years and holder for the headers, or nothing.
    """
    made = Gates()
    for gate, node in zip(program.gates, nodes, strict=True):
        view = gate_view(gate, node, program, store, safety_node)
        made.nodes.append(base_node(node))
        made.provided[node.name] = _provided(view, node, runtime)
        made.files[f"{node.package}/{node.name}.rnd"] = File(node_description(node))
        for path, template in _paths(view).items():
            made.files[path] = File(licensed_cpp(render(template, view, runtime), copyright_line))
    if nodes:
        made.files.update(runtime.files((*_HEADERS, *_OWN), copyright_line))
    return made


def _paths(view: GateView) -> dict[str, str]:
    """Return the templates of a gate's files, by their paths."""
    source, include = f"{view.package}/src/{view.name}", include_folder(view.package)
    return {
        f"{include}/{view.name}.hpp": "node.hpp",
        f"{include}/{view.name}_message.hpp": "message.hpp",
        f"{include}/{view.name}_table.hpp": "table.hpp",
        f"{source}.cpp": "node.cpp",
        f"{source}_main.cpp": "main.cpp",
        f"{source}_message.cpp": "message.cpp",
    }


def _provided(view: GateView, node: NodeType, runtime: CppRuntime) -> Provided:
    own = (f"src/{view.name}.cpp", f"src/{view.name}_message.cpp")
    packages = {port.type.package for port in node.ports}
    return Provided(
        (*own, *runtime.sources((*_SHARED, *_OWN))),
        tuple(sorted({*_NEEDS, *packages})),
        (f"src/{view.name}_main.cpp",),
        default_name=view.node,
    )


def render(template: str, view: GateView, runtime: CppRuntime | None = None) -> str:
    """Return the text of one file of a gate: of ``node.cpp``, ``table.hpp`` and so on.

    Without a ``runtime``, the package has a copy.
    """
    runtime = runtime or CppRuntime(view.package)
    templates = environment("deros.generators.gate.cpp")
    parts = ("_base", "_message", "_table")
    headers = [f"{view.package}/{view.name}{part}.hpp" for part in parts]
    headers += [runtime.header("gate_logic"), runtime.header("gate_runner")]
    if view.depends_on_safety_node:
        headers.append(runtime.header("safety_source"))
    if view.heartbeat_port:
        headers.append(view.heartbeat_port.header)
    if view.latching:
        headers.append(cpp_header(TRIGGER))
    headers += [state.port.header for state in view.states]
    headers += [reading.port.header for reading in view.readings]
    text = templates.get_template(f"{template}.j2").render(
        gate=view,
        runtime=runtime,
        call=call,
        expression=expression,
        includes=include_lines([*headers, "rclcpp/rclcpp.hpp"]),
        arguments=arguments,
        comment=comment,
        if_head=_if_head,
        include_lines=include_lines,
        nanoseconds=nanoseconds,
        reset=cpp_string(RESET),
        trigger=cpp_type(TRIGGER),
        taken=("const rclcpp::SerializedMessage & data", "const rclcpp::MessageInfo & info"),
    )
    return mark_long_lines(text)


def _if_head(operands: Sequence[str], indent: int) -> str:
    """Return the head of an ``if`` whose operands all have to hold."""
    return "\n".join(lay_out_if(" && ", operands, indent, LINE_LENGTH)).lstrip()


# Paths --------------------------------------------------------------------------------------------


def include_folder(package: str) -> str:
    """Return the folder of a package's headers."""
    return f"{package}/include/{package}"
