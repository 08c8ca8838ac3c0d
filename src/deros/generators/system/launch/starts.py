"""What is started later in a launch file, and what it waits for."""

from __future__ import annotations

from collections.abc import Callable, Collection

from deros.generators.system.computed import Text
from deros.generators.system.launched import LaunchView
from deros.generators.system.literals import python_literal
from deros.generators.system.view import GroupView, ProgramView, SystemView
from deros.generators.system.waiting.wait_view import WaitView


def awaited_names(view: SystemView) -> frozenset[str]:
    """Return the names, with subsystems, of which one may be that of an awaited program."""
    return (
        frozenset(  # those of exits, and of nodes that have to be in the graph
            "/".join((*group.path[:depth], each.starting.awaited))
            for group in view.groups
            for each in group.programs
            if each.starting.after is not None
            for depth in range(len(group.path) + 1)
        )
        | {each.owner for each in view.waits if each.owner}
    )


def first_start(
    program: ProgramView, group: GroupView, awaited: Collection[str], text: Callable[[Text], str]
) -> str:
    """Return what follows the action of a program that waits or is waited for: the rest of a call.

    Args:
        program: to start.
        group: that it is in.
        awaited: what :func:`awaited_names` returns.
        text: writes a text as Python.
    """
    name = "/".join((*group.path, program.name))
    starting = program.starting
    if not starting.is_later and name not in awaited:
        return ""
    after = f", after={python_literal(starting.awaited)}" if starting.after else ""
    delay = f", delay={starting.delay_s!r}" if starting.delay else ""
    wait = None if isinstance(program, LaunchView) else program.wait
    ready = "" if wait is None else f", ready={_graph_wait(wait, text)}"
    return f", {python_literal(name)}{after}{delay}{ready})"


def _graph_wait(wait: WaitView, text: Callable[[Text], str]) -> str:
    """Return the object that waits for something in the ROS graph."""
    given = [python_literal(wait.ready.kind), text(wait.name), repr(wait.ready.timeout_s)]
    given += [f"owner={python_literal(wait.owner)}"] if wait.owner else []
    given += ["restarts=True"] if wait.owner and wait.restarts else []
    return f"GraphWait({', '.join(given)})"


def kinds_of(view: SystemView) -> frozenset[str]:
    """Return the kinds of what programs wait for in the ROS graph."""
    return frozenset(each.ready.kind for each in view.waits)
