"""Options that several commands share."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import click

Command = TypeVar("Command", bound=Callable[..., Any])


class FiniteRange(click.FloatRange):
    """A number within bounds; ``nan``, which no bound keeps out, is refused."""

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> float:
        """Return the number, or raise ``click.BadParameter``."""
        number = float(super().convert(value, param, ctx))
        if not math.isfinite(number):
            self.fail(f"{number} is not a finite number.", param, ctx)
        return number


def interfaces_option(command: Command) -> Command:
    """Add ``--interfaces PATH``, which may be given several times."""
    option = click.option(
        "--interfaces",
        "interfaces",
        multiple=True,
        metavar="PATH",
        type=click.Path(exists=True, file_okay=False, path_type=Path),
        help="Folder with .msg, .srv and .action files of packages; may be given several times.",
    )
    return option(command)


def output_option(command: Command) -> Command:
    """Add ``--output FOLDER`` of the commands that write files, by default into the current one."""
    option = click.option(
        "-o",
        "--output",
        type=click.Path(file_okay=False, path_type=Path),
        default=Path(),
        help="Folder to write to; created if it does not exist.  [default: the current folder]",
    )
    return option(command)


def domain_option(command: Command) -> Command:
    """Add ``--domain N`` of the commands that look at a running graph with ``--live``."""
    option = click.option(
        "--domain",
        type=click.IntRange(0, 232),
        help="With --live: domain of DDS.  [default: ROS_DOMAIN_ID, or 0]",
    )
    return option(command)


def timeout_option(command: Command) -> Command:
    """Add ``--timeout SECONDS`` of the commands that talk to running nodes."""
    option = click.option(
        "--timeout",
        metavar="SECONDS",
        type=FiniteRange(min=0, max=3600, min_open=True),
        default=5.0,
        show_default=True,
        help="Time to find the nodes and to wait for what they say.",
    )
    return option(command)


def settling_option(text: str) -> Callable[[Command], Command]:
    """Add ``--timeout SECONDS`` of the commands that wait until the graph stays the same.

    Args:
        text: what help says of it.
    """
    return click.option(
        "--timeout",
        metavar="SECONDS",
        type=FiniteRange(min=0, max=3600, min_open=True),
        default=30.0,
        show_default=True,
        help=text,
    )


def node_argument(command: Command) -> Command:
    """Add the argument ``[NODE]``, which becomes a full name; ``None`` if it is left out."""
    return click.argument("node", required=False, callback=_full_name)(command)


def _full_name(ctx: click.Context, param: click.Parameter, name: str | None) -> str | None:
    from deros.names.graph_names import resolve_name
    from deros.names.names import check_topic_name

    if name is None:
        return None
    if name.startswith("~") or (why := check_topic_name(name)):
        why = "is not a full node name" if name.startswith("~") else why
        raise click.BadParameter(f"'{name}' {why}", ctx, param)
    return resolve_name(name, "/")


def grace_option(command: Command) -> Command:
    """Add ``--grace T``, in seconds, which is passed on in nanoseconds."""
    option = click.option(
        "--grace",
        "grace_ns",
        metavar="T",
        default="0",
        show_default=True,
        callback=seconds_option,
        help="How many seconds inputs may be late at startup, like 'startup_grace' of the node.",
    )
    return option(command)


def seconds_option(ctx: click.Context, parameter: click.Parameter, value: str | None) -> int | None:
    """Read the value of an option as a time in seconds, which is returned in nanoseconds."""
    del ctx, parameter
    if value is None:
        return None
    from deros.simulation.trace import nanoseconds

    t_ns = nanoseconds(value)
    if t_ns is None:
        raise click.BadParameter(f"'{value}' is not a time in seconds, such as 12.5")
    return t_ns


def dry_run_option(command: Command) -> Command:
    """Add ``--dry-run`` of the commands that start programs."""
    option = click.option("--dry-run", is_flag=True, help="Print the commands that would be run.")
    return option(command)


def stop_timeout_option(command: Command) -> Command:
    """Add ``--stop-timeout SECONDS`` of these."""
    option = click.option(
        "--stop-timeout",
        metavar="SECONDS",
        default="5",
        show_default=True,
        help="Time to end after SIGINT, and again after SIGTERM.",
    )
    return option(command)
