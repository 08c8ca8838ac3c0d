"""What launch files in XML and YAML have no way to say."""

from __future__ import annotations

from collections.abc import Iterator

from deros import codes
from deros.diagnostics import Diagnostic, Span, report
from deros.generators.system.view import SystemView
from deros.models.launch_files import LaunchDocument
from deros.models.system import System
from deros.systems.arguments.symbolic import SymbolicSystem
from deros.systems.flat import FlatLaunch, FlatNode, FlatProgram
from deros.systems.flatten import flatten

_INSTEAD = (
    "start the system with the launch file in Python ('--target launch'), 'deros up' or the script"
)


def unsupported_in_frontends(model: System, view: SystemView) -> Iterator[Diagnostic]:
    """Yield what cannot be started as the model says, each place once."""
    if not (view.brings_up or view.starts_later or (view.arguments and any(view.launches))):
        return  # as mostly: to expand the model once more would take as long as the view
    reported: set[Span] = set()
    for program in _programs(model):
        for finding in _unsupported(program, view):
            if finding.span not in reported:
                reported.add(finding.span)
                yield finding


def _programs(model: System) -> Iterator[FlatProgram]:
    if not model.is_computed:
        yield from flatten(model).programs
        return
    yield from (each.node for each in SymbolicSystem(model).nodes)


def _unsupported(program: FlatProgram, view: SystemView) -> Iterator[Diagnostic]:
    if isinstance(program, FlatLaunch):
        yield from _leaking(program, view)
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
    if instance.starting.is_later:
        what = "after the exit of another program" if instance.starting.after else "after a delay"
        yield report(
            codes.UNSUPPORTED_BY_TARGET,
            f"launch files in XML and YAML cannot start '{instance.name}' {what}",
            instance.name_span,
            _INSTEAD,
        )


def _leaking(program: FlatLaunch, view: SystemView) -> Iterator[Diagnostic]:
    """Yield that a launch file would see arguments of the system without being given them."""
    launch = program.launch
    found = launch.load()
    given = {each.name for each in launch.arguments}
    seen = [each.name for each in view.arguments if each.name not in given]
    why = "cannot be read now, and may use them"
    if isinstance(found, LaunchDocument):
        used = [name for name in seen if name in found.arguments or name in found.used]
        seen = used if used or found.is_complete else seen
        why = "uses arguments of these names" if used else "may include what uses them"
    if seen:
        listed = ", ".join(map(repr, seen))
        yield report(
            codes.UNSUPPORTED_BY_TARGET,
            f"in XML and YAML, '{launch.path}' would see the system's {listed}: it {why}",
            launch.path_span,
            f"give values here, as in ({seen[0]} = ${seen[0]}), rename the arguments of the"
            " system, or use the launch file in Python ('--target launch')",
        )
