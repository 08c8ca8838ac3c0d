"""What launch files in XML and YAML have no way to say."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from deros import codes
from deros.diagnostics import Diagnostic, Span, report
from deros.generators.system.expanded import programs_in
from deros.generators.system.launch.inside import is_addressed
from deros.generators.system.launch.quoting import NO_TEXT, misread_texts
from deros.generators.system.launched import LaunchView
from deros.generators.system.view import ProgramView, SystemView
from deros.models.programs import ProcessInstance
from deros.models.system import Subsystem, System
from deros.systems.flat import FlatLaunch, FlatNode, FlatProcess, FlatProgram
from deros.systems.groups import groups_of, members_of

_Misread = Mapping[str, tuple[str, str]]
"""By the names of nodes: a parameter, and its text that ROS 2 would read as something else."""
_INSTEAD = (
    "start the system with the launch file in Python ('--target launch'), 'deros up' or the script"
)


def unsupported_in_frontends(model: System, view: SystemView) -> Iterator[Diagnostic]:
    """Yield what cannot be started as the model says, each place once."""
    needs_more = view.brings_up or view.starts_later or view.makes_files
    misread: dict[str, tuple[str, str]] = {}
    for node, name, found in misread_texts(view.nodes, {e.name: e for e in view.arguments}):
        if isinstance(found, str):
            misread.setdefault(node.name, (name, found))
    if not (needs_more or misread or any(map(_is_addressed, view.programs))):
        return  # as mostly: to expand the model once more would take as long as the view
    reported: set[Span] = set()
    for finding in _all_unsupported(model, misread):
        if finding.span not in reported:
            reported.add(finding.span)
            yield finding


def _is_addressed(program: ProgramView) -> bool:
    return not isinstance(program, LaunchView) and is_addressed(program)


def _all_unsupported(model: System, misread: _Misread) -> Iterator[Diagnostic]:
    for program in programs_in(model):
        yield from _unsupported(program, misread)
    for group in _groups(model):
        members = (each for each in members_of(group) if not isinstance(each, ProcessInstance))
        for file in (*group.files, *(file for each in members for file in each.files)):
            if file.below or file.plain or file.given is not None:
                message = "launch files in XML and YAML hand parameter files on as they are"
                yield report(codes.UNSUPPORTED_BY_TARGET, message, file.path_span, _INSTEAD)
        for made in group.made:
            message = "launch files in XML and YAML make no files before they start programs"
            yield report(codes.UNSUPPORTED_BY_TARGET, message, made.name_span, _INSTEAD)


def _groups(system: System) -> Iterator[System | Subsystem]:
    """Yield the groups of a system, and of those that it uses."""
    for _, group in groups_of(system):
        yield group
        if isinstance(group, Subsystem) and group.system is not None:
            yield from _groups(group.system)


def _unsupported(program: FlatProgram, misread: _Misread) -> Iterator[Diagnostic]:
    if isinstance(program, FlatLaunch):
        return
    instance = program.instance
    if isinstance(program, FlatNode):
        if program.launch is not None:
            return
        if program.autostart is not None:
            yield report(
                codes.UNSUPPORTED_BY_TARGET,
                f"launch files in XML and YAML do not bring '{instance.name}' to active",
                instance.name_span,
                _INSTEAD + ", or have a lifecycle manager in the system",
            )
        if instance.name in misread:
            name, text = misread[instance.name]
            yield report(
                codes.UNSUPPORTED_BY_TARGET,
                f"launch files in XML and YAML put no quotes around the text '{text}' of parameter"
                f" '{name}': {NO_TEXT}",
                instance.name_span,
                _INSTEAD,
            )
        if program.inside or (program.instance.own_name is not None and program.files):
            yield _addressed(program)
    elif program.inside:
        yield _addressed(program)
    if instance.starting.is_later:
        what = "after the exit of another program" if instance.starting.after else "after a delay"
        if instance.starting.ready is not None:
            what = "when something is in the ROS graph"
        yield report(
            codes.UNSUPPORTED_BY_TARGET,
            f"launch files in XML and YAML cannot start '{instance.name}' {what}",
            instance.name_span,
            _INSTEAD,
        )


def _addressed(program: FlatNode | FlatProcess) -> Diagnostic:
    return report(
        codes.UNSUPPORTED_BY_TARGET,
        "launch files in XML and YAML cannot give parameters to one of several nodes of"
        f" '{program.instance.name}'",
        program.instance.name_span,
        _INSTEAD,
    )
