"""``deros reset``: reset a running safety node or gate."""

from __future__ import annotations

import sys
import time
from typing import TYPE_CHECKING

import click

from deros.cli.options import node_argument, timeout_option
from deros.cli.streams import say
from deros.pipeline.outcome import CLEAN, FINDINGS, UNUSABLE

if TYPE_CHECKING:
    from deros.live.observer import Observer


@click.command(
    epilog="Exit codes: 0 if the reset was granted, 1 if it was refused, 2 if there is no such "
    "node or it did not answer in time."
)
@node_argument
@timeout_option
@click.pass_context
def reset(ctx: click.Context, node: str | None, timeout: float) -> None:
    """Reset the running safety node or gate NODE, and print its answer.

    A reset lets the robot move again as soon as nothing else holds it, so look at the robot first.
    The node decides: it refuses while a cause of the stop holds. NODE is a full name, such as
    /robot_safety_node or /front/cmd_vel_gate. Without NODE, those that have a reset are listed.
    """
    from deros.live.observer import Observer, RosUnavailableError

    try:
        with Observer() as observer:
            code = _list(observer, timeout) if node is None else _reset(observer, node, timeout)
    except RosUnavailableError as error:
        raise click.ClickException(str(error)) from error
    ctx.exit(code)


def _list(observer: Observer, timeout: float) -> int:
    from deros.live.resets import Resettable

    deadline = time.monotonic() + timeout
    nodes = observer.settled(Resettable(observer).nodes, deadline)
    if not nodes:
        say(f"deros: no node with a reset was found within {timeout:g} s", to=sys.stderr)
        return UNUSABLE
    say("\n".join(nodes))
    return CLEAN


def _reset(observer: Observer, node: str, timeout: float) -> int:
    from deros.live.resets import NoAnswerError, reset

    try:
        answer = reset(observer, node, timeout)
    except NoAnswerError as error:
        say(f"deros: {error}", to=sys.stderr)
        return UNUSABLE
    say(answer.message)
    return CLEAN if answer.granted else FINDINGS
