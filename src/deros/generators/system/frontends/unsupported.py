"""What launch files in XML and YAML have no way to say."""

from __future__ import annotations

from collections.abc import Iterator

from deros import codes
from deros.diagnostics import Diagnostic, Span, report
from deros.generators.system.view import SystemView
from deros.models.system import System
from deros.systems.arguments.symbolic import SymbolicSystem
from deros.systems.flat import FlatLaunch, FlatNode, FlatProgram
from deros.systems.flatten import flatten

_INSTEAD = (
    "start the system with the launch file in Python ('--target launch'), 'deros up' or the script"
)


def unsupported_in_frontends(model: System, view: SystemView) -> Iterator[Diagnostic]:
    """Yield what cannot be started as the model says, each place once."""
    if not (view.brings_up or view.starts_later):
        return  # as mostly: to expand the model once more would take as long as the view
    reported: set[Span] = set()
    for program in _programs(model):
        for finding in _unsupported(program):
            if finding.span not in reported:
                reported.add(finding.span)
                yield finding


def _programs(model: System) -> Iterator[FlatProgram]:
    if not model.is_computed:
        yield from flatten(model).programs
        return
    yield from (each.node for each in SymbolicSystem(model).nodes)


def _unsupported(program: FlatProgram) -> Iterator[Diagnostic]:
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
    if instance.starting.is_later:
        what = "after the exit of another program" if instance.starting.after else "after a delay"
        yield report(
            codes.UNSUPPORTED_BY_TARGET,
            f"launch files in XML and YAML cannot start '{instance.name}' {what}",
            instance.name_span,
            _INSTEAD,
        )
