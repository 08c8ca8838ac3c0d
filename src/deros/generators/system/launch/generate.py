"""The launch file: one action for each node or process, grouped as the model groups them."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

from deros.generators.api.protocol import Context, File, Files, GenerationError, Options
from deros.generators.system.composition import Loads
from deros.generators.system.computed import Computed, Text
from deros.generators.system.described import made_texts
from deros.generators.system.empty_parts import without_empty_parts
from deros.generators.system.files import copies
from deros.generators.system.launch import inside
from deros.generators.system.launch.checks import DOUBLE, INTEGER, Check, checks_of
from deros.generators.system.launch.declared import declared
from deros.generators.system.launch.needed_files import needed_files
from deros.generators.system.launch.overflow import overflow_checks, where
from deros.generators.system.launch.python_text import PythonText
from deros.generators.system.launch.refilled import late_managed, refilled
from deros.generators.system.launch.relative import relative
from deros.generators.system.launch.starts import awaited_names, first_start, kinds_of
from deros.generators.system.launched import is_launch_file
from deros.generators.system.literals import comment, listed, python_literal
from deros.generators.system.programs import remappings_of
from deros.generators.system.script.assemble import merged_imports, runtime
from deros.generators.system.view import (
    NodeView,
    ProcessView,
    ProgramView,
    SystemView,
    system_view,
)
from deros.generators.text.python import mark_long_lines
from deros.generators.text.templates import environment
from deros.models.system import System
from deros.names.graph_names import ANY_ROOT
from deros.systems.running.placement import placed

_MODULES = {
    "get_package_share_directory": "ament_index_python.packages",
    "ParameterValue": "launch_ros.parameter_descriptions",
    "IfCondition": "launch.conditions",
    "UnlessCondition": "launch.conditions",
    "List": "typing",
    "Node": "launch_ros.actions",
    "LifecycleNode": "launch_ros.actions",
    "ComposableNodeContainer": "launch_ros.actions",
    "LoadComposableNodes": "launch_ros.actions",
    "ComposableNode": "launch_ros.descriptions",
    "ExecuteProcess": "launch.actions",
    "GroupAction": "launch.actions",
    "IncludeLaunchDescription": "launch.actions",
    "SetEnvironmentVariable": "launch.actions",
    "UnsetLaunchConfiguration": "launch.actions",
    "AnyLaunchDescriptionSource": "launch.launch_description_sources",
    "PushRosNamespace": "launch_ros.actions",
    "PopEnvironment": "launch.actions",
    "PopLaunchConfigurations": "launch.actions",
    "PushEnvironment": "launch.actions",
    "PushLaunchConfigurations": "launch.actions",
    "SetParameter": "launch_ros.actions",
    "SetParametersFromFile": "launch_ros.actions",
    "SetRemap": "launch_ros.actions",
    "DeclareLaunchArgument": "launch.actions",
    "OpaqueFunction": "launch.actions",
    "FindPackageShare": "launch_ros.substitutions",
    "normalize_to_list_of_substitutions": "launch.utilities",
    "perform_substitutions": "launch.utilities",
    "LaunchDescription": "launch",
    "EmitEvent": "launch.actions",
    "LogInfo": "launch.actions",
    "RegisterEventHandler": "launch.actions",
    "Shutdown": "launch.actions",
    "TimerAction": "launch.actions",
    "OnProcessExit": "launch.event_handlers",
    "OnShutdown": "launch.event_handlers",
    "OnProcessStart": "launch.event_handlers",
    "Substitution": "launch",
    "evaluate_parameters": "launch_ros.utilities",
    "make_namespace_absolute": "launch_ros.utilities",
    "normalize_parameters": "launch_ros.utilities",
    "prefix_namespace": "launch_ros.utilities",
    "matches_action": "launch.events",
    "OnStateTransition": "launch_ros.event_handlers",
    "ChangeState": "launch_ros.events.lifecycle",
    "Transition": "lifecycle_msgs.msg",
    "State": "lifecycle_msgs.msg",
    "GetState": "lifecycle_msgs.srv",
    "get_ros_node": "launch_ros.ros_adapters",
}
"""Where the names that a launch file imports come from; all others are substitutions."""
_BRING_UP = (
    *("ChangeState", "EmitEvent", "LogInfo", "OnProcessExit", "OnProcessStart"),
    *("OnStateTransition", "OpaqueFunction", "RegisterEventHandler", "Shutdown", "TimerAction"),
    *("Transition", "matches_action"),
)
"""What the class needs that brings managed nodes up."""
_LATER = (
    *("OnProcessExit", "OpaqueFunction", "PopEnvironment", "PopLaunchConfigurations"),
    *("PushEnvironment", "PushLaunchConfigurations", "RegisterEventHandler", "TimerAction"),
)
"""What the class needs that starts programs later."""
_WAITS = (
    *("LogInfo", "OnProcessExit", "OnProcessStart", "OpaqueFunction", "RegisterEventHandler"),
    *("Shutdown", "TimerAction", "get_ros_node", "make_namespace_absolute"),
    *("normalize_to_list_of_substitutions", "perform_substitutions", "prefix_namespace"),
)
"""What the class needs that waits for what is in the ROS graph."""
_INCLUDES = (
    *("AnyLaunchDescriptionSource", "GroupAction", "IncludeLaunchDescription", "OpaqueFunction"),
    *("ParameterValue", "PushRosNamespace", "SetEnvironmentVariable", "SetParameter"),
    *("SetParametersFromFile", "SetRemap"),
)
"""What the function needs that includes launch files."""


def generate(model: System, context: Context, options: Options) -> Files:  # noqa: ARG001
    """Return the launch file, and copies of the parameter files that it names.

    Raises:
        GenerationError: if a node cannot be started as the model says.
    """
    system = placed(model)
    view = without_empty_parts(relative(system_view(system, root=ANY_ROOT, everywhere=model)))
    faults = [*refilled(system, view), *late_managed(system, view)]
    faults += inside.unwatched(system, view)
    if faults:
        raise GenerationError(faults)
    return {f"{view.stem}.launch.py": File(render(view)), **copies(model, view)}


def render(view: SystemView) -> str:
    """Return the launch file's text."""
    written = PythonText(view)
    made = environment("deros.generators.system.launch")
    made.filters["comment"] = comment
    made.filters["condition"] = written.condition
    made.filters["bring_up"] = _bring_up
    names = awaited_names(view)
    made.filters["first_start"] = lambda node, group: first_start(node, group, names, python)
    loads = Loads(view)
    made.filters["action"] = lambda node: _action(node, loads)

    def python(value: object, column: int = 0, indent: int = 0, after: int = 1) -> str:
        if isinstance(value, Computed):
            return written.text(value)
        return python_literal(value, column, indent, after)  # type: ignore[arg-type]

    def words(value: tuple[Text, ...], column: int, indent: int) -> str:
        if all(isinstance(each, str) for each in value):
            return python_literal(value, column, indent)  # type: ignore[arg-type]
        return listed(map(python, value), indent)

    made.filters["python"] = python
    made.filters["words"] = words
    made.filters["parameter"] = written.parameter
    made.filters["path"] = written.path
    made.filters["yaml"] = written.yaml
    made.filters["launch_argument"] = written.launch_argument
    made.filters["xacro"] = written.xacro
    made.filters["made_texts"] = made_texts
    made.filters["log_level"] = written.log_level
    made.tests["launch_file"] = is_launch_file
    made.tests["addressed"] = inside.is_addressed
    made.filters["with_parameters"] = inside.with_parameters
    made.filters["remappings"] = lambda program: list(remappings_of(program))
    made.filters["name_rules"] = lambda program: list(inside.name_rules(program, python))
    made.filters["process_words"] = lambda process: list(
        inside.process_words(process, python, written.path)
    )
    # These say what the head has to import, and which values it has to check.
    arguments = [(each, *declared(each)) for each in view.arguments]
    declarations = made.get_template("arguments.py.j2").render(arguments=arguments)
    body = made.get_template("nodes.py.j2").render(
        system=view, loads=loads, needed_files=needed_files(view, written.path)
    )
    overflows = [
        written.term(check if when is None else where(written.made.truth(when), check, ""))
        for check, when in overflow_checks(view, written.made)
    ]
    asked = list(checks_of(view, written.made.quoted))
    used = set(written.used) | ({"LaunchConfiguration"} if asked else set())
    text = made.get_template("launch.py.j2").render(
        system=view,
        managed_inside=_manages_inside(view),
        kinds=kinds_of(view),
        has_launch_files=any(view.launches),
        addresses=inside.addresses(view),
        quotes=written.quotes,
        moving="\n\n\n".join(part.code for part in runtime(_moving(view)).parts),
        body=body,
        declarations=declarations,
        checks=asked,
        overflows=overflows,
        integer=INTEGER if any("INTEGER" in each.holds for each in asked) else "",
        double=DOUBLE if any("DOUBLE" in each.holds for each in asked) else "",
        imports="\n".join(_imports(view, used, asked, loads, written.quotes)),
    )
    return mark_long_lines(text)


