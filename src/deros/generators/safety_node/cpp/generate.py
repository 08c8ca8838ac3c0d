"""The files of the safety node in C++, beside those that any node has."""

from __future__ import annotations

from collections.abc import Iterable

from deros.generators.api.protocol import File, Owner
from deros.generators.node.cpp.interface import Provided
from deros.generators.runtime.cpp.interface import CppRuntime
from deros.generators.safety_node.cpp.rule_metadata import table
from deros.generators.safety_node.cpp.view import SafetyView
from deros.generators.text.cpp import (
    call,
    comment,
    cpp_string,
    expression,
    include_lines,
    mark_long_lines,
    standard_headers,
)
from deros.generators.text.notice import licensed_cpp
from deros.generators.text.templates import environment

RUNTIME = (
    *("clock_choice", "descriptor", "diagnostics", "digest", "duplicate_instance", "event_loop"),
    *("events", "instance", "latches", "monitor_runner", "ports", "process", "publishers"),
    *("realtime", "refusal", "regular_file", "report_types", "safety_node_core"),
    *("simulated_time", "start_order", "text", "worker"),
)
"""The parts of the runtime that every safety node has."""

_NEEDS = (
    "diagnostic_msgs",
    "rclcpp",
    "rclcpp_components",
    "rcutils",
    "rosgraph_msgs",
    "std_msgs",
)


def provided(view: SafetyView) -> Provided:
    """Return what the package has to know of the node, whose class is made here."""
    own = [f"src/{view.stem}{part}.cpp" for part in ("", "_messages", "_rule_metadata")]
    own += [f"src/{view.prefix}_monitor.c", *CppRuntime(view.package).sources(RUNTIME)]
    if view.actions:
        own.append(f"src/{view.actions_stem}.cpp")
    return Provided(tuple(own), _NEEDS, (f"src/{view.stem}_main.cpp",), default_name=view.node_name)


def node_files(view: SafetyView, holder: str) -> dict[str, File]:
    """Return the node's class, its messages and metadata, and the classes of the user's actions."""
    root, include = view.package, f"{view.package}/include/{view.package}"
    headers = [
        f"{view.package}/{view.stem}_base.hpp",
        f"{view.package}/runtime/safety_node_core.hpp",
        "rclcpp/rclcpp.hpp",
        *view.headers,
    ]
    if view.actions:
        headers.append(f"{view.package}/{view.actions_stem}.hpp")
    guard = f"{view.package}__{view.stem}"
    inner = f"{root}/src/{view.stem}"
    messages = _file("messages.hpp", view, holder, f"{view.stem}_messages", view.message_headers)
    files = {
        f"{include}/{view.stem}.hpp": _file("node.hpp", view, holder, guard, headers),
        f"{inner}.cpp": _file("node.cpp", view, holder),
        f"{inner}_main.cpp": _file("main.cpp", view, holder),
        f"{inner}_messages.hpp": messages,
        f"{inner}_messages.cpp": _file("messages.cpp", view, holder),
        f"{inner}_rule_metadata.hpp": _file(
            "rule_metadata.hpp", view, holder, f"{view.stem}_rule_metadata"
        ),
        f"{inner}_rule_metadata.cpp": _file("rule_metadata.cpp", view, holder),
    }
    return files | (_action_files(view, holder) if view.actions else {})


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
    loaded = environment("deros.generators.safety_node.cpp").get_template(f"{template}.j2")

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
    return File(mark_long_lines(licensed_cpp(text, holder)))
