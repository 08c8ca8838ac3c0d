"""Every engine gives exactly the expected timelines."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import CliRunner

from deros.cli.simulate import simulate as command
from deros.generators.monitor.python.run import GeneratedMonitor
from deros.monitor.engine import Engine
from deros.monitor.ir import Program
from deros.monitor.simulate import Monitor, seconds, simulate
from tests.support import timelines
from tests.support.timelines import Timeline

DEROS = Path(sys.executable).with_name("deros")

every_timeline = pytest.mark.parametrize("case", timelines.ALL, ids=lambda case: case.name)


def test_all_given_timelines_exist() -> None:
    """No timeline is lost, and names are unique."""
    assert len(timelines.GIVEN) == 33
    assert len({case.name for case in timelines.ALL}) == len(timelines.ALL)


@every_timeline
@pytest.mark.parametrize("monitor", [Engine, GeneratedMonitor])
def test_timeline_matches(case: Timeline, monitor: Callable[[Program], Monitor]) -> None:
    """The engine gives the expected events at the exact nanosecond."""
    program = case.program()
    events = simulate(monitor(program), case.messages(program), case.until_ns)
    assert timelines.happenings(list(events)) == case.expect


@every_timeline
@pytest.mark.parametrize("monitor", [Engine, GeneratedMonitor])
def test_punctual_timers_do_not_change_the_timeline(
    case: Timeline, monitor: Callable[[Program], Engine]
) -> None:
    """Timers that fire at every deadline have no effect on the events."""
    program = case.program()
    runner = monitor(program)
    for message in case.messages(program):
        if message.t_ns > case.until_ns:
            break
        _run_timers(runner, message.t_ns)
        runner.message(message.t_ns, message.topic, message.leaves)
    _run_timers(runner, case.until_ns)
    assert timelines.happenings(runner.events) == case.expect


def _run_timers(runner: Engine, until_ns: int) -> None:
    while (due_ns := runner.next_deadline) is not None and due_ns <= until_ns:
        runner.advance(due_ns)


given = pytest.mark.parametrize("case", timelines.GIVEN, ids=lambda case: case.name)


@given
def test_command_prints_the_timeline(case: Timeline, tmp_path: Path) -> None:
    """``deros simulate`` prints exactly the expected events, one per line."""
    result = CliRunner().invoke(command, _arguments(case, tmp_path)[1:])
    assert result.exit_code == 0, result.output
    assert _printed(result.stdout) == _expected(case)


@given
def test_generated_monitor_prints_the_same(case: Timeline, tmp_path: Path) -> None:
    """``--monitor python`` prints the output of the reference engine, character by character."""
    arguments = _arguments(case, tmp_path)[1:]
    outputs = [
        CliRunner().invoke(command, [*arguments, "--monitor", monitor])
        for monitor in ("reference", "python")
    ]
    assert [output.exit_code for output in outputs] == [0, 0]
    assert outputs[0].stdout == outputs[1].stdout
    assert _printed(outputs[1].stdout) == _expected(case)


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
