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


def test_invalid_options_are_usage_errors() -> None:
    """Negative times, a frequency of 0 and unknown formats are rejected."""
    for option in (("--grace", "-1"), ("--publish-freq", "0"), ("--format", "xml")):
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
    ],
)
def test_wrong_constant_is_refused(folder: Path, options: tuple[str, ...], reason: str) -> None:
    """The message says what is wrong with it."""
    (folder / "rules.deros").write_text(TUNED)
    done = deros("simulate", "rules.deros", "--trace", "trace.jsonl", *options)
    assert done.code == 2
    assert reason in done.err
