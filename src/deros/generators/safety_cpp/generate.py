"""Safety rules to an ament_cmake package: the node, its monitor in C, and the user's actions."""

from __future__ import annotations

import re
from collections.abc import Iterable

from deros.generators.cpp_source import (
    call,
    comment,
    cpp_string,
    expression,
    include_lines,
    mark_long_lines,
    standard_headers,
)
from deros.generators.gate_cpp import gate_files, gate_nodes
from deros.generators.monitor_c import render_monitor
from deros.generators.notice import notice
from deros.generators.protocol import Context, File, Files, GenerationError, Options, Owner
from deros.generators.rosnode_cpp.generate import Provided, licensed, package_files
from deros.generators.safety_cpp.node import twin_options
from deros.generators.safety_cpp.origins import table
from deros.generators.safety_cpp.verbatim import runtime_files, runtime_sources
from deros.generators.safety_cpp.view import SafetyView, safety_view
from deros.generators.safety_python.description import node_description
from deros.generators.safety_python.node import package_options, safety_node
from deros.generators.safety_view import shared_topics
from deros.generators.templates import environment
from deros.metamodels.rules import Rules
from deros.metamodels.safety_nodes import cpp_twin
from deros.monitor.build import build

_NEEDS = (
    "diagnostic_msgs",
    "rclcpp",
    "rclcpp_components",
    "rcutils",
    "rosgraph_msgs",
    "std_msgs",
)


def generate(model: Rules, context: Context, options: Options) -> Files:
    """Return the package of the safety node that runs ``model``, and of its gates.

    It is the twin of the Python target's: the node types' names end in ``_cpp``, and all that a
    robot sees of the nodes is the same, so that one word in a system chooses between the two.

    Raises:
        GenerationError: if the rules have an error, cannot be told in C, or names collide.
        ValueError: if an option cannot be read.
    """
    built = build(model, context.store)
    if built.program is None:
        raise GenerationError(built.diagnostics)
    options = package_options(model, options, "cpp")
    python = safety_node(built.program, built.topics, twin_options(options), model.source)
    node = cpp_twin(python)
    shared = shared_topics(built.program, built.topics)
    view = safety_view(model, built.program, python, node, context.store, shared)
    holder = notice(options)
    gates = gate_files(
        built.program,
        gate_nodes(built.program, built.topics, python),
        python,
        context.store,
        holder,
    )
    provided = {node.name: _provided(view), **gates.provided}
    files = package_files([node, *gates.nodes], options, provided, context.store)
    files |= {f"{node.package}/{node.name}.rnd": File(node_description(node))}
    files |= _node_files(view, holder)
    files |= {
        f"{view.package}/src/{name}": File(licensed(_as_linted(text), holder))
        for name, text in render_monitor(built.program).items()
    }
    files |= runtime_files(view.package, holder)
    if view.actions:
        files |= _action_files(view, holder)
    return files | gates.files


def _as_linted(text: str) -> str:
    """Return a file of the monitor as cpplint wants it, which knows no C."""
    text = re.sub(r"^#endif  /\* (\w+) \*/$", r"#endif  // \1", text, flags=re.MULTILINE)
    own = r'^#include "\w+\.h"$'
    return re.sub(own, r"\g<0>  // NOLINT(build/include_subdir)", text, flags=re.MULTILINE)


def _provided(view: SafetyView) -> Provided:
    own = [f"src/{view.stem}{part}.cpp" for part in ("", "_messages", "_origins")]
    own += [f"src/{view.prefix}_monitor.c", *runtime_sources()]
    if view.actions:
        own.append(f"src/{view.actions_stem}.cpp")
    return Provided(tuple(own), _NEEDS, (f"src/{view.stem}_main.cpp",), default_name=view.node_name)


def _node_files(view: SafetyView, holder: str) -> dict[str, File]:
    root, include = view.package, f"{view.package}/include/{view.package}"
    headers = [
        f"{view.package}/{view.stem}_base.hpp",
        f"{view.package}/runtime/guardian.hpp",
        "rclcpp/rclcpp.hpp",
        *view.headers,
    ]
    if view.actions:
        headers.append(f"{view.package}/{view.actions_stem}.hpp")
    guard = f"{view.package}__{view.stem}"
    inner = f"{root}/src/{view.stem}"
    messages = _file("messages.hpp", view, holder, f"{view.stem}_messages", view.message_headers)
    return {
        f"{include}/{view.stem}.hpp": _file("node.hpp", view, holder, guard, headers),
        f"{inner}.cpp": _file("node.cpp", view, holder),
        f"{inner}_main.cpp": _file("main.cpp", view, holder),
        f"{inner}_messages.hpp": messages,
        f"{inner}_messages.cpp": _file("messages.cpp", view, holder),
        f"{inner}_origins.hpp": _file("origins.hpp", view, holder, f"{view.stem}_origins"),
        f"{inner}_origins.cpp": _file("origins.cpp", view, holder),
    }


def _action_files(view: SafetyView, holder: str) -> dict[str, File]:
    root, include = view.package, f"{view.package}/include/{view.package}"
    stem = view.actions_stem
    guard = f"{view.package}__{stem}"
    user = _file("actions.hpp", view, holder, guard)
    source = _file("actions.cpp", view, holder)
    return {
        f"{include}/{stem}_base.hpp": _file("actions_base.hpp", view, holder, f"{guard}_base"),
        f"{include}/{stem}.hpp": File(user.text, Owner.USER),
        f"{root}/src/{stem}.cpp": File(source.text, Owner.USER),
    }


def _file(
    template: str, view: SafetyView, holder: str, guard: str = "", headers: Iterable[str] = ()
) -> File:
    """Return a file that includes ``headers``, and what it uses of the standard library."""
    calls = str(view.handlers)
    loaded = environment("deros.generators.safety_cpp").get_template(f"{template}.j2")

    def render(standard: list[str]) -> str:
        return loaded.render(
            safety=view,
            guard=f"{guard}_hpp_".upper(),
            includes=include_lines(headers),
            standard=standard,
            uses_not_given="NOT_GIVEN" in calls,
            uses_text="runtime::utf8" in calls,
            call=call,
            comment=comment,
            expression=expression,
            string=cpp_string,
            table=table,
        )

    text = render(standard_headers(render([])))
    return File(mark_long_lines(licensed(text, holder)))
