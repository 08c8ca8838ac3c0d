"""``deros verify``: compare what runs with what a system says."""

from __future__ import annotations

import json
import sys
from contextlib import closing
from dataclasses import dataclass
from datetime import datetime, timezone
from pathlib import Path
from typing import TYPE_CHECKING

import click

from deros.cli.interrupts import stopped_by_signals
from deros.cli.options import domain_option, interfaces_option, seconds_option, settling_option
from deros.cli.streams import say
from deros.cli.systems import checked_system, system_as_started
from deros.pipeline.outcome import CLEAN, FINDINGS
from deros.report.text import counted

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from deros.live.snapshots import Snapshot
    from deros.live.verify.differences import Difference, Kind
    from deros.live.verify.expectation import Expectation
    from deros.live.verify.graces import Event


def _graces(
    ctx: click.Context, parameter: click.Parameter, words: tuple[str, ...]
) -> dict[Kind, int]:
    """Read ``KIND=SECONDS``, several times; return nanoseconds."""
    from deros.live.verify.differences import KINDS_BY_WORD
    from deros.names.names import did_you_mean, near

    found = {}
    for word in words:
        kind, _, time = word.partition("=")
        if kind not in KINDS_BY_WORD:
            hint = did_you_mean(near(kind, KINDS_BY_WORD)) or f"one of {', '.join(KINDS_BY_WORD)}"
            raise click.BadParameter(f"'{kind}' is no kind of difference: {hint}", ctx, parameter)
        seconds = seconds_option(ctx, parameter, time)
        assert seconds is not None
        found[KINDS_BY_WORD[kind]] = seconds
    return found


@click.command(
    epilog="Exit codes: 0 if what runs is what the system says, 1 if something differs or the "
    "model has errors, 2 if an argument is wrong or the graph cannot be read."
)
@click.argument("file", type=click.Path())
@click.argument("arguments", nargs=-1)
@click.option("--live", is_flag=True, help="Compare with the running graph of ROS 2.")
@domain_option
@settling_option("Time for the graph to stay the same; after that it is compared as it is.")
@click.option(
    "--except",
    "excluded",
    multiple=True,
    metavar="NODE",
    help="Leave a node out: a full name, or a pattern such as '/front/*'; may be given several "
    "times.",
)
@click.option(
    "--install",
    multiple=True,
    metavar="DIR",
    type=click.Path(exists=True, file_okay=False),
    help="Look for packages in this install space, before those of AMENT_PREFIX_PATH; may be "
    "given several times.",
)
@click.option(
    "--watch",
    is_flag=True,
    help="Keep looking, and report each difference that lasts, and its end.",
)
@click.option(
    "--grace",
    "graces_ns",
    multiple=True,
    metavar="KIND=SECONDS",
    callback=_graces,
    help="With --watch: how long a difference has to last, as in 'missing-node=10'; may be given "
    "several times.",
)
@click.option(
    "--diagnostics",
    is_flag=True,
    help="With --watch: publish what is reported on /diagnostics, each second.",
)
@click.option(
    "--format",
    "form",
    type=click.Choice(["text", "json"]),
    default="text",
    show_default=True,
    help="Lines to read, or JSON; with --watch, one object for each line.",
)
@interfaces_option
@click.pass_context
def verify(
    ctx: click.Context,
    file: str,
    arguments: tuple[str, ...],
    live: bool,
    domain: int | None,
    timeout: float,
    excluded: tuple[str, ...],
    install: tuple[str, ...],
    watch: bool,
    graces_ns: dict[Kind, int],
    diagnostics: bool,
    form: str,
    interfaces: tuple[Path, ...],
) -> None:
    """Compare the running graph with the system in FILE, started with the same ARGUMENTS.

    Nodes, their ends with types and QoS, parameters and the states of managed nodes: what is
    missing, what is there in addition and what is different is reported, with the place in the
    model. Arguments of the system are given as NAME:=VALUE, as for 'deros up'.
    """
    if not live:
        raise click.UsageError("say what to compare with: --live for the running graph")
    if graces_ns and not watch:
        raise click.UsageError("--grace is for --watch: at a single look, nothing lasts")
    if diagnostics and not watch:
        raise click.UsageError("--diagnostics is for --watch: who looks once publishes nothing")
    expected = _expected(ctx, file, arguments, install, excluded, interfaces)
    look = _Look(file, domain, timeout, form)
    if watch:
        ctx.exit(_watch(expected, look, graces_ns, diagnostics=diagnostics))
    ctx.exit(_once(expected, look))


