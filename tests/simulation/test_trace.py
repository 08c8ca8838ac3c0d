"""Traces are read exactly, and faults in them are reported at their place."""

from __future__ import annotations

import dataclasses
import json
import math
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner, Result
from hypothesis import example, given
from hypothesis import strategies as st

from deros.cli.commands.simulate import simulate
from deros.diagnostics import SourceFile
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import InterfaceType
from deros.simulation.trace import Trace, nanoseconds, read_trace
from tests.support import timelines

RULES = """use "robot.system" import Robot
action stop;
input v = topic /speed.data
input f = topic /flag.data
input m = topic /mode.data
input q = topic /imu.orientation
input c = topic /imu.angular_velocity_covariance[8]
input r = topic /scan.ranges
input e = topic /scan.ranges[1]
input n = topic /scan.header.frame_id
entity e {
  a: v > 1 and f and m = 1 and q.roll() > 1 and c > 1 and r.min() > 1 and e > 1 and n = "laser";
}
if e.a then { stop; };
"""
PROGRAM = timelines.program(RULES)
KEYED = timelines.program(
    """use "robot.system" import Robot
action stop;
entity e {
  a: topic /joints.position[name = "elbow"] > 1 or topic /joints.velocity[name = "wrist"] > 1;
  b: topic /health.status[name = "lidar"].level = 2;
  c: topic /health.status[name = "lidar"].values[key = "heat"].value = "hot";
}
if e.a or e.b or e.c then { stop; };
"""
)


def read(*lines: str) -> Trace:
    """Read the lines of a trace for the rules above."""
    return read_trace(SourceFile("trace.jsonl", "\n".join(lines)), PROGRAM, InterfaceStore())


def line(topic: str, data: Any, t: Any = "1.5") -> str:
    """Return the line of a message."""
    return json.dumps({"t": t, "topic": topic, "data": data})


def values(topic: str, data: Any) -> dict[str, Any]:
    """Return the leaves of a topic read from a message, by their paths."""
    trace = read(line(topic, data))
    assert not trace.diagnostics, trace.diagnostics
    (message,) = trace.messages
    paths = {leaf.index: ".".join(map(str, leaf.path)) for leaf in PROGRAM.leaves}
    return {paths[index]: value for index, value in message.leaves.items()}


# Times --------------------------------------------------------------------------------------------


TIMES = (
    ("0", 0),
    ("1.0", 10**9),
    ("2.999999999", 2_999_999_999),
    ("0.1", 10**8),
    ("1.0000000000000", 10**9),
    ("9223372036.854775807", 2**63 - 1),
    ("9223372036.854775808", None),
    ("1.0000000001", None),
    ("-1", None),
    ("1e3", None),
    ("", None),
    ("NaN", None),
    ("\u0661", None),
)


def test_times_are_exact() -> None:
    """Seconds become nanoseconds without rounding, or are rejected."""
    for text, expected in TIMES:
        assert nanoseconds(text) == expected, text


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ('"1.25"', 1_250_000_000),
        ("1.25", 1_250_000_000),
        ("3", 3 * 10**9),
        ("1e-9", 1),
        ("2E1", 20 * 10**9),
    ],
)
def test_times_may_be_json_numbers(text: str, expected: int) -> None:
    """A JSON number is read as exactly as a string."""
    trace = read(f'{{"t": {text}, "topic": "/speed"}}')
    assert [message.t_ns for message in trace.messages] == [expected]


# Values -------------------------------------------------------------------------------------------


def test_missing_fields_have_their_defaults() -> None:
    """A missing field has the default of its definition, also below other fields."""
    assert values("/speed", {}) == {"data": 0.0}
    assert values("/flag", {}) == {"data": False}
    assert values("/imu", {}) == {
        "orientation.x": 0.0,
        "orientation.y": 0.0,
        "orientation.z": 0.0,
        "orientation.w": 1.0,
        "angular_velocity_covariance.8": 0.0,
    }
    assert values("/scan", {}) == {"ranges": [], "ranges.1": None, "header.frame_id": ""}


@pytest.mark.parametrize(
    "data",
    [
        {"orientation": {"x": 0.5, "w": 0.25}},
        {"orientation.x": 0.5, "orientation.w": 0.25},
        {"orientation": {"x": 0.5}, "orientation.w": 0.25},
        {"orientation.w": 0.25, "orientation": {"x": 0.5}},
    ],
)
def test_fields_may_be_nested_or_dotted(data: dict[str, Any]) -> None:
    """Fields may be nested, dotted, or both in one message."""
    given = values("/imu", data)
    assert (given["orientation.x"], given["orientation.w"]) == (0.5, 0.25)
    assert given["orientation.y"] == 0.0


