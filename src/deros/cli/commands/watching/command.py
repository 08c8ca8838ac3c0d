"""``deros watch``: the verdicts, actions, gates and events of a running robot, as they change."""

from __future__ import annotations

import contextlib
import json
import signal
import sys
import time
from collections.abc import Callable, Iterator
from datetime import datetime
from functools import partial
from typing import TYPE_CHECKING

import click

from deros.cli.commands.watching.layout import write_layout
from deros.cli.commands.watching.table import picture
from deros.cli.options import FiniteRange, node_argument, timeout_option
from deros.cli.streams import console, say
from deros.pipeline.outcome import CLEAN, UNUSABLE

if TYPE_CHECKING:
    from rich.console import Console

    from deros.live.changes import Change
    from deros.live.observer import Observer
    from deros.live.watcher import Watcher

_PAUSE_S = 0.1
"""Seconds between two pictures at least."""

_IDLE_S = 0.5
"""Seconds after which a picture is drawn anew without a message: times and silence go on."""


@click.command(
    epilog="Exit codes: 0 after Ctrl-C, or with --once or --foxglove when that is written; 2 if "
    "no node reported in time, or the file cannot be written."
)
@node_argument
@timeout_option
@click.option("--once", is_flag=True, help="Show everything once, as a table or object, and end.")
@click.option(
    "--events",
    metavar="N",
    type=click.IntRange(min=0, max=1000),
    default=5,
    show_default=True,
    help="How many of the last events are shown; without a terminal, how many of those before the "
    "start.",
)
@click.option(
    "--silence",
    metavar="SECONDS",
    type=FiniteRange(min=0, max=3600, min_open=True),
    default=3.0,
    show_default=True,
    help="Time without a report after which a node is shown as silent; more than the period of "
    "its diagnostics.",
)
@click.option(
    "--format",
    "form",
    type=click.Choice(["text", "json"]),
    default="text",
    show_default=True,
    help="Text for people, or one JSON object a line for each change.",
)
@click.option(
    "--foxglove",
    metavar="FILE",
    type=click.Path(dir_okay=False, allow_dash=True),
    help="Write a Foxglove layout for the safety nodes that run and end; - is standard output.",
)
@click.pass_context
def watch(
    ctx: click.Context,
    node: str | None,
    timeout: float,
    once: bool,
    events: int,
    silence: float,
    form: str,
    foxglove: str | None,
) -> None:
    """Watch the running safety nodes and gates until Ctrl-C.

    Each rule's verdict with the values that it reads and what it becomes next, how old inputs are,
    which actions are active and why, what gates do, which nodes have gone silent, and the last
    events: all from /diagnostics and the topics of
    events, so no file of the robot is needed. On a terminal it is a table; otherwise each change is
    a line. With NODE, a full name, only that one is shown.
    """
    from deros.live.observer import Observer, RosUnavailableError
    from deros.live.watcher import Watcher

    try:
        with Observer() as observer:
            watcher = Watcher(observer, node, silence)
            if once or foxglove:
                watcher.settle(timeout)
            else:
                deadline = time.monotonic() + timeout
                observer.until(lambda: watcher.listen() and watcher.has_reports(), deadline)
            if foxglove:
                write_layout(watcher, node, foxglove)
            elif not watcher.has_reports():
                _fail(ctx, observer, watcher, node, timeout)
            elif once:
                _show_once(watcher, events, form)
            else:
                _follow(observer, watcher, events, form)
    except RosUnavailableError as error:
        raise click.ClickException(str(error)) from error
    ctx.exit(CLEAN)


def _fail(
    ctx: click.Context, observer: Observer, watcher: Watcher, node: str | None, timeout: float
) -> None:
    from deros.cli.commands.state import missing_report
    from deros.live.states import RobotState

    robot = RobotState((), watcher.silent())
    say(f"deros: {missing_report(observer, node, robot, timeout)}", to=sys.stderr)
    ctx.exit(UNUSABLE)


