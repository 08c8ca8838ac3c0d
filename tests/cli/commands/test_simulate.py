"""``deros simulate``: options and output."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.support.cli import deros

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
entity drive { overload: effort > 30 for 0.5 sec; silent: effort.missing(); }
behaviour protect: if drive.overload or drive.silent then { stop; };
gate /nav -> /cmd_vel : geometry_msgs.Twist rate 20 Hz {
  stop: zero;
  lost heartbeat for 0.3 sec: zero until reset;
  lost input for 0.5 sec: zero;
  resume on zero command;
}
"""
TRACE = """{"t": "0.2", "topic": "/effort", "data": {"data": 31.2}}
{"t": "0.3", "topic": "/nav", "data": {}}
{"t": "0.8", "reset": true}
"""


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Create and enter a folder with rules and a trace."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "robot.system").write_text(SYSTEM)
    (tmp_path / "rules.deros").write_text(RULES)
    (tmp_path / "trace.jsonl").write_text(TRACE)
    return tmp_path


def simulate(*options: str) -> list[str]:
    """Run the command and return the printed lines."""
    done = deros("simulate", "rules.deros", "--trace", "trace.jsonl", *options)
    assert done.code == 0, done.err
    return done.out.splitlines()


@pytest.mark.parametrize("monitor", ["reference", "python"])
def test_output_names_the_cause(monitor: str) -> None:
    """The cause is in the text line and in JSON."""
    cause = "drive.overload: effort 31.2 > 30 for 0.5 sec"
    assert simulate("--format", "text", "--monitor", monitor) == [
        f"0.700000000 stop, by protect (rules.deros:5): {cause}",
        f"0.800000000 stop stays active, called for by protect: {cause}",
    ]
    trigger, refused = map(json.loads, simulate("--monitor", monitor))
    assert trigger["cause"] == cause
    assert refused["causes"] == {"protect": cause}


def test_grace_is_that_of_the_node(folder: Path) -> None:
    """Without grace, an input is missing earlier."""
    (folder / "trace.jsonl").write_text("")
    times = [
        simulate("--format", "text", "--until", "4", *grace)[0].split(" ")[0]
        for grace in ((), ("--grace", "2.5"))
    ]
    assert times == ["1.000000000", "3.500000000"]


@pytest.mark.parametrize("style", ["text", "json"])
def test_it_says_that_nothing_happened(style: str) -> None:
    """It says until when, and what was not played, beside the output; but only if it is so."""
    command = ("simulate", "rules.deros", "--trace", "trace.jsonl", "--format", style)
    quiet = deros(*command, "--until", "0.25")
    assert quiet.out == ""
    assert quiet.err.splitlines() == [
        "no action was triggered or reset until 0.25 s",
        "2 lines lie after --until 0.25 and were not played",
    ]
    assert (
        "1 line lies after --until 0.5 and was not played" in deros(*command, "--until", "0.5").err
    )
    acting = deros(*command, "--until", "1")
    assert len(acting.out.splitlines()) == 2
    assert acting.err == ""


def test_last_line_ends_a_run_without_until(folder: Path) -> None:
    """A trace without lines ends at 0; what a gate does is no action."""
    for trace, end in (("", "0"), (TRACE.splitlines()[0], "0.2")):
        (folder / "trace.jsonl").write_text(trace)
        done = deros("simulate", "rules.deros", "--trace", "trace.jsonl", "--gates")
        assert done.err == f"no action was triggered or reset until {end} s\n"
        assert done.code == 0


def test_gates_are_shown_on_request() -> None:
    """Either the changes of a gate are shown, or every command that it publishes."""
    assert not any("gate" in json.loads(line) for line in simulate())
    lines = list(map(json.loads, simulate("--gates")))
    gated = [line for line in lines if line.get("gate") == "/cmd_vel"]
    assert {line["event"] for line in gated} == {"zero"}
    assert gated[-1]["why"][0] == "stop: zero"
    assert gated[0]["data"]["linear"] == {"x": 0.0, "y": 0.0, "z": 0.0}
    assert len(simulate("--commands")) > len(lines)
    text = simulate("--gates", "--format", "text")
    assert "0.000000000 /cmd_vel: zero, stop: zero; lost heartbeat" in text[0]


