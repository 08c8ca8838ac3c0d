"""``deros simulate``: run safety rules over a recorded trace, without ROS."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

import click

from deros.cli.options import exit_code, interfaces_option

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from deros.diagnostics import Diagnostic, SourceFile
    from deros.interfaces.store import InterfaceStore
    from deros.monitor.ir import Program
    from deros.monitor.simulate import Monitor
    from deros.monitor.trace import TraceMessage

MONITORS = ("reference", "python")


def _until(ctx: click.Context, parameter: click.Parameter, value: str | None) -> int | None:
    del ctx, parameter
    if value is None:
        return None
    from deros.monitor.trace import nanoseconds

    t_ns = nanoseconds(value)
    if t_ns is None:
        raise click.BadParameter(f"'{value}' is no time in seconds, as 12.5")
    return t_ns


@click.command()
@click.argument("rules", type=click.Path())
@click.option(
    "--trace",
    "trace_file",
    required=True,
    metavar="FILE",
    type=click.Path(allow_dash=True),
    help="The messages, one JSON object a line; '-' is standard input.",
)
@click.option(
    "--until",
    "until_ns",
    metavar="T",
    callback=_until,
    help="Run the clock on to this time in seconds.  [default: the last message]",
)
@click.option(
    "--monitor",
    "engine",
    type=click.Choice(MONITORS),
    default="reference",
    show_default=True,
    help="What runs the rules: the reference engine, or the Python code generated from them.",
)
@interfaces_option
@click.pass_context
def simulate(
    ctx: click.Context,
    rules: str,
    trace_file: str,
    until_ns: int | None,
    engine: str,
    interfaces: tuple[Path, ...],
) -> None:
    """Run safety rules over a recorded trace.

    RULES is a *.deros file. A line of the trace is a message:

    \b
        {"t": "1.5", "topic": "/imu", "data": {"angular_velocity.z": 0.2}}

    Prints one JSON object per event (trigger, reset, refused); steps of the clock and findings go
    to standard error. Exits with 0, with 1 if the rules or the trace have errors, with 2 if one of
    them cannot be read.
    """  # noqa: D301 - click knows a block by the character itself
    from deros.cli.project import interfaces_of, project_of
    from deros.interfaces.store import InterfaceStore
    from deros.monitor.trace import read_trace

    store = InterfaceStore(interfaces_of(interfaces, [project_of(rules)]))
    program, findings = _load(rules, store)
    if program is None:
        _fail(ctx, findings)
    source, findings = _read(trace_file)
    if source is None:
        _fail(ctx, findings)
    trace = read_trace(source, program, store)
    if any(each.is_error for each in trace.diagnostics):
        _fail(ctx, trace.diagnostics)
    _report(trace.diagnostics)
    _play(trace.messages, until_ns, _monitor(engine, program))


def _load(path: str, store: InterfaceStore) -> tuple[Program | None, list[Diagnostic]]:
    """Return the program of a file of rules, or the errors that keep it from having one."""
    from deros.diagnostics import in_file_order
    from deros.metamodels.load import Repository
    from deros.metamodels.rules import Rules
    from deros.monitor.build import build

    repository = Repository()
    model = repository.load(path).model
    findings = repository.diagnostics
    program = None
    if isinstance(model, Rules):
        built = build(model, store)
        findings += built.diagnostics
        program = built.program
    elif model is not None:
        raise click.UsageError(f"'{path}' holds no safety rules; they are in *.deros files")
    errors = [each for each in findings if each.is_error]
    return (None if errors else program), in_file_order(errors)


def _read(path: str) -> tuple[SourceFile | None, list[Diagnostic]]:
    from deros.metamodels.reading import Unreadable, read

    try:
        shown = "standard input" if path == "-" else path
        return read(Path("/dev/stdin" if path == "-" else path), shown), []
    except Unreadable as unreadable:
        return None, [unreadable.diagnostic]


def _monitor(engine: str, program: Program) -> Monitor:
    if engine == "python":
        from deros.generators.monitor_python.run import GeneratedMonitor

        return GeneratedMonitor(program)
    from deros.monitor.engine import Engine

    return Engine(program)


def _play(messages: Iterable[TraceMessage], until_ns: int | None, monitor: Monitor) -> None:
    from deros.monitor.simulate import event_record, seconds, simulate

    for event in simulate(monitor, messages, until_ns):
        if event.kind == "clock_step":
            click.echo(f"the clock stepped back to {seconds(event.t_ns)}", err=True)
        else:
            click.echo(json.dumps(event_record(event)))


def _fail(ctx: click.Context, findings: Sequence[Diagnostic]) -> NoReturn:
    _report(findings)
    ctx.exit(exit_code(findings))


def _report(findings: Sequence[Diagnostic]) -> None:
    from deros.cli.render import print_text

    print_text(findings, sys.stderr)
