"""Tables of timelines are read; each fault is reported at its place, with what to do."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import pytest

from deros.codes import BAD_TIMELINE
from deros.diagnostics import Diagnostic, SourceFile
from deros.pipeline.rule_tests import rules_of_text
from deros.rules.program.ir import Program
from deros.simulation.timelines.document import Case, RulesFile, read_document
from deros.simulation.timelines.lines import Fault
from deros.simulation.timelines.reading import read_entries, read_timeline
from deros.simulation.timelines.timeline import Timeline
from tests.support import timelines
from tests.support.rules import embedded_store

TABLE = """\
# Title
```deros
use "robot.system" import Robot
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
GROUP = """\
# Title
```deros
use "robot.system" import Robot
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
GATED = """\
use "robot.system" import Robot
action stop publishes true on /stop : std_msgs.Bool latched;
input v = topic /speed.data
entity e { r: v > 0.5; }
optional behaviour protect: if e.r then { stop; };
gate /nav -> /cmd_vel : geometry_msgs.Twist rate 20 Hz {
  stop: zero;
  lost heartbeat for 0.3 sec: zero until reset;
}
"""


def written(tmp_path: Path, text: str) -> Path:
    """Write a file of timelines."""
    path = tmp_path / "t.md"
    path.write_text(text, encoding="utf-8")
    return path


def test_table_is_read(tmp_path: Path) -> None:
    """A table gives the rules that its timeline needs, the trace, the end and the events."""
    text = TABLE.replace("| 1 s |", "| 0.5 s, 1 s |").replace("| stop |", "| |")
    document = read_document(SourceFile(str(written(tmp_path, text)), text))
    (case,) = document.cases
    assert (case.name, case.why, case.label) == ("name", "why", "")
    timeline = timelines.Timeline(case)
    assert timeline.rules == (
        'use "robot.system" import Robot\naction stop;\ninput v = topic /speed.data\n'
        "entity e { r: v > 0.5; }\nif e.r then { stop; };\n"
    )
    played = read_timeline(case, timelines.program(timeline.rules))
    assert played.trace == tuple(
        f'{{"t": "{t}", "topic": "/speed", "data": {{"data": 0.6}}}}' for t in ("0.5", "1")
    )
    assert played.until.t_ns == 9_000_000_000
    assert [each.happening for each in played.effects] == [(2_000_000_000, "stop", "refused")]


def test_labelled_tables_are_timelines_of_their_own(tmp_path: Path) -> None:
    """They share the rules, in groups of level 2; a range of times is that many messages."""
    path = written(tmp_path, GROUP)
    first, second = timelines.read(path)
    assert timelines.system(path) == "system Robot\n"
    assert (first.name, first.label, first.case.why) == ("name, As meant", "As meant", "It acts.")
    assert (second.name, second.label) == ("name, Sensor lost: it dies", "Sensor lost: it dies")
    program = timelines.program(first.rules)
    played, lost = (read_timeline(each.case, program) for each in (first, second))
    assert [json.loads(each)["t"] for each in played.trace] == ["1", "1.1", "1.1", "1.2"]
    assert [json.loads(each)["topic"] for each in played.trace[1:3]] == ["/speed", "/flag"]
    assert played.until.t_ns == 1_200_000_000
    assert [each.happening for each in played.effects] == [(1_100_000_000, "stop", "trigger")]
    assert (lost.until.t_ns, lost.effects) == (1_000_000_000, ())
    assert first.rules == second.rules
    assert "action stop;" not in first.rules, "declared by the timeline itself"
    assert "action ok;" not in first.rules, "nothing names it"


def test_findings_in_rules_are_at_their_places(tmp_path: Path) -> None:
    """Rules within a file are read in place: line and column are those of the file."""
    text = TABLE.replace("`entity e { r: v >", "`entity e { r: w >")
    document = read_document(SourceFile(str(written(tmp_path, text)), text))
    source = timelines.own_rules(document.cases[0]).source
    assert source.line(10) == text.splitlines()[9].replace("`", " ").rstrip()
    assert source.line(4) == "action stop;"
    assert not source.line(6).strip(), "nothing names f"


