"""What is started later in a launch file, and what it waits for."""

from __future__ import annotations

from collections.abc import Collection

from deros.generators.system.literals import python_literal
from deros.generators.system.view import GroupView, ProgramView, SystemView


def awaited_names(view: SystemView) -> frozenset[str]:
    """Return the names, with subsystems, of which one may be that of an awaited program."""
    return frozenset(
        "/".join((*group.path[:depth], each.starting.awaited))
        for group in view.groups
        for each in group.programs
        if each.starting.after is not None
        for depth in range(len(group.path) + 1)
    )


def first_start(program: ProgramView, group: GroupView, awaited: Collection[str]) -> str:
    """Return what follows the action of a program that waits or is waited for: the rest of a call.

    Args:
        program: to start.
        group: that it is in.
        awaited: what :func:`awaited_names` returns.
    """
    name = "/".join((*group.path, program.name))
    starting = program.starting
    if not starting.is_later and name not in awaited:
        return ""
    after = f", after={python_literal(starting.awaited)}" if starting.after else ""
    delay = f", delay={starting.delay_s!r}" if starting.delay else ""
    return f", {python_literal(name)}{after}{delay})"