def _follow(observer: Observer, watcher: Watcher, events: int, form: str) -> None:
    """Show what is and what changes until a signal comes."""
    screen = console()
    with _interrupt() as is_over:
        if form == "text" and screen.is_terminal and not screen.is_dumb_terminal:
            _draw(observer, watcher, events, screen, is_over)
        else:
            _print(observer, watcher, events, form, is_over)


def _draw(
    observer: Observer,
    watcher: Watcher,
    events: int,
    screen: Console,
    is_over: Callable[[], bool],
) -> None:
    """Draw the table on the terminal's second screen; the last one stays on the first."""
    from rich.live import Live

    with Live(console=screen, screen=True, auto_refresh=False) as live:

        def draw() -> None:
            width, height = screen.size
            now = picture(watcher.nodes(), watcher.events(), events, width, height)
            live.update(now, refresh=True)

        _turns(observer, watcher, draw, is_over)
    screen.print(picture(watcher.nodes(), watcher.events(), events, screen.width, None))


def _print(
    observer: Observer, watcher: Watcher, events: int, form: str, is_over: Callable[[], bool]
) -> None:
    """Print a line for each change."""
    from deros.live.changes import Changes

    changes = Changes(events)

    def show() -> None:
        nodes = watcher.nodes()
        moment = datetime.now().astimezone()
        for change in changes.states(nodes):
            _say_change(change, moment, form)
        complete = watcher.watched.complete()
        for node in nodes:
            if node.node in complete:
                total = watcher.watched.event_total(node.node)
                for change in changes.events(node.node, watcher.watched.events(node.node), total):
                    _say_change(change, moment, form)

    _turns(observer, watcher, show, is_over)


def _say_change(change: Change, moment: datetime, form: str) -> None:
    if form == "json":
        shown = {"time": moment.isoformat(timespec="milliseconds"), **change.as_object()}
        say(json.dumps(shown, ensure_ascii=False))
    else:
        say(f"{moment:%H:%M:%S}.{moment.microsecond // 1000:03}  {change.line()}")


def _turns(
    observer: Observer, watcher: Watcher, show: Callable[[], None], is_over: Callable[[], bool]
) -> None:
    """Call ``show`` at each message, but seldom enough, and now and then without one."""
    while not is_over():
        seen = watcher.listen()
        show()
        observer.until(is_over, time.monotonic() + _PAUSE_S)
        due = time.monotonic() + _IDLE_S
        observer.until(partial(_is_due, watcher, seen, is_over), due)


def _is_due(watcher: Watcher, seen: int, is_over: Callable[[], bool]) -> bool:
    return is_over() or watcher.listen() != seen


def _show_once(watcher: Watcher, events: int, form: str) -> None:
    from deros.live.changes import as_object, event_change

    nodes, every = watcher.nodes(), watcher.events()
    if form == "json":
        shown = {
            "nodes": [as_object(node) for node in nodes],
            "silent": watcher.silent(),
            "events": [
                event_change(event).as_object() for event in every[max(len(every) - events, 0) :]
            ],
        }
        say(json.dumps(shown, indent=2, ensure_ascii=False))
    else:
        screen = console()
        width = screen.width if screen.is_terminal else None
        screen.print(picture(nodes, every, events, width, None))


@contextlib.contextmanager
def _interrupt() -> Iterator[Callable[[], bool]]:
    """Give a function that says whether SIGINT or SIGTERM has come; they end nothing else.

    The terminal's first screen has to come back before the process ends.
    """
    came: list[int] = []
    before = {each: signal.getsignal(each) for each in (signal.SIGINT, signal.SIGTERM)}
    for each, handler in before.items():
        if handler is not signal.SIG_IGN:
            signal.signal(each, lambda number, _: came.append(number))
    try:
        yield lambda: bool(came)
    finally:
        for each, handler in before.items():
            signal.signal(each, handler)
    if signal.SIGTERM in came:
        raise SystemExit(128 + signal.SIGTERM)
