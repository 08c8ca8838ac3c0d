"""The view of an existing launch file that a system starts as it is."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from deros import codes
from deros.diagnostics import Diagnostic, report
from deros.generators.system.computed import Setting, Text, Variables
from deros.generators.system.files import FileView, file_view, parameter_file_view
from deros.generators.system.script.standalone.command_line import fits_command_line
from deros.models.arguments import Condition
from deros.models.common import Value
from deros.models.starting import AT_ONCE, Starting
from deros.models.system import System
from deros.systems.arguments.symbolic import as_written
from deros.systems.flat import FlatLaunch


@dataclass(frozen=True, slots=True)
class LaunchView:
    """One launch file to start.

    Attributes:
        file: where it is.
        launch_arguments: that it gets, as texts.
        namespace: for all nodes that it starts.
        environment: variables for all its programs.
        parameters: for all its nodes; one that they set themselves counts before.
        files: parameter files for all its nodes, which these read before.
        remappings: for all its nodes, the ones that count before others first.
        when: the condition of it in this form; ``None``: it is always started.
        starting: always with the system.
    """

    name: str
    file: FileView
    launch_arguments: tuple[tuple[str, Text], ...]
    namespace: Text
    environment: Variables
    parameters: tuple[tuple[str, Setting], ...]
    files: tuple[FileView, ...]
    remappings: tuple[tuple[Text, Text], ...]
    description: str
    when: Condition | None = None
    starting: Starting = AT_ONCE

    @property
    def is_node(self) -> bool:
        """Whether it is a node, and no other process."""
        return False


def launch_view(
    found: FlatLaunch,
    when: Condition | None,
    system: System,
    text: Callable[[str], Text],
    setting: Callable[[Value], Setting],
) -> LaunchView:
    """Return the view of a launch file.

    Args:
        found: the file at run time.
        when: the condition under which it is started.
        system: for which something is generated.
        text: returns what a text with marks of computed parts is made of.
        setting: the same, of the value of a parameter.
    """

    def written(marked: str) -> Text:
        return text(as_written(marked))

    return LaunchView(
        name=found.instance.name,
        file=file_view(found.launch, system, text),
        launch_arguments=tuple((e.name, written(e.value)) for e in found.launch.arguments),
        namespace=text(found.namespace),
        environment=tuple((each.name, written(each.value.text)) for each in found.environment),
        parameters=tuple((each.name, setting(each.value)) for each in found.parameters),
        files=tuple(parameter_file_view(each, system, text) for each in found.files),
        remappings=tuple((text(e.name), written(e.target)) for e in found.remappings),
        description=" ".join(found.instance.description.split()),
        when=when,
    )


def unsupported_launch(found: FlatLaunch) -> Iterator[Diagnostic]:
    """Yield why a launch file cannot be started as the model says."""
    for each in found.parameters:
        if each.xacro is not None:
            yield report(
                codes.UNSUPPORTED_BY_TARGET,
                f"'{each.name}' cannot be handed to '{found.launch.path}': xacro makes its value",
                each.value_span,
                "write it at the nodes that need it",
            )
            continue
        if fits_command_line(each.name) and each.value != ():
            continue
        what = f"'{each.name}' cannot be handed to '{found.launch.path}'"
        why = "launch passes the parameters of a group in the command lines of nodes"
        yield report(
            codes.UNSUPPORTED_BY_TARGET,
            f"{what}: {why}",
            each.name_span,
            "write it at the nodes that need it, or in a parameter file for the group",
        )


def is_launch_file(program: object) -> bool:
    """Return whether a program of a view is a launch file, for templates."""
    return isinstance(program, LaunchView)
