"""``deros test``: timelines that pass and that differ, why, what they reach, and bad input."""

from __future__ import annotations

import json
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import pytest

from tests.support import timelines
from tests.support.cli import Outcome, deros

PAGE = Path(__file__).resolve().parents[3] / "docs" / "patterns.md"
SYSTEM = """system Robot
topics
  external topic /effort : std_msgs.Float64
  external topic /nav : geometry_msgs.Twist
  external topic /cmd_vel : geometry_msgs.Twist
  external topic /stop : std_msgs.Bool
"""
RULES = """use "robot.system" import Robot
action stop publishes true on /stop : std_msgs.Bool latched;
input effort = topic /effort.data timeout 1 sec
entity drive {
  overload: effort > 30 and effort < 90 for 0.5 sec;
  silent: effort.missing();
}
optional behaviour protect: if drive.overload or drive.silent then { stop; };
gate /nav -> /cmd_vel : geometry_msgs.Twist rate 20 Hz {
  stop: zero;
  lost heartbeat for 0.3 sec: zero until reset;
  lost input for 0.5 sec: zero;
  resume on zero command;
}
"""
HEAD = "| time until 3 s | message | effect | command |\n|---|---|---|---|\n"
PASSING = f"""# Robot

Rules: [rules.deros](rules.deros)

## Overload

{HEAD}| every 0.1 s until 1 s | effort = 10 | | |
| 1.1 s every 0.1 s | effort = 31.2 | | |
| 1.6 s | | stop | /cmd_vel zero |
"""


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Create and enter a folder with rules and a timeline that passes."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "robot.system").write_text(SYSTEM)
    (tmp_path / "rules.deros").write_text(RULES)
    (tmp_path / "robot.md").write_text(PASSING)
    return tmp_path


def played(rows: str, *options: str) -> Outcome:
    """Play a table on the rules."""
    text = f"Rules: rules.deros\n\n{HEAD}{rows}\n"
    Path("table.timeline").write_text(text, encoding="utf-8")
    return deros("test", "table.timeline", *options)


def differences(rows: str) -> list[dict[str, Any]]:
    """Play a table on the rules and return what differs."""
    done = played(rows, "--format", "json")
    assert done.code == 1, done.err
    (timeline,) = json.loads(done.out)["timelines"]
    assert not timeline["passed"]
    found: list[dict[str, Any]] = timeline["differences"]
    return found


def test_input_is_unknown_while_its_topic_has_two_publishers() -> None:
    """A timeline says that there are two, which the rules act on; with one they do not."""
    rules = RULES.replace("timeout 1 sec", "on_second_publisher unknown timeout 1 sec")
    Path("rules.deros").write_text(rules.replace("effort.missing()", "effort.unknown()"))
    rows = "| every 0.1 s until 0.9 s | effort = 10 | | |\n"
    both = "| 1 s | effort = 10, publishers = 2 | {} | |\n| 1.1 s every 0.1 s | effort = 10 | | |"
    assert played(rows + both.format("stop")).code == 0
    (missed,) = differences(rows + both.replace(", publishers = 2", "").format("stop"))
    assert (missed["t"], "'stop' is expected" in missed["message"]) == ("1", True)


def test_folder_passes() -> None:
    """All timelines in a folder are played; what none reaches fails a strict run alone."""
    done, strict = deros("test", "."), deros("test", ".", "--strict")
    assert (done.code, strict.code) == (0, 1)
    assert done.out == strict.out
    assert done.out.splitlines() == [
        "1 timeline played, no differences",
        "rules.deros: the timelines reach 7 of 9 verdicts, and not",
        "    line 5: drive.overload: 'effort < 90' is false",
        "    line 6: drive.silent is true",
    ]


@pytest.mark.parametrize("path", [PAGE, *timelines.FILES], ids=lambda each: each.stem)
def test_own_timelines_pass(path: Path) -> None:
    """The patterns, and the timelines worked out by hand, with rules within the file."""
    done = deros("test", path, "--format", "json")
    assert done.code == 0, done.out
    names = [each["name"] for each in json.loads(done.out)["timelines"]]
    assert names == [each.name for each in timelines.read(path)]


SENDING = "| every 0.1 s | effort = 31.2 | | |\n"