@pytest.mark.parametrize("monitor", ["reference", "python"])
def test_trace_in_unix_time_starts_with_its_first_line(folder: Path, monitor: str) -> None:
    """All that happens does so as much later, and nothing before; a timeline of it passes."""
    options = ("--commands", "--format", "text", "--monitor", monitor, "--until")
    trace = TRACE.replace("0.2", "0.0")
    (folder / "trace.jsonl").write_text(trace)
    shown = simulate(*options, "1.5")
    start = 1_700_000_000
    (folder / "trace.jsonl").write_text(trace.replace('"t": "0.', f'"t": "{start}.'))
    assert simulate(*options, f"{start}.9") == [
        f"{start}{each[1:]}" for each in shown if each < "0.95"
    ]
    written = simulate("--gates", "--format", "timeline", "--until", f"{start}.9")
    (folder / "timelines.md").write_text("\n".join(written))
    assert deros("test", "timelines.md").code == 0
    early = deros("simulate", "rules.deros", "--trace", "trace.jsonl", "--until", "0.5")
    assert "3 lines lie after --until 0.5 and were not played" in early.err


def test_gates_that_send_or_hold_are_shown(folder: Path) -> None:
    """Each output of a gate has words of its own, also what is not zero."""
    stops = "lost heartbeat for 0.3 sec: hold;\n  stop: send { linear.x = -0.1 m/s };"
    lines = RULES.replace("stop: zero;\n  lost heartbeat for 0.3 sec: zero until reset;", stops)
    lines = lines.replace("  resume on zero command;\n", "")
    (folder / "rules.deros").write_text(lines)
    (folder / "trace.jsonl").write_text(
        """{"t": "0.1", "topic": "/effort", "data": {"data": 31}}
{"t": "0.4", "topic": "/nav", "data": {"linear.x": 0.5}}
{"t": "0.45", "heartbeat": false}
{"t": "0.55", "topic": "/effort", "data": {"data": 31}}
{"t": "0.8", "topic": "/nav", "data": {"linear.x": 0.3}}
{"t": "0.82", "heartbeat": true}
"""
    )
    shown = simulate("--gates", "--format", "text", "--until", "1")
    gated = [each for each in shown if " /cmd_vel: " in each]
    holding = "lost heartbeat for 0.3 sec: hold"
    send = "stop: send { linear.x = -0.1 m/s }"
    assert gated == [
        "0.300000000 /cmd_vel: zero, lost input for 0.5 sec: zero",
        "0.400000000 /cmd_vel: commands pass",
        f"0.700000000 /cmd_vel: holds, {holding}; {send}",
        f"0.900000000 /cmd_vel: sends, {send}",
    ]
    events = [json.loads(each) for each in simulate("--gates", "--until", "1")]
    answers = [each["event"] for each in events if "gate" in each]
    assert answers == ["zero", "passed", "held", "sent"]


BOUNDED = """use "robot.system" import Robot
const turning = 0.5 rad/s tunable in [0.1, 1] rad/s "How fast the robot may turn"
input most = topic /most.data [m/s] timeout 0.4 sec
gate /nav -> /cmd_vel : geometry_msgs.Twist rate 20 Hz {
  always: limit linear.x to [-0.2 m/s, most], angular.z to [-turning, turning];
  lost input for 2 sec: zero;
}
"""
BOUNDED_TRACE = """{"t": "0.1", "topic": "/nav", "data": {"linear.x": 0.5, "angular.z": 0.4}}
{"t": "0.2", "topic": "/most", "data": {"data": 0.3}}
{"t": "0.3", "topic": "/nav", "data": {"linear.x": 0.5, "angular.z": 0.4}}
"""