def _moving(view: SystemView) -> tuple[str, ...]:
    """Return the modules that make parameter files of others."""
    values = ("made/substituting",) if view.substitutes else ()
    under = ("made/under",) if view.moves_keys or view.reads_plain_files else ()
    return (*values, *under, *(("made/below",) if view.moves_keys else ()))


def _bring_up(node: ProgramView) -> str:
    """Return what follows the action of a node that is brought to active: the rest of a call."""
    if not isinstance(node, NodeView) or node.autostart is None:
        return ""
    optional = ", optional=True" if node.autostart.is_optional else ""
    restarts = ", restarts=True" if node.respawn_delay is not None else ""
    later = ", later=True" if node.starting.is_later else ""
    return f", timeout={node.autostart.timeout_s!r}{optional}{restarts}{later})"


def _action(node: NodeView, loads: Loads) -> str:
    """Return the class of the action that starts the process of a node."""
    if node.address is not None and loads.into(node):
        return "ComposableNodeContainer"
    return "LifecycleNode" if node.lifecycle and not node.own_name else "Node"


def _manages_inside(view: SystemView) -> bool:
    """Return whether managed nodes in containers are brought to active."""
    return any(node.autostart is not None and node.container is not None for node in view.nodes)


def _actions(view: SystemView, loads: Loads) -> Iterator[str]:
    """Yield the classes of what starts nodes, and of what is loaded."""
    for node in view.nodes:
        if node.container is None:
            yield _action(node, loads)
            continue
        yield "ComposableNode"
        if loads.elsewhere(node):
            yield "LoadComposableNodes"
    if _manages_inside(view):
        yield from ("LifecycleNode", "Node")