def test_label_without_a_table_is_rejected() -> None:
    """The error names the line of the label."""
    document = read_document(SourceFile("t.md", f"{GROUP}\n**As it is abused**\n"))
    (finding,) = document.diagnostics
    assert finding.span.line == 32
    assert finding.message == "a label without a table"


MALFORMED = (
    (8, "### name", "below one of level 2"),
    (8, "## group\n#### name", "level 1 to 3"),
    (8, "## name\n```rossystem", "a block that is never closed"),
    (13, "|---|---|---|\n**As meant.**", "neither a row of the table above nor apart from it"),
    (13, "|---|---|---|\n\n**As meant.**", "a label below a table without one"),
    (9, "**One.**\n| time | message | effect |\n|---|---|---|\n\n**One**", "a second table"),
    (10, "```yaml", "not one of ```deros"),
    (12, "| time until 9 s | message | cause |", "the columns are not"),
    (12, "| tme until 9 s | message | effect |", "the columns are not"),
    (12, "| time until nine | message | effect |", "'nine' is not a time"),
    (13, "| 0 s | v = 0.1 | |", "|---| belongs below"),
    (14, "| 1 | v = 0.6 | stop |", "'1' is not a time"),
    (14, "| 1.0000000001 s | v = 0.6 | stop |", "is not a time"),
    (14, "| 1 s, 1.5 s | v = 0.6 | stop |", "an effect of several times"),
    (14, "| 1 s | w = 0.6 | stop |", "no input 'w'"),
    (14, "| 1 s | v = 0.6, /flag.data = true | stop |", "not the fields of one message"),
    (14, "| 1 s | /speed = 0.6 | stop |", "not the fields of one message"),
    (14, "| 1 s | v 0.6 | stop |", "NAME.PATH = VALUE"),
    (14, "| 1 s | v = fast | stop |", "not a value"),
    (14, "| 1 s | v = 0.6 v = 0.7 | stop |", "values are separated"),
    (14, "| 1 s | v = 0.6 | stop ends |", "unknown effect 'stop ends'"),
    (14, "| 1 s | v = 0.6 | calm |", "unknown effect 'calm'"),
    (14, "| 1 s | v = 0.6 |", "not the cells"),
    (14, "| 1 s | v = 0.6 | stop | |", "not the cells"),
    (14, "1 s | v = 0.6 | stop |", "does not have the cells"),
    (15, "`if not e.r then { stop; };`", "neither a row"),
    (15, "\n`if not e.r then { stop; };`", "rules below the table"),
    (14, "1 s: stop", "neither a row"),
    (15, "| 0.5 s | | stop |", "not in order of time"),
    (15, "| 0.5 s | v = 0.1 | stop |", "not in order of time"),
    (15, "| back to 0.5 s | | stop |", "not in order of time"),
    (15, "| back to 2 s | v = 0.1 | stop |", "not in order of time"),
    (15, "\n| 2 s | | stop |", "a row apart"),
    (15, "\n| time | message | effect |\n|---|---|---|", "a second table without a label"),
    (15, "| 2 s to 3 s every 0.1 s | v = 1 | stop |", "an effect of several times"),
    (15, "| 2 s to 3 s every 0.1 s | | |", "no message"),
    (15, "| 2 s to 3 s every 0 s | v = 1 | |", "a range of less than two times"),
    (15, "| 2 s to 2 s every 0.1 s | v = 1 | |", "a range of less than two times"),
    (15, "| 2 s to 8 s every 1 ns | v = 1 | |", "a range of more than 1,000,000 times"),
    (15, "| 0.5 s to 3 s every 0.1 s | v = 1 | |", "not in order of time"),
    (15, "| every 0.1 s until 3 s | v = 1 | |", "not in order of time"),
)


@pytest.mark.parametrize(("number", "text", "message"), MALFORMED)
def test_malformed_table_is_rejected(number: int, text: str, message: str) -> None:
    """The first finding names the line."""
    lines = TABLE.splitlines()
    lines[number - 1] = text
    first = _findings("\n".join(lines))[0]
    assert (first.code, first.severity.value) == (BAD_TIMELINE, "error")
    assert message in first.message
    start = number + len(text) - len(text.lstrip("\n"))
    inside = range(start, number + text.count("\n") + 1)
    assert first.span.line in inside


