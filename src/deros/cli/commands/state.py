"""``deros state``: what the safety nodes and gates of a running robot report."""

from __future__ import annotations

import dataclasses
import json
import sys
from collections.abc import Iterator
from typing import TYPE_CHECKING

import click

from deros.cli.options import node_argument, timeout_option
from deros.cli.streams import console, say
from deros.pipeline.outcome import CLEAN, FINDINGS, UNUSABLE

if TYPE_CHECKING:
    from deros.live.observer import Observer
    from deros.live.states import ActiveAction, NodeState, RobotState

_HEADER = ("NODE", "LEVEL", "STATE", "SINCE")
_SILENT = ("unknown", "runs, but has not reported in time")
_STYLES = {"ok": "green", "warning": "yellow", "active": "yellow"}


@click.command(
    epilog="Exit codes: 0 if every level is ok and no action is active, 1 if not, or if a node "
    "that runs does not report, 2 if none reported in time."
)
@node_argument
@timeout_option
@click.option(
    "--format",
    "form",
    type=click.Choice(["text", "json"]),
    default="text",
    show_default=True,
    help="A table for people, or one JSON object.",
)
@click.pass_context
def state(ctx: click.Context, node: str | None, timeout: float, form: str) -> None:
    """Show what the running safety nodes and gates report: what is active, why, and since when.

    A gate says which of its lines apply, and whether it waits for a reset or a zero command; a
    safety node, which actions are active and what caused them. With NODE, a full name, only that
    one is waited for and shown.
    """
    from deros.live.observer import Observer, RosUnavailableError
    from deros.live.states import robot_state

    try:
        with Observer() as observer:
            robot = robot_state(observer, node, timeout)
            missing = "" if robot.nodes else missing_report(observer, node, robot, timeout)
    except RosUnavailableError as error:
        raise click.ClickException(str(error)) from error
    if missing:
        say(f"deros: {missing}", to=sys.stderr)
        ctx.exit(UNUSABLE)
    show(robot, form)
    ctx.exit(CLEAN if robot.is_clear else FINDINGS)


def show(robot: RobotState, form: str) -> None:
    """Write a state to standard output, as ``text`` or ``json``."""
    if form == "json":
        say(json.dumps(dataclasses.asdict(robot), indent=2, ensure_ascii=False))
    else:
        _show_table(robot)


def _show_table(robot: RobotState) -> None:
    from rich.table import Table
    from rich.text import Text

    table = Table(*_HEADER, box=None, pad_edge=False)
    for name, level, *cells in rows(robot):
        style = _STYLES.get(level, "red")
        table.add_row(Text(name), Text(level, style), *map(Text, cells))
    console().print(table)


def rows(robot: RobotState) -> Iterator[tuple[str, str, str, str]]:
    """Yield the rows of the table: each node, with its active actions below it."""
    for each in robot.nodes:
        yield _row(each)
        yield from map(_action_row, each.actions)
    for name in robot.silent:
        yield name, *_SILENT, ""


def _row(each: NodeState) -> tuple[str, str, str, str]:
    return each.node, each.level, each.message, each.since


def _action_row(action: ActiveAction) -> tuple[str, str, str, str]:
    why = ": ".join(filter(None, (action.behaviour, action.because)))
    return f"  action {action.name}", "active", why, action.since


def missing_report(observer: Observer, node: str | None, robot: RobotState, timeout: float) -> str:
    """Return why there is no report, in words for the user."""
    from deros.live.graph import did_you_mean, reporting_nodes

    if robot.silent:
        return f"no report within {timeout:g} s of {', '.join(robot.silent)}"
    if node is None:
        return f"no safety node and no gate reported within {timeout:g} s (see ROS_DOMAIN_ID)"
    hint = did_you_mean(node, reporting_nodes(observer))
    return f"no node {node} reported within {timeout:g} s" + (f"; {hint}" if hint else "")
