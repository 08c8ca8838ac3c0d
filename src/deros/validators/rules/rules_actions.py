"""Checks of actions: whether those that conditions name change, and whether gates see them."""

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


def check_hidden(program: ir.Program) -> Iterator[Diagnostic]:
    """Yield the lines of gates that do not apply while the state of their action is hidden.

    Where active actions share a field of a topic, it has the value of the one declared first.
    """
    for gate in program.gates:
        for index, line in enumerate(gate.lines):
            if line.action is None:
                continue
            hidden = program.actions[line.action]
            for other in program.actions[: hidden.index]:
                shown = {each.index for each in program.actions if each.binding == other.binding}
                if _hides(other, hidden) and not _is_idle(gate, index, shown):
                    yield _hidden(line, hidden, other)
                    break


def _hides(other: ir.Action, hidden: ir.Action) -> bool:
    """Return whether an action, declared before another one, hides that while both are active."""
    shown, own = other.binding, hidden.binding
    if shown is None or own is None or not other.triggered_by:
        return False
    return (shown.topic, shown.path) == (own.topic, own.path) and shown.value != own.value


def _is_idle(gate: ir.Gate, index: int, shown: set[int]) -> bool:
    """Return whether a line may be left out while the state topics show some actions active.

    The gate then does what it does without the line, or stops at once.
    """
    line, before = gate.lines[index], gate.lines[:index]
    if line.wait_ns is None and any(each.action in shown and each.stop for each in before):
        return True
    limited = {each.path for other in before if other.action in shown for each in other.limits}
    if line.limits and limited.issuperset(each.path for each in line.limits):
        return True
    lines = [each for each in gate.lines if not each.is_standing and each.wait_ns is None]
    stopping = next((each for each in lines if each.action in shown and each.stop), None)
    if stopping is None:
        return False
    stop = stopping.stop
    return all(
        each.stop == stop
        or (each.action == line.action and stop == ir.Stop() and not (each.stop and each.stop.sent))
        for each in lines[: lines.index(stopping)]
    )


def _hidden(line: ir.GateLine, hidden: ir.Action, other: ir.Action) -> Diagnostic:
    topic = hidden.binding.topic if hidden.binding is not None else ""
    places = ((other, "declared first"), (hidden, "declared after it"))
    return report(
        codes.HIDDEN_ACTION,
        f"while '{other.name}' is active, too, '{topic}' does not show '{hidden.name}', and this"
        " line does not apply",
        line.span,
        f"let '{hidden.name}' publish on a topic of its own, or declare it before '{other.name}'",
        tuple(Related(each.span, text) for each, text in places if each.span is not None),
    )