def test_array_elements_may_be_set_one_by_one() -> None:
    """A single element is set among defaults; an array may be given as a whole."""
    assert values("/scan", {"ranges[1]": 2})["ranges"] == [0.0, 2.0]
    assert values("/scan", {"ranges": [1, 2], "ranges[0]": 3})["ranges"] == [3.0, 2.0]
    assert values("/scan", {"ranges": [1]})["ranges.1"] is None
    assert values("/imu", {"angular_velocity_covariance[8]": 2.5})[
        "angular_velocity_covariance.8"
    ] == pytest.approx(2.5)


def test_elements_with_a_key_are_set_or_added() -> None:
    """Of messages and of arrays beside one another; what is there is found by what it says."""
    assert keyed("/joints", {}) == [None, None]
    assert keyed("/joints", {'position[name = "elbow"]': 2}) == [2.0, None]
    both = {'position[name = "elbow"]': 2, 'velocity[name = "wrist"]': 3}
    assert keyed("/joints", both) == [2.0, 3.0]
    named = {"name": ["wrist", "elbow", "elbow"], "position": [1, 2, 3], "velocity": [4]}
    assert keyed("/joints", named) == [2.0, 4.0]
    assert keyed("/joints", {"name": ["wrist", "elbow"], "position": [1]}) == [None, None]
    assert keyed("/health", {'status[name = "lidar"].level': 2}) == [2, None]
    inner = {'status[name = "lidar"].values[key = "heat"].value': "hot"}
    assert keyed("/health", inner) == [0, "hot"]
    listed = {"status": [{"name": "arm", "level": 1}, {"name": "lidar", "level": 2}]}
    assert keyed("/health", listed) == [2, None]


@pytest.mark.parametrize(
    ("key", "message"),
    [
        ('status[nmae = "lidar"].level', "have no field 'nmae'"),
        ("status[name = 3].level", "is never 3"),
        ('header[name = "x"]', "not an array"),
        ('status["lidar"].level', "is not the path of a field"),
        ('status[name = "a\\q"].level', "is not the path of a field"),
    ],
)
def test_wrong_keys_of_a_trace_are_reported(key: str, message: str) -> None:
    """As the rules' are."""
    text = line("/health", {key: 1})
    trace = read_trace(SourceFile("trace.jsonl", text), KEYED, InterfaceStore())
    (finding,) = trace.diagnostics
    assert message in finding.message


def keyed(topic: str, data: Any) -> list[Any]:
    """Return what the rules with keys read of a message."""
    trace = read_trace(SourceFile("trace.jsonl", line(topic, data)), KEYED, InterfaceStore())
    assert not trace.diagnostics, trace.diagnostics
    (message,) = trace.messages
    return [value for _, value in sorted(message.leaves.items())]


def test_non_finite_numbers_may_be_strings() -> None:
    """NaN and the infinities are strings, or as in Python's JSON."""
    assert values("/speed", {"data": "Infinity"}) == {"data": math.inf}
    assert values("/speed", {"data": "-Infinity"}) == {"data": -math.inf}
    assert math.isnan(values("/speed", {"data": "NaN"})["data"])
    assert math.isnan(values("/speed", {"data": math.nan})["data"])


def test_float32_values_are_rounded() -> None:
    """A float32 has the precision of a message."""
    assert values("/scan", {"ranges": [0.1]})["ranges"] == [0.10000000149011612]
    assert values("/speed", {"data": 0.1}) == {"data": 0.1}


