"""``deros simulate``: run safety rules over a recorded trace, without ROS."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

import click

from deros.cli.findings import show, wrong_language
from deros.cli.options import FiniteRange, grace_option, interfaces_option, seconds_option
from deros.cli.streams import say
from deros.pipeline.outcome import exit_code
from deros.systems.safety_nodes import FASTEST_PUBLISH_HZ, PUBLISH_HZ

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from deros.diagnostics import Diagnostic, SourceFile
    from deros.pipeline.workspace import Workspace
    from deros.rules.program.ir import Program
    from deros.simulation.gate_simulation import GateAnswer
    from deros.simulation.simulate import Explained, Monitor
    from deros.simulation.trace import TraceLine

MONITORS = ("reference", "python")


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
    callback=seconds_option,
    help="Run the clock on to this time in seconds.  [default: the last line]",
)
@grace_option
@click.option("--gates", "with_gates", is_flag=True, help="Show what the gates do, and why.")
@click.option(
    "--commands",
    "all_commands",
    is_flag=True,
    help="Show every command that the gates publish, not only changes.",
)
@click.option(
    "--publish-freq",
    "publish_hz",
    type=FiniteRange(0.001, int(FASTEST_PUBLISH_HZ)),
    default=PUBLISH_HZ,
    show_default=True,
    help="How often the gates receive states and heartbeat, like 'publish_freq' of the node.",
)
@click.option(
    "--set",
    "settings",
    multiple=True,
    metavar="NAME=VALUE",
    help="Value of a tunable constant, in its unit; may be given several times.",
)
@click.option(
    "--format",
    "output_format",
    type=click.Choice(("json", "text", "timeline")),
    default="json",
    show_default=True,
    help="One JSON object, or one line for people, per event; or a table for 'deros test'.",
)
@click.option(
    "--monitor",
    "engine",
    type=click.Choice(MONITORS),
    default="reference",
    show_default=True,
    help="Engine that runs the rules: the reference engine, or the generated Python code.",
)
@interfaces_option
@click.pass_context
def simulate(
    ctx: click.Context,
    rules: str,
    trace_file: str,
    until_ns: int | None,
    grace_ns: int,
    with_gates: bool,
    all_commands: bool,
    publish_hz: float,
    settings: tuple[str, ...],
    output_format: str,
    engine: str,
    interfaces: tuple[Path, ...],
) -> None:
    """Run safety rules over a recorded trace.

    RULES is a *.deros file. A line of the trace is a message, a reset of the latched actions or of
    a gate, a switch of an optional behaviour, or the loss of the safety node's heartbeat:

    \b
        {"t": "1.5", "topic": "/imu", "data": {"angular_velocity.z": 0.2}}
        {"t": "4", "reset": true}
        {"t": "5", "disable": "near"}
        {"t": "6", "heartbeat": false}

    Prints each event (trigger, reset, refused) with its cause: the parts of the rules that are
    true, and their values. Steps of the clock, findings, and what was not played go to standard
    error, and a word if no action was triggered or reset. Exits with 0, with
    1 if the rules or the trace have errors, with 2 if one of them cannot be read.
    """  # noqa: D301 - click knows a block by the character itself
    from deros.pipeline.workspace import load
    from deros.simulation.simulate import play, played
    from deros.simulation.trace import read_trace, start_of

    if output_format == "timeline" and trace_file == "-":
        raise click.UsageError("a timeline names its trace, so '-' cannot be its file")
    if output_format == "timeline" and settings:
        raise click.UsageError("a timeline has the constants of its rules: leave --set out")
    if output_format == "timeline" and publish_hz != PUBLISH_HZ:
        raise click.UsageError(
            f"a timeline has a heartbeat of {PUBLISH_HZ:g} Hz: leave --publish-freq out"
        )
    workspace = load([rules], interfaces)
    store = workspace.store
    program, findings = _load(rules, workspace)
    if program is None:
        _fail(ctx, findings)
    source, findings = _read(trace_file)
    if source is None:
        _fail(ctx, findings)
    trace = read_trace(source, program, store)
    if any(each.is_error for each in trace.diagnostics):
        _fail(ctx, trace.diagnostics)
    show(trace.diagnostics)
    constants = _constants(program, settings)
    start_ns = start_of(list(played(trace.lines, until_ns)))
    gates = None
    if with_gates or all_commands:
        from deros.simulation.gate_simulation import GateSimulation

        gates = GateSimulation(
            program,
            store,
            publish_hz,
            start_ns=start_ns,
            report_all=all_commands,
            constants=constants,
        )
    monitor = _monitor(engine, program, start_ns, grace_ns, constants)
    happenings = play(monitor, trace.lines, until_ns, gates)
    if output_format == "timeline":
        from deros.simulation.timelines.writing import timeline_text

        table = timeline_text(
            rules, trace_file, happenings, until_ns, has_commands=gates is not None
        )
        say(table, end="")
        return
    has_acted = _show(happenings, output_format == "text")
    _tell_rest(trace.lines, until_ns, has_acted)


def _load(path: str, workspace: Workspace) -> tuple[Program | None, list[Diagnostic]]:
    """Return the program of a file of rules, or the errors that prevent it."""
    from deros.diagnostics import in_file_order
    from deros.metamodels.languages import DEROS
    from deros.models.rules import Rules

    (loaded,) = workspace.files
    findings = workspace.repository.diagnostics
    program = None
    if isinstance(loaded.model, Rules):
        built = workspace.builds.of(loaded.model)
        findings += built.diagnostics
        program = built.program
    elif loaded.model is not None:
        raise wrong_language(path, DEROS)
    errors = [each for each in findings if each.is_error]
    return (None if errors else program), in_file_order(errors)


def _read(path: str) -> tuple[SourceFile | None, list[Diagnostic]]:
    from deros.metamodels.reading import Unreadable, read

    try:
        shown = "standard input" if path == "-" else path
        return read(Path("/dev/stdin" if path == "-" else path), shown), []
    except Unreadable as unreadable:
        return None, [unreadable.diagnostic]


def _constants(program: Program, settings: Iterable[str]) -> dict[str, float]:
    """Return the values of tunable constants that are given as ``NAME=VALUE``."""
    tunables = {each.name: each for each in program.tunables}
    found: dict[str, float] = {}
    for setting in settings:
        name, _, text = setting.partition("=")
        if name not in tunables:
            known = f"there are {', '.join(tunables)}" if tunables else "they have none"
            raise click.UsageError(f"the rules have no tunable constant '{name}': {known}")
        try:
            found[name] = float(text)
        except ValueError:
            raise click.UsageError(f"'--set {setting}': '{text}' is not a number") from None
        refusal = tunables[name].refusal(found[name])
        if refusal:
            raise click.UsageError(f"'--set {setting}': {refusal}")
    return found


def _monitor(
    engine: str, program: Program, start_ns: int, grace_ns: int, constants: Mapping[str, float]
) -> Monitor:
    if engine == "python":
        from deros.generators.monitor.python.run import GeneratedMonitor

        return GeneratedMonitor(program, start_ns, grace_ns=grace_ns, constants=constants)
    from deros.rules.engine.engine import Engine

    return Engine(program, start_ns, grace_ns, constants=constants)


def _show(happenings: Iterable[Explained | GateAnswer], as_text: bool) -> bool:
    """Print what happens; return whether an action was triggered or reset, or its reset refused."""
    from deros.simulation import simulate as events

    has_acted = False
    for each in happenings:
        if isinstance(each, events.Explained):
            event = each.event
            if event.kind == "clock_step":
                say(f"the clock stepped back to {events.seconds(event.t_ns)}", to=sys.stderr)
                continue
            has_acted = True
            if as_text:
                say(events.event_line(event, each.causes))
            else:
                say(json.dumps(events.event_record(event, each.causes)))
        elif as_text:
            say(events.answer_line(each))
        else:
            say(json.dumps(events.answer_record(each)))
    return has_acted


def _tell_rest(lines: Sequence[TraceLine], until_ns: int | None, has_acted: bool) -> None:
    """Tell, beside the output, that nothing happened, and what was not played."""
    from deros.simulation.simulate import played

    count = sum(1 for _ in played(lines, until_ns))
    if not has_acted:
        end_ns = until_ns if until_ns is not None else lines[-1].t_ns if lines else 0
        say(f"no action was triggered or reset until {_decimal(end_ns)} s", to=sys.stderr)
    if until_ns is not None and count < len(lines):
        rest = len(lines) - count
        many = "lines lie" if rest > 1 else "line lies"
        was = "were" if rest > 1 else "was"
        end = _decimal(until_ns)
        say(f"{rest} {many} after --until {end} and {was} not played", to=sys.stderr)


def _decimal(t_ns: int) -> str:
    """Return nanoseconds as seconds, with the digits that count."""
    from deros.simulation.simulate import seconds

    return seconds(t_ns).rstrip("0").rstrip(".")


def _fail(ctx: click.Context, findings: Sequence[Diagnostic]) -> NoReturn:
    show(findings)
    ctx.exit(exit_code(findings))