def test_missing_effect_names_the_reason() -> None:
    """It says why the rules did not act then, and when they did."""
    missing, unexpected = differences(f"{SENDING}| 0.5 s | | stop | |")
    assert (missing["t"], missing["line"]) == ("0.5", 6)
    assert missing["message"] == "at 0.5 s 'stop' is expected, but happens at 0.6 s"
    (reason,) = missing["why"]
    assert reason.startswith("protect is false: not drive.overload: ")
    assert "effort 31.2 > 30" in reason
    assert unexpected["message"] == "at 0.6 s 'stop' happens, which no row expects"
    (cause,) = unexpected["why"]
    assert cause.startswith("stop, by protect (rules.deros:8): drive.overload: effort 31.2 > 30")


def test_unknown_is_a_reason() -> None:
    """Before the first message there is nothing to decide by."""
    (missing, _) = differences("| 0.5 s | | stop | |")
    assert missing["why"] == ["protect is unknown: effort is unknown"]


def test_what_holds_already_is_a_reason() -> None:
    """A behaviour acts on the edge."""
    (missing,) = differences(f"{SENDING}| 0.6 s | | stop | |\n| 2 s | | stop | |")
    assert missing["why"] == [
        "protect is true already, and acts when it turns true, it has acted at 0.6 s"
    ]


def test_what_is_disabled_is_a_reason() -> None:
    """A switch of an optional behaviour is a row."""
    (missing,) = differences(f"{SENDING}| 0.2 s | disable protect | | |\n| 0.6 s | | stop | |")
    assert missing["why"] == ["protect is disabled"]


def test_reset_is_tested() -> None:
    """A reset that is refused is an effect, and one that does not happen a difference."""
    rows = f"{SENDING}| 0.6 s | | stop | |\n| 1 s | reset | stop %s | |"
    assert played(rows % "refused").code == 0
    missing, unexpected = differences(rows % "reset")
    assert missing["why"] == ["stop is active then"]
    assert unexpected["why"][0].startswith("stop stays active, called for by protect: ")


GATE = (
    "| every 0.1 s | effort = 10 | | |\n"
    "| every 0.1 s until 1 s | /nav.linear.x = 0 | | |\n"
    "| 0.5 s | reset /cmd_vel | | /cmd_vel gate reset |\n"
    "| 1.1 s every 0.1 s | /nav.linear.x = 0.3 | | |\n"
)


@pytest.mark.parametrize(
    "cell", ["/cmd_vel passed", "/cmd_vel.linear.x = 0.3", "/cmd_vel passed, /cmd_vel.linear.y = 0"]
)
def test_command_of_a_gate_is_as_expected(cell: str) -> None:
    """It is the last one that the gate has published."""
    done = played(f"{GATE}| 1.25 s | | | {cell} |")
    assert done.code == 0, done.out


@pytest.mark.parametrize(
    ("cell", "message"),
    [
        ("/cmd_vel zero", "at 1.2 s /cmd_vel 'zero' is expected, but it is 'passed'"),
        (
            "/cmd_vel.linear.x = 0.2",
            "at 1.2 s /cmd_vel 'linear.x = 0.2' is expected, but it is 0.3",
        ),
        (
            "/cmd_vel gate reset refused",
            "at 1.2 s /cmd_vel 'gate reset refused' is expected, but 'passed' happens",
        ),
    ],
)
def test_command_of_a_gate_differs(cell: str, message: str) -> None:
    """It says what the gate does instead."""
    (difference,) = differences(f"{GATE}| 1.2 s | | | {cell} |")
    assert difference["message"] == message


def test_held_command_names_the_line_of_the_gate() -> None:
    """Why the gate holds commands back is the reason."""
    (difference,) = differences(
        "| every 0.1 s | effort = 10 | | |\n| every 0.1 s | /nav.linear.x = 0 | | |\n"
        "| 2 s | | | /cmd_vel passed |"
    )
    assert difference["why"] == [
        "waits for a reset, after lost heartbeat for 0.3 sec: zero until reset"
    ]


def test_order_of_effects_counts(folder: Path) -> None:
    """Of one instant, too."""
    rules = RULES.replace("{ stop; }", '{ stop; log_state("stopped"); }')
    (folder / "rules.deros").write_text(rules)
    assert played(f"{SENDING}| 0.6 s | | stop, log_state | |").code == 0
    (difference,) = differences(f"{SENDING}| 0.6 s | | log_state, stop | |")
    assert difference["message"] == ("at 0.6 s 'log_state' is expected, but 'stop' comes before it")