def test_effect_after_the_end_is_rejected() -> None:
    """What comes later is not played, so it could never happen."""
    (finding,) = _findings(TABLE.replace("until 9 s", "until 1.5 s"))
    assert (finding.message, finding.span.line) == ("an effect after the end", 15)


def test_table_without_rows_is_rejected() -> None:
    """Nothing would be played; with an end, it is silence that is played."""
    empty = "\n".join(TABLE.splitlines()[:-2])
    assert not _findings(empty)
    (finding,) = _findings(empty.replace(" until 9 s", ""))
    assert (finding.message, finding.span.line) == ("a table without rows plays nothing", 12)


def _findings(text: str) -> list[Diagnostic]:
    document = read_document(SourceFile("t.md", text))
    return [*document.diagnostics, *(one for each in document.cases for one in _fault(each))]


def _fault(case: Case) -> Iterator[Diagnostic]:
    try:
        read_timeline(case, timelines.program(timelines.own_rules(case).text))
    except Fault as fault:
        yield fault.diagnostic


# A file of rules ----------------------------------------------------------------------------------


def _timeline(program: Program, rows: str, head: str = "| time | message | effect |") -> Timeline:
    columns = "|" + "---|" * (head.count("|") - 1)
    text = f"Rules: [robot.deros](robot.deros)\n\n{head}\n{columns}\n{rows}\n"
    (case,) = read_document(SourceFile("t.timeline", text)).cases
    assert isinstance(case.rules, RulesFile)
    return read_timeline(case, program)


@pytest.fixture(scope="module")
def gated() -> Program:
    """Return rules with a gate, built."""
    (case,) = read_document(SourceFile("t.md", _gated_text())).cases
    built, _ = rules_of_text(timelines.own_rules(case), embedded_store())
    assert built is not None
    return built


def _gated_text() -> str:
    system = "system Robot\ntopics\n" + "".join(
        f"  external topic {name} : {kind}\n"
        for name, kind in (
            ("/speed", "std_msgs.Float64"),
            ("/nav", "geometry_msgs.Twist"),
            ("/cmd_vel", "geometry_msgs.Twist"),
            ("/stop", "std_msgs.Bool"),
        )
    )
    table = "| time | message | effect |\n|---|---|---|\n| 1 s | v = 1 | stop |\n"
    return f"```rossystem\n{system}```\n```deros\n{GATED}```\n\n{table}"


TIMES = (
    ("| every 20 ms until 0.1 s | v = 0.1 | |", [20, 40, 60, 80, 100]),
    ("| 1 s every 200 ms until 1.5 sec | v = 0.1 | |", [1000, 1200, 1400]),
    ("| 50 ms to 100 ms every 25000 us | v = 0.1 | |", [50, 75, 100]),
    ("| every 0.5 s | v = 0.1 | |", [500, 1000, 1500, 2000]),
)


@pytest.mark.parametrize(("row", "times"), TIMES)
def test_sensor_goes_on_sending(row: str, times: list[int], gated: Program) -> None:
    """Ranges have both their ends; without a beginning the first message comes after a period."""
    timeline = _timeline(gated, row, "| time until 2 s | message | effect |")
    assert [each.moment.t_ns for each in timeline.entries] == [each * 10**6 for each in times]


@pytest.mark.parametrize(
    ("rows", "last_s"),
    [
        ("| 0 s every 0.5 s | v = 0.1 | |\n| 2.2 s | | |", 2.0),
        ("| every 0.5 s | v = 0.1 | |\n| 1 s to 3 s every 1 s | v = 0.2 | |", 3.0),
        (
            "| 1 s | v = 0.1 | |\n| 5 s | v = 0.1 | |\n| back to 1 s | v = 0.1 | |\n"
            "| 1.5 s every 0.5 s | v = 0.1 | |\n| 2.5 s | | |",
            2.5,
        ),
    ],
)
def test_messages_go_on_to_the_last_time(rows: str, last_s: float, gated: Program) -> None:
    """That of the last message or row, where the head of the table does not say more."""
    timeline = _timeline(gated, rows)
    assert timeline.entries[-1].moment.t_ns == last_s * 10**9
    assert timeline.until >= timeline.entries[-1].moment