def _expected(
    ctx: click.Context,
    file: str,
    arguments: Sequence[str],
    install: Sequence[str],
    excluded: Sequence[str],
    interfaces: tuple[Path, ...],
) -> Expectation:
    """Return what the system says of its graph."""
    from deros.generators.system.script.standalone.start import Start
    from deros.live.verify.expectation import expectation
    from deros.systems.flatten import flatten

    system = checked_system(ctx, file, interfaces)
    start = Start(file, [word for folder in install for word in ("--install", folder)])
    here, elsewhere = system_as_started(ctx, system, start, arguments)
    return expectation(flatten(here), flatten(elsewhere), excluded)


@dataclass(frozen=True, slots=True)
class _Look:
    """How to look at a graph, and how to show what differs."""

    file: str
    domain: int | None
    timeout: float
    form: str


def _once(expected: Expectation, look: _Look) -> int:
    """Compare once; return the exit code."""
    from deros.live.looks import UnsteadyGraphError
    from deros.live.observer import Observer, RosUnavailableError
    from deros.live.verify.compare import compare
    from deros.live.verify.looking import settled_or_last

    try:
        with Observer(look.domain) as observer:
            seen = settled_or_last(observer, look.timeout)
    except (RosUnavailableError, UnsteadyGraphError) as error:
        raise click.ClickException(str(error)) from error
    differences = compare(expected, seen).differences
    notes = _notes(seen, expected, look.timeout)
    if look.form == "json":
        _show_json(differences, notes)
    else:
        _show_text(differences, notes, f"{look.file}: {counted(len(expected.nodes), 'node')}")
    return FINDINGS if differences else CLEAN


def _watch(
    expected: Expectation, look: _Look, graces_ns: Mapping[Kind, int], *, diagnostics: bool
) -> int:
    """Compare until a signal comes; return the exit code."""
    from deros.live.looks import UnsteadyGraphError
    from deros.live.observer import Observer, RosUnavailableError
    from deros.live.verify.diagnostics import DiagnosticsPublisher
    from deros.live.verify.looking import settled_or_last
    from deros.live.verify.watching import Watch

    show = _show_event_json if look.form == "json" else _show_event_text
    try:
        with Observer(look.domain) as observer:
            seen = settled_or_last(observer, look.timeout)
            publisher = DiagnosticsPublisher(observer, expected.system) if diagnostics else None
            with (
                stopped_by_signals() as is_stopped,
                closing(Watch(observer, expected, seen, graces_ns)) as watched,
            ):
                for note in _notes(seen, expected, look.timeout):
                    say(f"deros: not compared: {note}", to=sys.stderr)
                nodes = counted(len(expected.nodes), "node")
                say(f"deros: watching {nodes} of {look.file}", to=sys.stderr)
                while not is_stopped():
                    for event in watched.turn():
                        show(event)
                    if publisher is not None:
                        publisher.publish_if_due(watched.graces.reported)
                return FINDINGS if watched.graces.reported else CLEAN
    except (RosUnavailableError, UnsteadyGraphError) as error:
        raise click.ClickException(str(error)) from error


def _show_event_text(event: Event) -> None:
    from deros.live.verify.texts import event_line

    say(f"{datetime.now():%H:%M:%S} {event_line(event)}")


def _show_event_json(event: Event) -> None:
    from deros.live.verify.texts import event_data

    now = datetime.now(timezone.utc).isoformat(timespec="milliseconds")
    say(json.dumps({"time": now, **event_data(event)}))


def _notes(seen: Snapshot, expected: Expectation, timeout: float) -> list[str]:
    """Return what was not compared, and why."""
    notes = [each.what for each in seen.unseen if expected.misses(each)]
    notes += (
        f"more nodes in {space}: a launch file may start some that the system does not describe"
        for space in expected.open_spaces
    )
    if not seen.nodes:
        notes.append(f"no node was found within {timeout:g} s (see ROS_DOMAIN_ID)")
    return notes


def _show_text(differences: Sequence[Difference], notes: Sequence[str], compared: str) -> None:
    from deros.live.verify.texts import line

    for each in differences:
        say(line(each))
    if notes:
        say("not compared:")
    for note in notes:
        say(f"  {note}")
    found = counted(len(differences), "difference") if differences else "no difference"
    say(f"{compared}, {found}")


def _show_json(differences: Sequence[Difference], notes: Sequence[str]) -> None:
    from deros.live.verify.texts import data

    say(json.dumps([data(each) for each in differences], indent=2))
    for note in notes:
        say(f"deros: not compared: {note}", to=sys.stderr)
