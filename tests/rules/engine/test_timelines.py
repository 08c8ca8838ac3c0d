"""Every engine gives exactly the expected timelines."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from deros.cli.commands.simulate import simulate as command
from deros.generators.api.protocol import GenerationError
from deros.generators.monitor.python.run import GeneratedMonitor
from deros.rules.engine.engine import Engine
from deros.simulation.simulate import seconds, simulate
from deros.simulation.timelines.timeline import Happening
from deros.simulation.trace import TraceMessage
from tests.support import timelines
from tests.support.c_harness import unit
from tests.support.c_library import Loaded
from tests.support.c_monitors import CMonitor
from tests.support.needs import needs
from tests.support.profiles import slow
from tests.support.timelines import Timeline

DEROS = Path(sys.executable).with_name("deros")

REFUSED_BY_C = {"counter_above_two_to_the_53", "previous_of_the_least_of_great_integers"}
"""Those that compute with 64-bit integers, which the numbers of C do not hold."""

every_timeline = pytest.mark.parametrize("case", timelines.ALL, ids=lambda case: case.name)


def test_all_given_timelines_exist() -> None:
    """No timeline is lost, and names are unique."""
    assert len(timelines.GIVEN) == 33
    assert len({case.name for case in timelines.ALL}) == len(timelines.ALL)


@every_timeline
def test_timeline_matches(case: Timeline) -> None:
    """Each engine gives the expected events at the exact nanosecond.

    Timers that fire at every deadline have no effect on the events.
    """
    program = case.program()
    messages = case.messages(program)
    for monitor in (Engine, GeneratedMonitor):
        events = simulate(monitor(program), messages, case.until_ns)
        assert timelines.happenings(list(events)) == case.expect, monitor
        assert _with_punctual_timers(monitor(program), messages, case) == case.expect, monitor


@needs("gcc")
@pytest.mark.parametrize("cases", [timelines.MISREAD, slow(timelines.ALL)], ids=["misread", "all"])
@pytest.mark.essential
def test_timelines_match_in_c(cases: list[Timeline], tmp_path: Path) -> None:
    """The monitors in C give the same."""
    cases = [each for each in cases if each.name not in REFUSED_BY_C]
    programs = {case.rules: case.program() for case in cases}
    units = [unit(each, f"timeline_{number}") for number, each in enumerate(programs.values())]
    library = Loaded(units, tmp_path, "-O0")
    for case in cases:
        runner = CMonitor(library, list(programs).index(case.rules))
        for message in case.messages(programs[case.rules]):
            if message.t_ns <= case.until_ns:
                runner.message(message.t_ns, message.topic, message.leaves)
        runner.advance(case.until_ns)
        events = [event for event, _ in runner.events]
        assert timelines.happenings(events) == case.expect, case.name


@pytest.mark.parametrize("name", sorted(REFUSED_BY_C))
def test_timeline_that_c_refuses(name: str) -> None:
    """A monitor in C says so when it is generated."""
    program = next(each for each in timelines.ALL if each.name == name).program()
    with pytest.raises(GenerationError):
        unit(program, "refused")


def _with_punctual_timers(
    runner: Engine | GeneratedMonitor, messages: tuple[TraceMessage, ...], case: Timeline
) -> tuple[Happening, ...]:
    for message in messages:
        if message.t_ns > case.until_ns:
            break
        _run_timers(runner, message.t_ns)
        runner.message(message.t_ns, message.topic, message.leaves)
    _run_timers(runner, case.until_ns)
    return timelines.happenings(runner.events)


def _run_timers(runner: Engine | GeneratedMonitor, until_ns: int) -> None:
    while (due_ns := runner.next_deadline) is not None and due_ns <= until_ns:
        runner.advance(due_ns)


given = pytest.mark.parametrize("case", timelines.GIVEN, ids=lambda case: case.name)


@given
def test_command_prints_the_timeline(case: Timeline, tmp_path: Path) -> None:
    """``deros simulate`` prints exactly the expected events, one per line.

    ``--monitor python`` prints the output of the reference engine, character by character.
    """
    arguments = _arguments(case, tmp_path)[1:]
    plain, *others = (
        CliRunner().invoke(command, [*arguments, *option])
        for option in ((), ("--monitor", "reference"), ("--monitor", "python"))
    )
    assert plain.exit_code == 0, plain.output
    assert _printed(plain.stdout) == _expected(case)
    for other in others:
        assert (other.exit_code, other.stdout) == (0, plain.stdout)


def _arguments(case: Timeline, folder: Path) -> list[str]:
    for name in ("robot.rnd", "robot.system"):
        (folder / name).write_bytes((timelines.DIRECTORY / name).read_bytes())
    rules, trace = folder / "rules.deros", folder / "trace.jsonl"
    rules.write_text(case.rules)
    trace.write_text("\n".join(case.trace))
    return ["simulate", str(rules), "--trace", str(trace), "--until", case.until]


def _printed(output: str) -> list[tuple[str, str, str]]:
    records = [json.loads(line) for line in output.splitlines()]
    return [(record["t"], record["action"], record["event"]) for record in records]


def _expected(case: Timeline) -> list[tuple[str, str, str]]:
    return [(seconds(t_ns), action, event) for t_ns, action, event in case.expect]


def test_trace_may_come_from_standard_input(tmp_path: Path) -> None:
    """``--trace -`` reads the output of another program."""
    case = next(each for each in timelines.GIVEN if each.name == "immediate")
    arguments = [*_arguments(case, tmp_path)[:2], "--trace", "-", "--until", case.until]
    result = subprocess.run(
        [str(DEROS), *arguments],
        input="\n".join(case.trace),
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    )
    assert _printed(result.stdout) == _expected(case)