# Faults -------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "code", "message"),
    [
        ("{", "DRS501", "no JSON"),
        ("nonsense", "DRS501", "no JSON"),
        ("[1]", "DRS501", "no object"),
        ("[" * 100_000, "DRS501", "nested too deeply"),
        ('{"t": ' + "1" * 5000 + "}", "DRS501", "too long"),
        ('{"topic": "/speed"}', "DRS501", "lacks 't'"),
        ('{"t": "1"}', "DRS501", "lacks 'topic'"),
        ('{"t": "1", "topic": 7}', "DRS501", "'topic' is no text"),
        ('{"t": "1", "topic": "/speed", "data": 1}', "DRS501", "'data' is no object"),
        ('{"t": 1, "topic": "/speed", "message": {"data": 1}}', "DRS501", "has no 'message'"),
        ('{"t": 1, "reset": true, "why": "x"}', "DRS501", "has no 'why'"),
        ('{"t": "x", "topic": "/speed"}', "DRS502", "is no time"),
        ('{"t": true, "topic": "/speed"}', "DRS502", "is no time"),
        ('{"t": -1, "topic": "/speed"}', "DRS502", "is no time"),
        ('{"t": 1e999999999, "topic": "/speed"}', "DRS502", "is no time"),
        ('{"t": NaN, "topic": "/speed"}', "DRS502", "is no time"),
        (line("/speed", {"date": 1}), "DRS503", "std_msgs/msg/Float64 has no field 'date'"),
        (line("/speed", {"data.x": 1}), "DRS503", "it has no fields"),
        (line("/speed", {"": 1}), "DRS503", "not the path of a field"),
        (line("/scan", {"ranges.x": 1}), "DRS503", "lacks the index"),
        (line("/scan", {"ranges[999999999]": 1}), "DRS503", "beyond the end"),
        (line("/imu", {"angular_velocity_covariance[9]": 1}), "DRS503", "beyond the end"),
        (line("/speed", {"data": "fast"}), "DRS504", "'data' is a float64"),
        (line("/speed", {"data": True}), "DRS504", "cannot hold true"),
        (line("/speed", {"data": None}), "DRS504", "cannot hold null"),
        (line("/flag", {"data": 1}), "DRS504", "'data' is a bool"),
        (line("/mode", {"data": 256}), "DRS504", "'data' is a uint8"),
        (line("/mode", {"data": 0.5}), "DRS504", "'data' is a uint8"),
        (line("/scan", {"ranges": 1}), "DRS504", "needs an array"),
        (line("/scan", {"ranges": [1e39]}), "DRS504", "'ranges[0]' is a float32"),
        (line("/imu", {"orientation": 1}), "DRS504", "needs an object"),
        (line("/imu", {"angular_velocity_covariance": [1]}), "DRS504", "1 elements"),
    ],
)
def test_faulty_line_is_reported_and_skipped(text: str, code: str, message: str) -> None:
    """The finding is at its line, and only that line is skipped."""
    good = line("/speed", {"data": 1})
    trace = read(good, "", text, good)
    (finding,) = trace.diagnostics
    assert (finding.code.name, finding.span.line) == (code, 3)
    assert finding.is_error
    assert message in finding.message
    assert len(trace.messages) == 2


@pytest.mark.parametrize(
    ("text", "place"),
    [
        (line("/speed", {"date": 1}), '"date"'),
        (line("/speed", {"data": "x"}), '"data"'),
        (line("/imu", {"orientation": {"a": 1}}), '"a"'),
        ('{"t": -1, "topic": "/speed"}', '"t"'),
        ('{"t": 1, "topic": "/sped"}', '"/sped"'),
        ('{"t": 1, "topic": "/speed", "data": {"d\\u0061te": 1}}', None),
        ('{"t": 1 "topic": "/speed"}', '"'),
    ],
)
def test_span_of_a_fault_is_its_key_or_line(text: str, place: str | None) -> None:
    """The span is the faulty key, or the whole line if the key is not found as written."""
    (finding,) = read(text).diagnostics
    assert finding.span.text == (place or text)


def test_missing_nested_definition_is_reported(tmp_path: Path) -> None:
    """A field of an unknown message type does not crash."""
    folder = tmp_path / "odd_msgs" / "msg"
    folder.mkdir(parents=True)
    (folder / "Odd.msg").write_text("float64 data\nlost_msgs/Lost lost\n")
    program = dataclasses.replace(
        PROGRAM,
        inputs=tuple(
            dataclasses.replace(each, type=InterfaceType("odd_msgs", "msg", "Odd"))
            for each in PROGRAM.inputs[:1]
        ),
        leaves=PROGRAM.leaves[:1],
    )
    source = SourceFile("trace", line("/speed", {"data": 1, "lost": {"x": 1}}))
    (finding,) = read_trace(source, program, InterfaceStore([tmp_path])).diagnostics
    assert "lost_msgs" in finding.message


def test_unread_topic_is_a_warning() -> None:
    """A topic that no rule reads is reported once, with the most similar topic."""
    trace = read(line("/sped", {"data": 1}), line("/sped", {"data": 2}))
    (finding,) = trace.diagnostics
    assert (finding.code.name, finding.is_error, trace.messages) == ("DRS505", False, ())
    assert finding.hint == "did you mean '/speed'?"


json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=8), inner),
    max_leaves=6,
)