def test_clock_steps_back() -> None:
    """What comes before the step is played, and what is asked for after it is told of then."""
    head = HEAD.replace("time until 3 s", "time")
    rows = (
        "| 5 s | effort = 40 | | |\n| 5.5 s | | stop | |\n"
        "| back to 1 s | effort = 40 | | |\n| 1.%s s | | stop | |\n"
    )
    text = f"Rules: rules.deros\n\n{head}| 1 s | | stop | |\n"
    path = Path("steps.timeline")
    path.write_text(text + rows % "5", encoding="utf-8")
    assert deros("test", path).code == 0
    path.write_text(text + rows % "4", encoding="utf-8")
    record = json.loads(deros("test", path, "--format", "json").out)
    (missing, *_) = record["timelines"][0]["differences"]
    (reason,) = missing["why"]
    assert reason.startswith("protect is false: not drive.overload: effort 40.0 > 30 for less than")


def test_trace_is_played_with_the_table(folder: Path) -> None:
    """A recorded trace stands above the table that says what it causes."""
    lines = [f'{{"t": "{n / 10}", "topic": "/effort", "data": {{"data": 40}}}}' for n in range(9)]
    (folder / "drive.jsonl").write_text("\n".join(lines))
    text = "Rules: rules.deros\nTrace: [drive.jsonl](drive.jsonl)\n\n| time | message | effect |\n"
    path = Path("drive.timeline")
    path.write_text(f"{text}|---|---|---|\n| 0.5 s | | stop |\n")
    assert deros("test", path).code == 0
    (folder / "drive.jsonl").write_text("\n".join([*lines, '{"t": "1", "topic": 3}']))
    done = deros("test", path)
    assert done.code == 2
    assert done.err.startswith("drive.jsonl:10:")


def test_grace_is_that_of_the_node() -> None:
    """Without grace, an input is missing earlier."""
    assert played("| 1 s | | stop | |").code == 0
    assert played("| 1 s | | stop | |", "--grace", "1").code == 1
    assert played("| 2 s | | stop | |", "--grace", "1").code == 0


def test_junit_has_every_timeline(folder: Path) -> None:
    """A build server reads names, places and reasons."""
    played("| 0.5 s | | stop | |")
    report = folder / "report.xml"
    assert deros("test", ".", "--junit", report).code == 1
    suites = ET.parse(report).getroot()
    counts = {each.get("name"): (each.get("tests"), each.get("failures")) for each in suites}
    assert counts == {"robot.md": ("1", "0"), "table.timeline": ("1", "1")}
    (failure,) = suites.iter("failure")
    assert failure.text is not None
    assert "protect is unknown: effort is unknown" in failure.text


def test_errors_are_in_junit_too(folder: Path) -> None:
    """A timeline that cannot be played is no success."""
    report = folder / "report.xml"
    assert played("| 0.5 | | stop | |", "--junit", str(report)).code == 2
    (error,) = ET.parse(report).getroot().iter("error")
    assert error.get("message") == "'0.5' is not a time"


def test_report_that_cannot_be_written_is_an_error(folder: Path) -> None:
    """The reason is told."""
    done = deros("test", ".", "--junit", folder / "nowhere" / "report.xml")
    assert done.code == 2
    assert "No such file or directory" in done.err


def test_rules_without_a_timeline_are_named(folder: Path) -> None:
    """A folder is tested as a whole."""
    (folder / "other.deros").write_text(RULES)
    record = json.loads(deros("test", ".", "--format", "json").out)
    assert record["unplayed"] == ["other.deros"]
    assert [each["file"] for each in record["coverage"]] == ["rules.deros"]


def test_coverage_is_that_of_all_timelines(folder: Path) -> None:
    """What one does not reach another may."""
    played("| every 0.1 s until 1 s | effort = 95 | | |\n| 2 s | | stop | |")
    done = deros("test", ".", "--strict")
    assert (done.code, done.out.splitlines()[-1]) == (
        0,
        "rules.deros: the timelines reach all of it",
    )
    (folder / "robot.md").unlink()
    record = json.loads(deros("test", ".", "--format", "json").out)
    (coverage,) = record["coverage"]
    gaps = {(each["name"], each["text"], each["never"]) for each in coverage["gaps"]}
    assert gaps == {
        ("drive.overload", "", True),
        ("drive.overload", "effort > 30", False),
        ("drive.overload", "effort < 90", True),
    }