def test_messages_without_an_end_are_rejected(gated: Program) -> None:
    """The table has to say how long it is; two of them do not."""
    for rows in (
        "| every 0.5 s | v = 0.1 | |",
        "| every 0.5 s | v = 1 | |\n| 1 s every 1 s | v = 0 | |",
    ):
        with pytest.raises(Fault, match="messages without an end"):
            _timeline(gated, rows)


def test_rows_are_resets_switches_and_losses(gated: Program) -> None:
    """What people do and which faults occur are lines of the trace, too."""
    timeline = _timeline(
        gated,
        "| 1 s | reset | |\n| 2 s | reset /cmd_vel | |\n| 3 s | disable protect | |\n"
        "| 4 s | enable protect | |\n| 5 s | heartbeat lost | |\n| 6 s | heartbeat back | |",
    )
    assert [json.loads(each) for each in timeline.trace] == [
        {"t": "1", "reset": True},
        {"t": "2", "reset": "/cmd_vel"},
        {"t": "3", "disable": "protect"},
        {"t": "4", "enable": "protect"},
        {"t": "5", "heartbeat": False},
        {"t": "6", "heartbeat": True},
    ]


def test_message_says_how_many_publishers_its_topic_has(gated: Program) -> None:
    """The number stands beside the fields, in the cell and in the line of the trace."""
    timeline = _timeline(gated, "| 1 s | publishers = 2, v = 0.1 | |\n| 2 s | v = 0.1 | |")
    assert [json.loads(each) for each in timeline.trace] == [
        {"t": "1", "topic": "/speed", "data": {"data": 0.1}, "publishers": 2},
        {"t": "2", "topic": "/speed", "data": {"data": 0.1}},
    ]


@pytest.mark.parametrize(
    "cell",
    ["v = 1, publishers = 0", "v = 1, publishers = true", "v = 1, publishers = 1.5",
     "v = 1, publishers = time", "v = 1, publishers = 2, publishers = 1", "publishers = 2"],
)  # fmt: skip
def test_malformed_number_of_publishers_is_rejected(cell: str, gated: Program) -> None:
    """It is a whole number, given once, beside the fields of a message."""
    with pytest.raises(Fault) as raised:
        _timeline(gated, f"| 1 s | {cell} | |")
    assert raised.value.diagnostic.hint
    assert raised.value.diagnostic.span.text == cell


def test_input_of_that_name_keeps_its_meaning(tmp_path: Path) -> None:
    """An input called ``publishers`` is set by its name."""
    text = TABLE.replace("input f = topic /flag.data", "input publishers = topic /flag.data")
    text = text.replace("v > 0.5;", "v > 0.5 or publishers;")
    text = text.replace("| 1 s | v = 0.6 | stop |", "| 1 s | publishers = true | stop |")
    (timeline,) = timelines.read(written(tmp_path, text))
    played = read_timeline(timeline.case, timelines.program(timeline.rules))
    assert json.loads(played.trace[0]) == {"t": "1", "topic": "/flag", "data": {"data": True}}


COMMANDS = (
    ("/cmd_vel flies", "unknown command"),
    ("/cmd_vl zero", "no gate leads to '/cmd_vl'"),
    ("/cmd_vel.linear.x = fast", "not a value"),
    ("/cmd_vel.linear.x = 1 /cmd_vel zero", "commands are separated"),
    ("/cmd_vel = 1", "unknown command"),
    ('/cmd_vel.linear[name = "x"] = 1', "elements of commands are named by their index"),
)


@pytest.mark.parametrize(("cell", "message"), COMMANDS)
def test_malformed_command_is_rejected(cell: str, message: str, gated: Program) -> None:
    """What a gate cannot do is no expectation."""
    with pytest.raises(Fault) as raised:
        _timeline(gated, f"| 1 s | | | {cell} |", "| time | message | effect | command |")
    assert message in raised.value.diagnostic.message
    assert raised.value.diagnostic.span.text == cell


def test_fault_of_many_messages_is_one_finding(gated: Program) -> None:
    """It is at the cell that they were made of."""
    timeline = _timeline(gated, '| every 20 ms until 3 s | v = "fast" | |')
    _, (finding,) = read_entries(timeline, gated, embedded_store())
    assert finding.code.slug == "wrong-trace-value"
    assert finding.span.text == 'v = "fast"'