@pytest.mark.parametrize(("options", "turning"), [((), 0.4), (("--set", "turning=0.2"), 0.2)])
def test_ends_of_limits_come_from_the_trace_and_from_set(
    folder: Path, options: tuple[str, ...], turning: float
) -> None:
    """An input that is unknown, before its first message and after its timeout, is zero."""
    (folder / "robot.system").write_text(SYSTEM + "  external topic /most : std_msgs.Float64\n")
    (folder / "rules.deros").write_text(BOUNDED)
    (folder / "trace.jsonl").write_text(BOUNDED_TRACE)
    lines = map(json.loads, simulate("--commands", "--until", "1", *options))
    published = [
        (line["t"], line["event"], line["data"]["linear"]["x"], line["data"]["angular"]["z"])
        for line in lines
        if line["event"] in ("passed", "limited")
    ]
    assert published == [
        ("0.100000000", "limited", 0.0, turning),
        ("0.300000000", "limited", 0.3, turning),
        ("0.600000000", "limited", 0.0, turning),
    ]


def test_timeline_of_a_trace_that_steps_back_plays_as_far(folder: Path) -> None:
    """The end cuts the trace at the first line that is later, though lines behind it are not."""
    (folder / "rules.deros").write_text(RULES.replace(" for 0.5 sec", "", 1))
    (folder / "trace.jsonl").write_text(
        "".join(
            f'{{"t": "{t}", "topic": "/effort", "data": {{"data": {effort}}}}}\n'
            for t, effort in (("0.1", 0), ("0.3", 31), ("0.15", 0), ("0.18", 31))
        )
    )
    command = ("simulate", "rules.deros", "--trace", "trace.jsonl")
    for until in ([], ["--until", "0.05"], ["--until", "0.2"], ["--until", "0.4"]):
        written = deros(*command, *until, "--format", "timeline")
        assert written.code == 0, written.err
        (folder / "rules.md").write_text(written.out)
        assert deros("test", "rules.md").code == 0, until
    assert "3 lines lie after" in deros(*command, "--until", "0.2").err


def test_invalid_options_are_usage_errors() -> None:
    """Negative times, a frequency of 0 and unknown formats are rejected."""
    for option in (("--grace", "-1"), ("--publish-freq", "1e-300"), ("--format", "xml")):
        done = deros("simulate", "rules.deros", "--trace", "trace.jsonl", *option)
        assert done.code == 2


TUNED = RULES.replace("effort > 30", "effort > most").replace(
    "\ninput", "\nconst most = 30 tunable in [10, 40]\ninput"
)


@pytest.mark.parametrize("monitor", ["reference", "python"])
def test_constant_is_set(folder: Path, monitor: str) -> None:
    """The rules are played with the value that is given, else with their own."""
    (folder / "rules.deros").write_text(TUNED)
    options = ("--format", "text", "--monitor", monitor)
    (line, *_) = simulate(*options)
    assert line.endswith("drive.overload: effort 31.2 > most 30.0 for 0.5 sec")
    assert not any("overload" in line for line in simulate(*options, "--set", "most=35"))


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        (("--set", "most=50"), "50.0 is outside [10.0, 40.0]"),
        (("--set", "most=nan"), "nan is outside"),
        (("--set", "most=a"), "'a' is not a number"),
        (("--set", "most"), "'' is not a number"),
        (("--set", "more=1"), "no tunable constant 'more': there are most"),
        (("--set", "most=20", "--format", "timeline"), "leave --set out"),
        (("--publish-freq", "20", "--format", "timeline"), "leave --publish-freq out"),
    ],
)
def test_wrong_constant_is_refused(folder: Path, options: tuple[str, ...], reason: str) -> None:
    """The message says what is wrong with it."""
    (folder / "rules.deros").write_text(TUNED)
    done = deros("simulate", "rules.deros", "--trace", "trace.jsonl", *options)
    assert done.code == 2
    assert reason in done.err
