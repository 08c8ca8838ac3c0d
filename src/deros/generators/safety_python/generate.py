"""Safety rules to an ament_python package: the node, its monitor, and the user's actions."""

from __future__ import annotations

from deros.generators.cdr_python import render_decoders
from deros.generators.gate_python import gate_files, gate_nodes
from deros.generators.monitor_python import render_monitor
from deros.generators.notice import notice
from deros.generators.protocol import Context, File, Files, GenerationError, Options, Owner
from deros.generators.python_source import Text, call, expression, mark_long_lines
from deros.generators.rosnode_python.generate import licensed, package_files
from deros.generators.safety_python.description import node_description
from deros.generators.safety_python.node import package_options, safety_node
from deros.generators.safety_python.verbatim import runtime_files
from deros.generators.safety_python.view import SafetyView, safety_view
from deros.generators.safety_view import shared_topics
from deros.generators.templates import environment
from deros.metamodels.rules import Rules
from deros.monitor.build import build


def generate(model: Rules, context: Context, options: Options) -> Files:
    """Return the package of the safety node that runs ``model``.

    The safety node is a node: what every node has comes from the node generator, out of the node
    description that is part of the output. On top come the monitor, the class that joins the two,
    and a file for the code of the actions that are robot code.

    Raises:
        GenerationError: if the rules have an error, or names collide.
        ValueError: if an option cannot be read.
    """
    built = build(model, context.store)
    if built.program is None:
        raise GenerationError(built.diagnostics)
    options = package_options(model, options, "python")
    node = safety_node(built.program, built.topics, options, model.source)
    shared = shared_topics(built.program, built.topics)
    view = safety_view(model, built.program, node, context.store, shared)
    copyright_line = notice(options)
    gates = gate_nodes(built.program, built.topics, node)
    nodes = [node, *gates]
    monitor = render_monitor(built.program)
    decoders = render_decoders([each.decoded for each in view.handlers], context.store)
    needs = {"python3-numpy"} if "import numpy" in monitor + decoders else frozenset()
    files = package_files(nodes, options, {each.name for each in nodes}, needs, context.store)
    root = f"{view.package}/{view.package}"
    files[f"{view.package}/{node.name}.rnd"] = File(node_description(node))
    files[f"{root}/monitor.py"] = File(licensed(monitor, copyright_line))
    files[f"{root}/{view.node.module}.py"] = File(_render("node.py", view, copyright_line))
    files[f"{root}/origins.py"] = File(_render("origins.py", view, copyright_line))
    files |= runtime_files(view.package, view.runtime, copyright_line)
    if view.handlers:
        files[f"{root}/decoding.py"] = File(licensed(decoders, copyright_line))
    files |= gate_files(built.program, gates, node, context.store, copyright_line)
    if view.actions:
        base = _render("actions_base.py", view, copyright_line)
        user = _render("actions.py", view, copyright_line)
        files[f"{root}/{view.actions_module}_base.py"] = File(base)
        files[f"{root}/{view.actions_module}.py"] = File(user, Owner.USER)
    return files


def _render(template: str, view: SafetyView, copyright_line: str) -> str:
    loaded = environment("deros.generators.safety_python").get_template(f"{template}.j2")
    text = loaded.render(safety=view, node=view.node, Text=Text, call=call, expression=expression)
    return mark_long_lines(licensed(text, copyright_line))
