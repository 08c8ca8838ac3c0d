"""Safety rules to an ament_python package: the node, its monitor, and the user's actions."""

from __future__ import annotations

from deros.generators.api.protocol import Context, File, Files, GenerationError, Options
from deros.generators.decoder.python.interface import render_decoders
from deros.generators.gate.python.interface import gate_files, gate_nodes
from deros.generators.monitor.python.interface import MONITOR, render_monitor
from deros.generators.node.interface import node_description
from deros.generators.node.python.interface import package_files
from deros.generators.runtime.python.interface import python_runtime
from deros.generators.safety_node.interface import package_options, safety_node, shared_topics
from deros.generators.safety_node.python.interface import node_files, safety_view
from deros.generators.text.notice import licensed_python, notice
from deros.models.rules import Rules


def generate(model: Rules, context: Context, options: Options) -> Files:
    """Return the package of the safety node that runs ``model``.

    The safety node is a node: what every node has comes from the node generator, out of the node
    description that is part of the output. On top come the monitor, the class that joins the two,
    and a file for the code of the actions that are robot code.

    Raises:
        GenerationError: if the rules have an error, or names collide.
        OptionError: if an option cannot be read.
    """
    built = context.build(model)
    if built.program is None:
        raise GenerationError(built.diagnostics)
    options = package_options(model, options, "python")
    node = safety_node(built.program, built.topics, options, model.source)
    shared = shared_topics(model, built.program, built.topics)
    copyright_line = notice(options)
    runtime = python_runtime(node.package, options, copyright_line)
    view = safety_view(model, built.program, node, context.store, shared, runtime)
    gates = gate_nodes(built.program, built.topics, node)
    nodes = [node, *gates]
    monitor = render_monitor(built.program)
    decoders = render_decoders([each.decoded for each in view.handlers], context.store)
    needs = {"python3-numpy"} if "import numpy" in monitor[MONITOR] + decoders else frozenset()
    files = package_files(nodes, options, {each.name for each in nodes}, needs, context.store)
    root = f"{view.package}/{view.package}"
    files[f"{view.package}/{node.name}.rnd"] = File(node_description(node))
    for name, text in monitor.items():
        files[f"{root}/{name}"] = File(licensed_python(text, copyright_line))
    files |= node_files(view, copyright_line)
    files |= runtime.files(view.package, view.runtime_modules)
    if view.handlers:
        files[f"{root}/decoding.py"] = File(licensed_python(decoders, copyright_line))
    return files | gate_files(built.program, gates, node, context.store, runtime)
