"""Checks of conditions that name actions: whether these can become active, and inactive again."""

from __future__ import annotations

from collections.abc import Iterator

from deros import codes
from deros.diagnostics import Diagnostic, Related, report
from deros.rules.program import ir, walk


def check_actions(program: ir.Program) -> Iterator[Diagnostic]:
    """Yield one finding per action that conditions name and whose state does not change."""
    places: dict[int, ir.Active] = {}
    for part in walk.conditions(program):
        if isinstance(part, ir.Active):
            places.setdefault(part.action, part)
    for index, part in places.items():
        action = program.actions[index]
        related = (Related(action.span, "declared here"),) if action.span else ()
        if not action.triggered_by:
            yield report(
                codes.NEVER_TRUE,
                f"'{action.name}' is never active: no behaviour triggers it",
                part.span,
                f"run '{action.name};' in a behaviour, or leave this out",
                related,
            )
        elif not action.latched and action.reset_by is None:
            yield report(
                codes.ALWAYS_TRUE,
                f"'{action.name}' is active for ever from the first time on that it is triggered:"
                " nothing resets it",
                part.span,
                f"declare '{action.name}' as 'latched' or with 'reset_by', or name the rules that"
                " trigger it",
                related,
            )