BAD = (
    ("Rules: other.deros\n\n", "there is no file 'other.deros' with rules"),
    ("", "no rules: neither here nor in 'bad.deros' beside it"),
    ("Rules: rules.deros\nTrace: none.jsonl\n\n", "cannot read 'none.jsonl'"),
    ("Rules: robot.system\n\n", "no rules: neither here nor in 'bad.deros' beside it"),
    ("## Title\nRules: rules.deros\n\n", "the rules of a file stand below its title"),
    ("Rules: rules.deros\nRules: rules.deros\n\n", "a second file of rules"),
    ("Rules: rules.deros\nTrace: a\nTrace: a\n\n", "a trace stands once, above its table"),
    ("Rules: rules.deros\n```deros\naction a;\n```\n\n", "rules beside those of 'rules.deros'"),
    ('```deros\nuse "robot.system" import Robot\naction stop;;\n```\n\n', "bad.timeline:3:"),
)


@pytest.mark.parametrize(("above", "message"), BAD)
def test_bad_input_is_an_error(above: str, message: str, folder: Path) -> None:
    """Nothing is played, and the exit code says so."""
    (folder / "bad.timeline").write_text(f"{above}{HEAD}| 1 s | | stop | |\n")
    done = deros("test", "bad.timeline")
    assert done.code == 2
    assert message in done.err
    assert "bad.timeline:" in done.err


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["rules.deros"], "is a model, not a file of timelines"),
        (["none.md"], "cannot read 'none.md'"),
        (["empty"], "contains no timeline (.md, .timeline)"),
        (["prose.md"], "no timeline"),
    ],
)
def test_nothing_to_play_is_an_error(arguments: list[str], message: str, folder: Path) -> None:
    """Words say what was looked for."""
    (folder / "empty").mkdir()
    (folder / "prose.md").write_text("# Title\n\n| a | b |\n|---|---|\n| 1 | 2 |\n")
    done = deros("test", *arguments)
    assert done.code == 2
    assert message in done.err


def test_prose_in_a_folder_is_no_timeline(folder: Path) -> None:
    """Other pages are passed over, with their tables, blocks and labels."""
    (folder / "README.md").write_text(
        "# Title\n**Note.** Words.\n```sh\nls\n```\n| a | b |\n|---|---|\n| 1 | 2 |\n\n"
        "Rules: be kind.\n\n| time | event |\n|---|---|\n| noon | tea |\n"
    )
    assert deros("test", ".").code == 0


RECORDED = """\
{"t": "0.1", "topic": "/effort", "data": {"data": 40}}
{"t": "0.1", "topic": "/nav", "data": {"linear.x": 0.3}}
{"t": "0.5", "reset": "/cmd_vel"}
{"t": "0.9", "topic": "/effort", "data": {"data": 10}}
{"t": "0.2", "topic": "/effort", "data": {"data": 40}}
{"t": "1.3", "reset": true}
"""


@pytest.mark.parametrize("options", [(), ("--until", "5"), ("--gates",), ("--gates", "--until=5")])
@pytest.mark.parametrize("first", [0, 4])
def test_simulation_is_written_as_a_timeline(
    options: tuple[str, ...], first: int, folder: Path
) -> None:
    """It passes, steps of the clock and all, until the rules do something else."""
    lines = RECORDED.splitlines(keepends=True)
    (folder / "drive.jsonl").write_text("".join([*lines[3:4], *lines[first:]]))
    command = ("simulate", "rules.deros", "--trace", "drive.jsonl", "--format", "timeline")
    written = deros(*command, *options)
    assert written.code == 0, written.err
    (folder / "recorded.md").write_text(written.out, encoding="utf-8")
    done = deros("test", "recorded.md")
    assert done.code == 0, done.out + done.err
    (folder / "rules.deros").write_text(RULES.replace("0.5 sec;\n  silent", "0.6 sec;\n  silent"))
    assert deros("test", "recorded.md").code == 1


def test_timeline_names_its_trace() -> None:
    """That of standard input has no name."""
    command = ("simulate", "rules.deros", "--trace", "-", "--format", "timeline")
    assert deros(*command).code == 2
