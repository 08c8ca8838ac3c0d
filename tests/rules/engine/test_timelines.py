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
from deros.simulation.trace import TraceMessage
from tests.support import timelines
from tests.support.c_harness import unit
from tests.support.c_library import Loaded
from tests.support.c_monitors import CMonitor
from tests.support.needs import needs
from tests.support.profiles import slow
from tests.support.timelines import Timeline

DEROS = Path(sys.executable).with_name("deros")

TABLE = """\
# Title
```deros
action stop;
input v = topic /speed.data
input f = topic /flag.data
```
## name
why
`entity e { r: v > 0.5; }`
`if e.r then { stop; };`
| time until 9 s | message | effect |
|---|---|---|
| 1 s | v = 0.6 | stop |
| 2 s | | stop refused |
"""

REFUSED_BY_C = {"counter_above_two_to_the_53", "previous_of_the_least_of_great_integers"}
"""Those that compute with 64-bit integers, which the numbers of C do not hold."""

every_timeline = pytest.mark.parametrize("case", timelines.ALL, ids=lambda case: case.name)


def test_all_given_timelines_exist() -> None:
    """No timeline is lost, and names are unique."""
    assert len(timelines.GIVEN) == 33
    assert len({case.name for case in timelines.ALL}) == len(timelines.ALL)


def test_table_is_read(tmp_path: Path) -> None:
    """A table gives the rules that its timeline needs, the trace, the end and the events."""
    (tmp_path / "t.md").write_text(
        TABLE.replace("| 1 s |", "| 0.5 s, 1 s |").replace("| stop |", "| |")
    )
    (case,) = timelines.read(tmp_path / "t.md")
    assert case == Timeline(
        "name",
        "why",
        "action stop;\ninput v = topic /speed.data\n"
        "entity e { r: v > 0.5; }\nif e.r then { stop; };\n",
        tuple(f'{{"t": "{t}", "topic": "/speed", "data": {{"data": 0.6}}}}' for t in ("0.5", "1")),
        "9",
        ((2_000_000_000, "stop", "refused"),),
    )


GROUP = """\
# Title
```deros
action stop;
action ok;
input v = topic /speed.data
input f = topic /flag.data
```
```rossystem
system Robot
```
## group
### name
why
```deros
action stop publishes true on /stop : std_msgs.Bool;
entity e { r: v > 0.5 or f; }
if e.r then { stop; };
```
**As meant.** It acts.

| time | message | effect |
|---|---|---|
| 1 s to 1.2 s every 0.1 s | v = 0.1 | |
| 1.1 s | f = true | stop |

**Sensor lost: it dies**
| time | message | effect |
|---|---|---|
| 1 s | f = false | |
"""


def test_labelled_tables_are_timelines_of_their_own(tmp_path: Path) -> None:
    """They share the rules, in groups of level 2; a range of times is that many messages."""
    path = tmp_path / "t.md"
    path.write_text(GROUP)
    first, second = timelines.read(path)
    assert timelines.system(path) == "system Robot\n"
    assert (first.name, first.label, first.why) == ("name, As meant", "As meant", "It acts.")
    assert (second.name, second.label) == ("name, Sensor lost: it dies", "Sensor lost: it dies")
    assert [json.loads(each)["t"] for each in first.trace] == ["1", "1.1", "1.1", "1.2"]
    assert [json.loads(each)["topic"] for each in first.trace[1:3]] == ["/speed", "/flag"]
    assert (first.until, first.expect) == ("1.2", ((1_100_000_000, "stop", "trigger"),))
    assert (second.until, second.expect) == ("1", ())
    assert first.rules == second.rules
    assert "action stop;" not in first.rules, "declared by the timeline itself"
    assert "action ok;" not in first.rules, "nothing names it"


def test_label_without_a_table_is_rejected(tmp_path: Path) -> None:
    """The error names the line of the label."""
    path = tmp_path / "t.md"
    path.write_text(f"{GROUP}\n**As it is abused**\n")
    with pytest.raises(timelines.TableError, match=r"t\.md:31: a label without a table"):
        timelines.read(path)


MALFORMED = (
    (7, "### name", "below one of level 2"),
    (7, "## group\n#### name", "level 1 to 3"),
    (7, "## name\n```rossystem", "a second block"),
    (12, "|---|---|---|\n**As meant.**", "a label below a table without one"),
    (8, "**One.**\n| time | message | effect |\n|---|---|---|\n\n**One**", "a second table"),
    (9, "```yaml", "not one of ```deros"),
    (11, "| time until 9 s | message | cause |", "the columns are not"),
    (11, "| time until nine | message | effect |", "'nine' is not a time"),
    (11, "| time until 1.5 s | message | effect |", "an effect after the end"),
    (12, "| 0 s | v = 0.1 | |", "|---| belongs below"),
    (13, "| 1 | v = 0.6 | stop |", "'1' is not a time"),
    (13, "| 1.0000000001 s | v = 0.6 | stop |", "is not a time"),
    (13, "| 1 s, 1.5 s | v = 0.6 | stop |", "an effect of several times"),
    (13, "| 1 s | w = 0.6 | stop |", "no input 'w'"),
    (13, "| 1 s | v = 0.6, /flag.data = true | stop |", "not the fields of one message"),
    (13, "| 1 s | /speed = 0.6 | stop |", "not the fields of one message"),
    (13, "| 1 s | v 0.6 | stop |", "NAME.PATH = VALUE"),
    (13, "| 1 s | v = fast | stop |", "not a value"),
    (13, "| 1 s | v = 0.6 v = 0.7 | stop |", "values are separated"),
    (13, "| 1 s | v = 0.6 | stop ends |", "unknown effect 'stop ends'"),
    (13, "| 1 s | v = 0.6 | calm |", "unknown effect 'calm'"),
    (13, "| 1 s | v = 0.6 |", "not the cells"),
    (13, "| 1 s | v = 0.6 | stop | |", "not the cells"),
    (13, "1 s | v = 0.6 | stop |", "not the cells"),
    (14, "`if not e.r then { stop; };`", "rules below the table"),
    (13, "1 s: stop", "neither a row"),
    (14, "| 0.5 s | | stop |", "not in order of time"),
    (14, "| 0.5 s | v = 0.1 | stop |", "not in order of time"),
    (14, "| back to 0.5 s | | stop |", "not in order of time"),
    (14, "| back to 2 s | v = 0.1 | stop |", "not in order of time"),
    (14, "\n| 2 s | | stop |", "a row apart"),
    (14, "| 2 s to 3 s every 0.1 s | v = 1 | stop |", "an effect of several times"),
    (14, "| 2 s to 3 s every 0.1 s | | |", "no message"),
    (14, "| 2 s to 3 s every 0 s | v = 1 | |", "a range of less than two times"),
    (14, "| 2 s to 2 s every 0.1 s | v = 1 | |", "a range of less than two times"),
    (14, "| 0.5 s to 3 s every 0.1 s | v = 1 | |", "not in order of time"),
)


def test_malformed_table_is_rejected(tmp_path: Path) -> None:
    """The error names file and line."""
    path = tmp_path / "t.md"
    for number, text, message in MALFORMED:
        lines = TABLE.splitlines()
        lines[number - 1] = text
        path.write_text("\n".join(lines))
        with pytest.raises(timelines.TableError) as raised:
            timelines.read(path)
        place = f"{path}:{number + text.count(chr(10))}: "
        assert str(raised.value).startswith(place), (text, message)
        assert message in str(raised.value), text


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
) -> tuple[timelines.Happening, ...]:
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