@given(
    st.sampled_from(sorted(PROGRAM.topics)),
    st.dictionaries(
        st.text(max_size=6)
        | st.sampled_from(["data", "orientation", "ranges", "ranges[1]", "header"]),
        json_values,
    ),
    json_values,
)
@example("/scan", {"header": {"stamp": {"sec": 10**400}}}, "1")
def test_arbitrary_json_is_read_or_reported(topic: str, data: dict[str, Any], t: Any) -> None:
    """Any JSON is a message or one finding."""
    trace = read(line(topic, data, t))
    assert len(trace.messages) + len(trace.diagnostics) == 1


# The command --------------------------------------------------------------------------------------


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Create a folder with the robot and its rules."""
    for name in ("robot.rnd", "robot.system"):
        (tmp_path / name).write_bytes((timelines.DIRECTORY / name).read_bytes())
    (tmp_path / "r.deros").write_text(
        'use "robot.system" import Robot\naction stop;\naction beep(times);\n'
        "entity e { fast: topic /speed.data > 0.5 for 1 sec; }\n"
        'if e.fast then { stop; beep(3); log_state("too fast"); };\n'
    )
    return tmp_path


def run(folder: Path, *arguments: str, trace: str = "") -> Result:
    """Run the command on the rules of ``folder``, with the trace on standard input or in a file."""
    (folder / "trace.jsonl").write_text(trace)
    given = [str(folder / "r.deros"), "--trace", str(folder / "trace.jsonl"), *arguments]
    return CliRunner().invoke(simulate, given)


def test_json_events_have_action_cause_and_place(folder: Path) -> None:
    """An event has time, action, behaviour, arguments and place."""
    result = run(folder, "--until", "9", trace=line("/speed", {"data": 1}))
    records = [json.loads(each) for each in result.stdout.splitlines()]
    place = {"behaviour": "behaviour_1", "file": str(folder / "r.deros"), "line": 5}
    cause = "e.fast: /speed.data 1.0 > 0.5 for 1 sec"
    event = {"t": "2.500000000", "event": "trigger", "cause": cause}
    assert records == [
        {**event, "action": "stop", **place},
        {**event, "action": "beep", "arguments": [3], **place},
        {**event, "action": "log_state", "text": "too fast", **place},
    ]
    assert result.exit_code == 0


def test_run_ends_with_the_last_message(folder: Path) -> None:
    """Later deadlines are not handled without ``--until``."""
    assert run(folder, trace=line("/speed", {"data": 1})).stdout == ""


def test_clock_steps_are_printed_on_stderr(folder: Path) -> None:
    """They are not events of the rules."""
    trace = "\n".join(line("/speed", {"data": 0}, t) for t in ("2", "1"))
    result = run(folder, trace=trace)
    assert result.stdout == ""
    assert result.stderr.splitlines() == [
        "the clock stepped back to 1.000000000",
        "no action was triggered or reset until 1 s",
    ]


def test_faulty_trace_fails_the_run(folder: Path) -> None:
    """All faults are reported, nothing is simulated, and the exit code is 1."""
    result = run(folder, "--until", "9", trace="x\n" + line("/speed", {"data": 1}) + "\ny\n")
    assert (result.exit_code, result.stdout) == (1, "")
    assert "trace.jsonl:1:1: error[DRS501 bad-trace-line]" in result.stderr
    assert "trace.jsonl:3:1: error[DRS501 bad-trace-line]" in result.stderr


def test_faulty_rules_fail_the_run(folder: Path) -> None:
    """Rules with errors are not simulated."""
    rules = folder / "r.deros"
    rules.write_text(rules.read_text().replace("/speed.data", "/speed.date"))
    result = run(folder)
    assert result.exit_code == 1
    assert "r.deros:4:" in result.stderr
    assert "error[DRS302 unknown-field]" in result.stderr


@pytest.mark.parametrize(
    "arguments",
    [
        ["r.deros", "--trace", "nothing.jsonl"],
        ["nothing.deros", "--trace", "trace.jsonl"],
        ["robot.rnd", "--trace", "trace.jsonl"],
        ["r.deros", "--trace", "binary"],
        ["r.deros", "--trace", "."],
        ["r.deros"],
        ["r.deros", "--trace", "trace.jsonl", "--until", "soon"],
        ["r.deros", "--trace", "trace.jsonl", "--monitor", "none"],
    ],
)
def test_unusable_input_exits_with_2(
    arguments: list[str], folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Unreadable files and invalid arguments are explained."""
    (folder / "trace.jsonl").write_text("")
    (folder / "binary").write_bytes(b"\xff\x00")
    monkeypatch.chdir(folder)
    result = CliRunner().invoke(simulate, arguments)
    assert result.exit_code == 2
    assert result.stderr
    assert isinstance(result.exception, SystemExit)
