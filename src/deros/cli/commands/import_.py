"""``deros import``: write models of a robot that runs."""

from __future__ import annotations

import sys
from collections.abc import Collection
from pathlib import Path
from typing import TYPE_CHECKING

import click

from deros.cli.interrupts import held
from deros.cli.options import interfaces_option
from deros.cli.streams import say
from deros.pipeline.outcome import CLEAN, FINDINGS, UNUSABLE

if TYPE_CHECKING:
    from deros.live.snapshots import Snapshot


@click.command(
    "import",
    epilog="Exit codes: 0 if the models say all that was seen, 1 if something is left out or a "
    "file was edited, 2 if there is nothing to import or it cannot be written.",
)
@click.option("--live", is_flag=True, help="From the running graph of ROS 2.")
@click.option(
    "-o",
    "--output",
    type=click.Path(file_okay=False, path_type=Path),
    default=Path(),
    help="Folder to write to; created if it does not exist.  [default: the current folder]",
)
@click.option("--name", default="robot", show_default=True, help="Name of the system.")
@click.option(
    "--domain",
    type=click.IntRange(0, 232),
    help="Domain of DDS.  [default: ROS_DOMAIN_ID, or 0]",
)
@click.option(
    "--node",
    "pattern",
    metavar="PATTERN",
    default="*",
    help="Only nodes whose full names match, as in '/left/*'.",
)
@click.option(
    "--timeout",
    metavar="SECONDS",
    type=click.FloatRange(min=0, max=3600, min_open=True),
    default=30.0,
    show_default=True,
    help="Time for the graph to stay the same.",
)
@interfaces_option
@click.pass_context
def import_(
    ctx: click.Context,
    live: bool,
    output: Path,
    name: str,
    domain: int | None,
    pattern: str,
    timeout: float,
    interfaces: tuple[Path, ...],
) -> None:
    """Write what runs as node descriptions and a system that check clean.

    The graph is read until it stays the same for three seconds. Each file has two parts: the next
    import keeps what you write in the upper one, and replaces the lower one.
    """
    from deros.names.names import check_identifier

    if not live:
        raise click.UsageError("say what to import: --live is the running graph")
    if fault := check_identifier(name):
        raise click.UsageError(f"'{name}' cannot be the name of a system: it {fault}")
    seen = _seen(domain, pattern, timeout)
    if not seen.nodes:
        say(f"deros: no node was found within {timeout:g} s (see ROS_DOMAIN_ID)", to=sys.stderr)
        ctx.exit(UNUSABLE)
    ctx.exit(_write(seen, output, name, interfaces))


def _seen(domain: int | None, pattern: str, timeout: float) -> Snapshot:
    from deros.live.looks import UnsteadyGraphError, snapshot
    from deros.live.observer import Observer, RosUnavailableError

    try:
        with Observer(domain) as observer:
            return snapshot(observer, pattern, timeout)
    except (RosUnavailableError, UnsteadyGraphError) as error:
        raise click.ClickException(str(error)) from error


def _write(seen: Snapshot, output: Path, name: str, interfaces: tuple[Path, ...]) -> int:
    """Write the models of a snapshot; return the exit code."""
    from deros.generators.output.writer import Outcome, WriteError, write
    from deros.importers.kept import ASIDE, renewed
    from deros.importers.node_types import imported
    from deros.importers.texts import files
    from deros.interfaces.store import InterfaceStore

    graph = imported(seen, InterfaceStore(interfaces).exists)
    parts = files(graph, name)
    try:
        with held():
            new = renewed(parts, output)
            report = write(new.files, output)
    except OSError as error:
        raise click.ClickException(f"cannot read {error.filename}: {error.strerror}") from error
    except WriteError as error:
        raise click.ClickException(str(error)) from error
    for path in report.of(Outcome.WRITTEN):
        say(f"wrote {output / path}")
    for path in new.edited:
        say(
            f"kept {output / path}: what is from the graph was edited there; compare it with "
            f"{path}{ASIDE}"
        )
    for path in _no_longer_seen(output, parts):
        say(f"kept {output / path}: no node of this type runs now")
    if graph.problems:
        say("not in the models:")
    for problem in graph.problems:
        say(f"  {problem}")
    say(f"next: deros check {output / name}.system")
    return FINDINGS if graph.problems or new.edited else CLEAN


def _no_longer_seen(output: Path, parts: Collection[str]) -> list[str]:
    """Return the node descriptions that are there and not among the imported ones."""
    there = (f"nodes/{path.name}" for path in (output / "nodes").glob("*.rnd"))
    return sorted(path for path in there if path not in parts)
