"""Safety rules to an ament_cmake package: the node, its monitor in C, and the user's actions."""

from __future__ import annotations

import re

from deros.generators.api.protocol import Context, File, Files, GenerationError, Options
from deros.generators.gate.cpp.interface import gate_files, gate_nodes
from deros.generators.monitor.c.interface import render_monitor
from deros.generators.node.cpp.interface import package_files
from deros.generators.node.interface import node_description
from deros.generators.runtime.cpp.interface import cpp_runtime
from deros.generators.safety_node.cpp.interface import (
    node_files,
    provided,
    runtime_parts,
    safety_view,
    twin_options,
)
from deros.generators.safety_node.interface import package_options, safety_node, shared_topics
from deros.generators.text.notice import licensed_cpp, notice
from deros.models.rules import Rules
from deros.systems.safety_nodes import cpp_twin


def generate(model: Rules, context: Context, options: Options) -> Files:
    """Return the package of the safety node that runs ``model``, and of its gates.

    It is the twin of the Python target's: the node types' names end in ``_cpp``, and all that a
    robot sees of the nodes is the same, so that one word in a system chooses between the two.

    Raises:
        GenerationError: if the rules have an error, cannot be told in C, or names collide.
        OptionError: if an option cannot be read.
    """
    built = context.build(model)
    if built.program is None:
        raise GenerationError(built.diagnostics)
    options = package_options(model, options, "cpp")
    python = safety_node(built.program, built.topics, twin_options(options), model.source)
    node = cpp_twin(python)
    shared = shared_topics(model, built.program, built.topics)
    view = safety_view(model, built.program, python, node, context.store, shared)
    holder = notice(options)
    runtime = cpp_runtime(node.package, options)
    gates = gate_files(
        built.program,
        gate_nodes(built.program, built.topics, python),
        python,
        context.store,
        runtime,
        holder,
    )
    classes = {node.name: provided(view, runtime), **gates.provided}
    files = package_files([node, *gates.nodes], options, classes, context.store)
    files |= {f"{node.package}/{node.name}.rnd": File(node_description(node))}
    files |= node_files(view, holder, runtime)
    files |= {
        f"{view.package}/src/{name}": File(licensed_cpp(_as_linted(text), holder))
        for name, text in render_monitor(built.program).items()
    }
    return files | runtime.files(runtime_parts(view), holder) | gates.files


def _as_linted(text: str) -> str:
    """Return a file of the monitor in the style of cpplint, which does not know C."""
    text = re.sub(r"^#endif  /\* (\w+) \*/$", r"#endif  // \1", text, flags=re.MULTILINE)
    own = r'^#include "\w+\.h"$'
    return re.sub(own, r"\g<0>  // NOLINT(build/include_subdir)", text, flags=re.MULTILINE)