def _imports(
    view: SystemView, used: set[str], asked: Sequence[Check], loads: Loads, quotes: bool
) -> Iterator[str]:
    names = {"LaunchDescription", *used, *_actions(view, loads)}
    if view.brings_up:
        names.update(_BRING_UP)
    if view.starts_later:
        names.update(_LATER)
    kinds = kinds_of(view)
    names.update(_WAITS if kinds else (), ("GetState", "State") if "active" in kinds else ())
    names |= {"Shutdown" for each in view.programs if each.starting.stops_all is not None}
    names |= {"ExecuteProcess" for each in view.programs if isinstance(each, ProcessView)}
    if view.arguments:
        names.add("DeclareLaunchArgument")
    if any(view.launches):
        names.update(_INCLUDES)
        names |= {"UnsetLaunchConfiguration"} if view.arguments else set()
    looks = view.reads_files or view.describes or any(view.launches) or bool(view.made)
    names |= {"OpaqueFunction"} if asked or looks else set()
    addresses = inside.addresses(view)
    names |= set(inside.IMPORTS) if addresses else set()
    if looks:
        names |= {"normalize_to_list_of_substitutions", "perform_substitutions"}
    names |= {"get_package_share_directory"} if view.substitutes else set()
    names |= {"OnShutdown", "Substitution"} if view.makes_files else set()
    modules: dict[str, list[str]] = {}
    for name in sorted(names):
        modules.setdefault(_MODULES.get(name, "launch.substitutions"), []).append(name)
    standard = [runtime(_moving(view)).imports]
    standard += ["import os"] if looks else []
    standard += ["import re"] if any("re." in each.holds for each in asked) else []
    standard += ["import shlex"] if view.made else []
    standard += ["import shutil"] if view.describes or view.made else []
    standard += ["import subprocess", "import sys"] if view.made else []
    standard += ["import tempfile"] if view.makes_files else []
    standard += ["from tempfile import NamedTemporaryFile"] if addresses else []
    standard += ["from typing import List"] if modules.pop("typing", None) else []
    _, merged = merged_imports(ast.parse("\n".join(standard)).body)
    if merged:
        yield f"{merged}\n"
    for module in sorted(modules):
        line = f"from {module} import {', '.join(modules[module])}"
        if len(line) > 99:
            listed = ",\n    ".join(modules[module])
            line = f"from {module} import (\n    {listed},\n)"
        yield line
    if addresses or quotes:
        yield "import yaml"
