"""The files of the safety node in C++, in addition to those of every node."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

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
    *(
        "bound_service",
        "clock_choice",
        "descriptor",
        "diagnostics",
        "digest",
        "duplicate_instance",
        "endpoints",
    ),
    *("event_loop", "event_reporter", "instance", "latches", "look_ahead", "monitor_runner"),
    *(
        "ports",
        "process",
        "publishers",
        "realtime",
        "refusal",
        "regular_file",
        "report_types",
        "safety_node_core",
    ),
    *("simulated_time", "start_order", "text", "worker"),
)
"""The parts of the runtime that every safety node has."""

_SERVICES = ("service_call", "service_client")
"""The parts of the runtime that actions with services need, too."""

_NEEDS = (
    "diagnostic_msgs",
    "rclcpp",
    "rclcpp_components",
    "rcutils",
    "rosgraph_msgs",
    "std_msgs",
)


def runtime_parts(view: SafetyView) -> tuple[str, ...]:
    """Return the parts of the runtime that a safety node needs."""
    flags = ("flags",) if _uses_flags(view) else ()
    lookups = ("place_of",) if _uses_lookups(view) else ()
    return (*RUNTIME, *(_SERVICES if view.services else ()), *flags, *lookups)


def _uses_flags(view: SafetyView) -> bool:
    return "runtime::flags" in str(view.handlers)


def _uses_lookups(view: SafetyView) -> bool:
    return any(each.lookups for each in view.handlers)


def provided(view: SafetyView, runtime: CppRuntime) -> Provided:
    """Return the sources and dependencies of the node, whose class is generated here."""
    own = [f"src/{view.stem}{part}.cpp" for part in ("", "_messages", "_rule_metadata")]
    own += [f"src/{view.prefix}_monitor.c", *runtime.sources(runtime_parts(view))]
    if view.actions:
        own.append(f"src/{view.actions_stem}.cpp")
    return Provided(tuple(own), _NEEDS, (f"src/{view.stem}_main.cpp",), default_name=view.node_name)


def node_files(view: SafetyView, holder: str, runtime: CppRuntime) -> dict[str, File]:
    """Return the node's class, its messages and metadata, and the classes of the actions.

    Args:
        view: the safety node.
        holder: the text above each file.
        runtime: the runtime of the package.
    """
    sources = _Sources(view, holder, runtime)
    include, source = f"{view.package}/include/{view.package}", f"{view.package}/src/{view.stem}"
    headers = [
        f"{view.package}/{view.stem}_base.hpp",
        runtime.header("safety_node_core"),
        "rclcpp/rclcpp.hpp",
        *view.headers,
    ]
    if view.actions:
        headers.append(f"{view.package}/{view.actions_stem}.hpp")
    components = ["rclcpp_components/register_node_macro.hpp"]
    if view.services:
        components.append(runtime.header("service_client"))
    messages = sources.file("messages.hpp", f"{view.stem}_messages", view.message_headers)
    metadata = sources.file("rule_metadata.hpp", f"{view.stem}_rule_metadata")
    files = {
        f"{include}/{view.stem}.hpp": sources.file(
            "node.hpp", f"{view.package}__{view.stem}", headers
        ),
        f"{source}.cpp": sources.file("node.cpp", headers=components),
        f"{source}_main.cpp": sources.file("main.cpp"),
        f"{source}_messages.hpp": messages,
        f"{source}_messages.cpp": sources.file("messages.cpp"),
        f"{source}_rule_metadata.hpp": metadata,
        f"{source}_rule_metadata.cpp": sources.file("rule_metadata.cpp"),
    }
    return files | (_action_files(view, sources) if view.actions else {})


@dataclass(frozen=True, slots=True)
class _Sources:
    """Renders the headers and sources of a safety node."""

    view: SafetyView
    holder: str
    runtime: CppRuntime

    def file(self, template: str, guard: str = "", headers: Iterable[str] = ()) -> File:
        """Return a file that includes ``headers``, and what it uses of the standard library."""
        calls = str(self.view.handlers)
        loaded = environment("deros.generators.safety_node.cpp").get_template(f"{template}.j2")

        def render(standard: list[str]) -> str:
            return loaded.render(
                safety=self.view,
                runtime=self.runtime,
                guard=f"{guard}_hpp_".upper(),
                includes=include_lines(headers),
                standard=standard,
                uses_not_given="NOT_GIVEN" in calls,
                uses_text="runtime::utf8" in calls,
                uses_flags=_uses_flags(self.view),
                uses_lookups=_uses_lookups(self.view),
                call=call,
                comment=comment,
                expression=expression,
                string=cpp_string,
                table=table,
            )

        text = render(standard_headers(render([])))
        return File(mark_long_lines(licensed_cpp(text, self.holder)))


def _action_files(view: SafetyView, sources: _Sources) -> dict[str, File]:
    include, stem = f"{view.package}/include/{view.package}", view.actions_stem
    guard = f"{view.package}__{stem}"
    header, source = sources.file("actions.hpp", guard), sources.file("actions.cpp")
    return {
        f"{include}/{stem}_base.hpp": sources.file("actions_base.hpp", f"{guard}_base"),
        f"{include}/{stem}.hpp": File(header.text, Owner.USER),
        f"{view.package}/src/{stem}.cpp": File(source.text, Owner.USER),
    }
