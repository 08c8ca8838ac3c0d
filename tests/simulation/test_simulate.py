"""Playing a trace: events with their causes, resets, switches, and output of gates."""

from __future__ import annotations

import json
from typing import Any

import pytest

from deros.diagnostics import SourceFile
from deros.generators.monitor.python.run import GeneratedMonitor
from deros.rules.engine.engine import Engine
from deros.simulation.gate_simulation import GateAnswer, GateSimulation
from deros.simulation.simulate import Explained, answer_line, event_line, event_record, play
from deros.simulation.trace import Trace, nanoseconds, read_trace
from tests.support.rules import embedded_store, program

RULES = """
action stop publishes true on /stop : std_msgs.Bool latched;
action slow publishes true on /slow : std_msgs.Bool reset_by go;
action go;
input v = topic /speed.data timeout 1 sec
entity drive {
  fast: v > 30 for 0.5 sec;
  silent: v.missing();
  warm: v > 20;
  cool: v < 10;
}
behaviour protect: if drive.fast or drive.silent then { stop; log_state("halted"); };
optional behaviour ease: if drive.warm then { slow; };
if drive.cool then { go; };
"""
GATE = """
gate /nav -> /cmd_vel : geometry_msgs.Twist rate 20 Hz {
  stop: zero;
  slow: limit linear.x to [-0.1, 0.1] m/s;
  lost heartbeat for 0.3 sec: zero until reset;
  lost input for 0.5 sec: zero;
  resume on zero command;
}
"""
LOST_BEAT = "lost heartbeat for 0.3 sec: zero until reset"
LOST_INPUT = "lost input for 0.5 sec: zero"
LIMIT = "slow: limit linear.x to [-0.1, 0.1] m/s"
PROGRAM = program(RULES + GATE)
monitors = pytest.mark.parametrize("monitor", [Engine, GeneratedMonitor])


def speed(t: str, value: float) -> dict[str, Any]:
    """Return a message that the rules read, as a trace line."""
    return {"t": t, "topic": "/speed", "data": {"data": value}}


def command(t: str, value: float | str) -> dict[str, Any]:
    """Return a command as a trace line."""
    return {"t": t, "topic": "/nav", "data": {"linear.x": value}}


def read(*lines: dict[str, Any]) -> Trace:
    """Read lines of a trace."""
    text = "\n".join(map(json.dumps, lines))
    return read_trace(SourceFile("trace", text), PROGRAM, embedded_store())


def played(
    monitor: Any,
    *lines: dict[str, Any],
    until: str | None = None,
    gates: GateSimulation | None = None,
) -> list[str]:
    """Play valid lines, and return the events as text."""
    trace = read(*lines)
    assert not trace.diagnostics, trace.diagnostics
    until_ns = None if until is None else nanoseconds(until)
    events = []
    for each in play(monitor, trace.lines, until_ns, gates):
        line = (
            event_line(each.event, each.causes)
            if isinstance(each, Explained)
            else answer_line(each)
        )
        time, _, rest = line.partition(" ")
        events.append(f"{time.rstrip('0').rstrip('.')} {rest}")
    return events


def answers(*lines: dict[str, Any], until: str, report_all: bool = False) -> list[GateAnswer]:
    """Play lines, and return the answers of the gate."""
    gates = GateSimulation(PROGRAM, embedded_store(), report_all=report_all)
    found = play(Engine(PROGRAM), read(*lines).lines, nanoseconds(until), gates)
    return [each for each in found if isinstance(each, GateAnswer)]


@monitors
def test_each_trigger_has_its_cause(monitor: Any) -> None:
    """The cause is that of its own time, even if a message comes in the same call."""
    place = "(rules.deros:13)"
    assert played(monitor(PROGRAM), speed("0.1", 31.2), speed("0.8", 5), until="2") == [
        "0.1 slow, by ease (rules.deros:14): drive.warm: v 31.2 > 20",
        f"0.6 stop, by protect {place}: drive.fast: v 31.2 > 30 for 0.5 sec",
        f"0.6 halted, by protect {place}: drive.fast: v 31.2 > 30 for 0.5 sec",
        "0.8 go, by behaviour_3 (rules.deros:15): drive.cool: v 5.0 < 10",
        "0.8 slow is reset",
        f"1.8 stop, by protect {place}: drive.silent: v.missing()",
        f"1.8 halted, by protect {place}: drive.silent: v.missing()",
    ]


@monitors
def test_latency_is_the_time_of_a_line_less_the_stamp(monitor: Any) -> None:
    """A stage falls behind while it keeps its rate; a stamp of zero or in the future is no news."""
    rules = program(
        "action stop latched; input scan = topic /scan timeout 600 sec entity e {"
        " old: scan.latency() > 0.2 sec; ahead: scan.latency() < 0 sec;"
        " none: scan.latency().unknown(); } if e.old or e.ahead or e.none then { stop; };"
    )
    stamps = ((10, 0), (9, 0), (10, 2), (0, 0), (10, 6), (11, 1))
    lines = (
        {"t": f"{10 + n / 5:.1f}", "topic": "/scan", "data": {"header.stamp": stamp}}
        for n, (sec, tenths) in enumerate(stamps)
        for stamp in [{"sec": sec, "nanosec": tenths * 10**8}]
    )
    text = "\n".join(map(json.dumps, lines))
    trace = read_trace(SourceFile("trace", text), rules, embedded_store())
    assert not trace.diagnostics
    events = [each for each in play(monitor(rules), trace.lines) if isinstance(each, Explained)]
    causes = [(each.event.t_ns / 1e9, *each.causes.values()) for each in events]
    assert causes == [
        (10.2, "e.old: scan.latency() 1.2 > 0.2 sec"),
        (10.6, "e.none: scan.latency().unknown()"),
        (11.0, "e.ahead: scan.latency() -0.1 < 0 sec"),
    ]


@monitors
def test_input_is_unknown_while_its_topic_has_several_publishers(monitor: Any) -> None:
    """Their messages do not count, for the timeout either; another input of the topic goes on."""
    rules = program(
        "action stop latched; input v = topic /speed.data on_second_publisher unknown timeout 1 sec"
        " input all = topic /speed.data timeout 1 sec entity e { fast: v > 1; none: v.unknown();"
        " gone: v.missing(); any: all > 2; }"
        " if e.fast or e.none or e.gone or e.any then { stop; };"
    )
    two = {"publishers": 2}
    lines = [speed("0.5", 0.5), {**speed("1.0", 0.5), **two}, {**speed("1.1", 1.5), **two}]
    lines += [{**speed("1.2", 0.5), "publishers": 1}, {**speed("1.9", 2.5), **two}]
    lines += [{**speed("2.0", 0.5), **two}, speed("2.1", 0.5), speed("2.2", 1.5)]
    trace = read_trace(
        SourceFile("trace", "\n".join(map(json.dumps, lines))), rules, embedded_store()
    )
    assert not trace.diagnostics
    events = [each for each in play(monitor(rules), trace.lines) if isinstance(each, Explained)]
    assert [(each.event.t_ns / 1e9, *each.causes.values()) for each in events] == [
        (1.0, "e.none: v.unknown()"),
        (1.9, "e.none: v.unknown(); e.any: all 2.5 > 2"),
        (2.2, "e.fast: v 1.5 > 1"),
    ]


@monitors
def test_trigger_is_at_its_behaviour(monitor: Any) -> None:
    """Wherever its call stands, also in a behaviour within another; a reset is at the action."""
    text = """
    action stop publishes true on /stop : std_msgs.Bool latched;
    input v = topic /speed.data timeout 1 sec
    entity drive {
      fast: v > 30;
      faster: v > 40;
    }
    behaviour protect: if drive.fast
    then {
      log_state("fast");
      behaviour cut:
        if drive.faster
        then {
          stop;
        };
      log_state("very fast");
    };
    """
    running = monitor(program(text))
    lines = read(speed("0.1", 45), {"t": "0.2", "reset": True}, speed("0.3", 5)).lines
    events = list(play(running, (*lines, *read({"t": "0.4", "reset": True}).lines)))
    records = [
        event_record(each.event, each.causes) for each in events if isinstance(each, Explained)
    ]
    assert [(each["event"], each["action"], each["line"]) for each in records] == [
        ("trigger", "log_state", 9),
        ("trigger", "stop", 12),
        ("trigger", "log_state", 9),
        ("refused", "stop", 3),
        ("reset", "stop", 3),
    ]


@monitors
def test_parts_of_an_or_are_not_told_with_and(monitor: Any) -> None:
    """Two true parts of an 'or' are two causes."""
    text = """
    action stop publishes true on /stop : std_msgs.Bool latched;
    input v = topic /speed.data timeout 1 sec
    entity drive { bad: v > 30 or v < 60; far: v > 40; }
    if drive.bad or drive.far then { stop; };
    """
    (event,) = play(monitor(program(text)), read(speed("0.1", 45)).lines)
    assert isinstance(event, Explained)
    assert event.causes == {
        "behaviour_1": "drive.bad: v 45.0 > 30; v 45.0 < 60; drive.far: v 45.0 > 40"
    }


@monitors
def test_reset_is_refused_with_causes_then_done(monitor: Any) -> None:
    """The refusal lists holding conditions with values, and unknown ones."""
    events = played(
        monitor(PROGRAM),
        {"t": "0.0", "disable": "ease"},
        speed("0.1", 31.2),
        {"t": "0.7", "reset": True},
        speed("0.8", 15),
        {"t": "0.9", "reset": True},
        speed("1.0", "NaN"),  # type: ignore[arg-type]
    )
    assert events[2:] == [
        "0.7 stop stays active, called for by protect: drive.fast: v 31.2 > 30 for 0.5 sec",
        "0.9 stop is reset",
    ]


@monitors
def test_refused_reset_says_what_is_coming_and_what_is_unknown(monitor: Any) -> None:
    """Through named rules, with how long it has lasted; a rule that is known names nothing."""
    text = """
    action stop publishes true on /stop : std_msgs.Bool latched;
    input v = topic /speed.data timeout 9 sec
    input u = topic /mode.data timeout 9 sec
    entity drive { fast: v > 30; hot: (fast for 2 sec) and v > 10; both: v > 20 and u > 1; }
    behaviour cut: if (drive.hot for 3 sec) or drive.both then { stop; };
    """
    running = monitor(program(text), latched={"stop"})
    reset = {"t": "0.5", "reset": True}
    lines = [read(each).lines[0] for each in (speed("0.1", 31), reset)]
    (early,) = play(running, lines)
    assert isinstance(early, Explained)
    assert event_line(early.event, early.causes).endswith(
        "stop stays active, not known to be false: cut (u is unknown)"
    )
    (late,) = play(
        monitor(program(text.replace(" or drive.both", "")), latched={"stop"}),
        lines,
    )
    assert isinstance(late, Explained)
    assert late.causes == {
        "cut": "drive.hot, then for 3 sec: drive.fast for 0.4 s, long enough in 1.6 s: v 31.0 > 30;"
        " v 31.0 > 10"
    }


@monitors
def test_optional_behaviour_is_switched(monitor: Any) -> None:
    """Enabled while its condition is true, it acts."""
    lines = [{"t": "0.1", "disable": "ease"}, speed("0.2", 25), {"t": "0.3", "enable": "ease"}]
    events = played(monitor(PROGRAM), *lines)
    assert events == ["0.3 slow, by ease (rules.deros:14): drive.warm: v 25.0 > 20"]


@monitors
def test_grace_delays_missing_inputs(monitor: Any) -> None:
    """The effect is that of the node's parameter startup_grace."""
    events = played(monitor(PROGRAM, grace_ns=2 * 10**9), until="3.5")
    assert [each.split(" ")[0] for each in events] == ["3", "3"]


@monitors
def test_clock_step_is_explained_before_the_message(monitor: Any) -> None:
    """Everything is unknown then, so nothing holds."""
    (event, *_) = play(monitor(PROGRAM), read(speed("5", 15), speed("0.1", 25)).lines[1:], None)
    assert isinstance(event, Explained)
    events = list(play(monitor(PROGRAM), read(speed("0.5", 15), speed("0.1", 25)).lines))
    kinds = [(each.event.kind, each.causes) for each in events if isinstance(each, Explained)]
    assert kinds == [("clock_step", {}), ("trigger", {"ease": "drive.warm: v 25.0 > 20"})]


def test_event_record_contains_its_cause() -> None:
    """It is listed next to action and behaviour, or next to each behaviour that refuses a reset."""
    lines = read(speed("0.1", 31.2), {"t": "0.7", "reset": True}).lines
    events = [each for each in play(Engine(PROGRAM), lines) if isinstance(each, Explained)]
    records = [
        event_record(each.event, each.causes) for each in events if isinstance(each, Explained)
    ]
    cause = "drive.fast: v 31.2 > 30 for 0.5 sec"
    assert (records[1]["action"], records[1]["cause"]) == ("stop", cause)
    assert (records[3]["event"], records[3]["causes"]) == ("refused", {"protect": cause})
    assert "cause" not in event_record(events[1].event)


# Gates --------------------------------------------------------------------------------------------


def test_gate_reports_output_and_reason() -> None:
    """From the start, through a reset and a zero command, to limits and the stop."""
    gates = GateSimulation(PROGRAM, embedded_store())
    events = played(
        Engine(PROGRAM),
        speed("0.05", 15),
        command("0.3", 0.0),
        {"t": "0.4", "reset": "/cmd_vel"},
        command("0.5", 0.5),
        command("0.6", 0.0),
        command("0.65", 0.5),
        speed("0.7", 31.2),
        command("0.8", 0.05),
        command("1.1", 0.4),
        gates=gates,
        until="1.25",
    )
    gated = [each.replace(" /cmd_vel:", "") for each in events if "/cmd_vel" in each]
    assert gated == [
        f"0 zero, stop: zero; {LOST_BEAT}; {LOST_INPUT}",
        f"0.05 zero, {LOST_BEAT}; {LOST_INPUT}",
        f"0.25 zero, {LOST_INPUT}; waits for a reset, after {LOST_BEAT}",
        f"0.35 zero, waits for a reset, after {LOST_BEAT}",
        "0.4 is reset",
        "0.45 zero, waits for a zero command",
        "0.6 commands pass",
        f"0.7 commands are limited, {LIMIT}",
        f"0.8 commands pass, {LIMIT}",
        f"1.1 commands are limited, {LIMIT}",
        f"1.2 zero, stop: zero; {LIMIT}",
    ]


def test_invalid_command_is_refused() -> None:
    """NaN makes the input lost at once."""
    beaten = [command("0.5", 0.0), {"t": "0.55", "reset": "/cmd_vel"}, command("0.6", 0.0)]
    *_, refused, lost = answers(speed("0.1", 15), *beaten, command("0.7", "NaN"), until="0.72")
    assert (refused.event, refused.message) == ("command_refused", None)
    assert (lost.event, lost.why) == ("zero", (LOST_INPUT,))


def test_silent_safety_node_stops_the_robot() -> None:
    """The stop lasts until the reset, which is refused during the silence."""
    events = answers(
        speed("0.1", 15),
        command("0.5", 0.0),
        {"t": "0.55", "reset": "/cmd_vel"},
        command("0.6", 0.0),
        {"t": "0.65", "heartbeat": False},
        speed("0.8", 15),
        command("0.9", 0.3),
        {"t": "0.95", "reset": "/cmd_vel"},
        {"t": "1.0", "heartbeat": True},
        until="1.3",
    )
    after = [(each.event, each.why) for each in events if each.t_ns > 800 * 10**6]
    assert ("gate_reset_refused", ("stop: zero", LOST_BEAT)) in after
    assert after[0][0] == "zero"
    assert after[-1] == ("zero", (f"waits for a reset, after {LOST_BEAT}",))


def test_every_command_can_be_listed() -> None:
    """The list includes repeated zeros, with all their fields."""
    every = answers(until="0.2", report_all=True)
    changed = answers(until="0.2")
    assert len(every) > len(changed)
    assert [each.t_ns // 10**6 for each in every] == [0, 50, 100, 150, 200]
    assert every[0].message == {name: dict.fromkeys("xyz", 0.0) for name in ("linear", "angular")}


def first_beat(*lines: dict[str, Any], grace_ns: int) -> int:
    """Return at which of the publications, ten a second, the first heartbeat comes, in ms."""
    for until in range(50, 3000, 100):
        gates = GateSimulation(PROGRAM, embedded_store())
        list(play(Engine(PROGRAM, grace_ns=grace_ns), read(*lines).lines, until * 10**6, gates))
        if gates._beats:
            return until - 50
    raise AssertionError("there is no heartbeat")


def test_heartbeat_waits_for_inputs() -> None:
    """It comes with the first message or, without any, when the input is missing."""
    for grace_ns in (0, 10**9):
        assert first_beat(command("0.1", 0.0), speed("0.65", 15), grace_ns=grace_ns) == 700
    assert first_beat(grace_ns=0) == 1000
    assert first_beat(grace_ns=10**9) == 2000
    assert first_beat(speed("0.1", "NaN"), grace_ns=0) == 1000  # type: ignore[arg-type]


def test_heartbeat_waits_again_after_a_step_of_the_clock() -> None:
    """All inputs are awaited then, until they come or are missing."""

    def beats(line: dict[str, Any], until: str) -> int:
        gates = GateSimulation(PROGRAM, embedded_store())
        lines = [read(each).lines for each in (speed("5", 15), line, command(until, 0.0))]
        list(play(Engine(PROGRAM), [line for (line,) in lines], gates=gates))
        return gates._beats

    before = beats(command("1", 0.0), "1")
    assert beats(command("1", 0.0), "1.999") == before
    assert beats(command("1", 0.0), "2") == before + 1
    assert beats(speed("1", 15), "1.999") == before + 9


# Faults in traces ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("line", "place", "message"),
    [
        ({"rest": True}, None, "the line lacks 'topic', and is no 'reset'"),
        ({"reset": 1}, '"reset"', "'reset' is true or a text"),
        ({"reset": False}, '"reset"', "'reset' is true or a text"),
        ({"reset": "/cmd_vl"}, '"/cmd_vl"', "no gate leads to '/cmd_vl'"),
        ({"enable": "eas"}, '"eas"', "no behaviour 'eas'"),
        ({"disable": "protect"}, '"protect"', "the behaviour 'protect' is not optional"),
        ({"disable": 1}, '"disable"', "'disable' is the name of an optional behaviour"),
        ({"heartbeat": 1}, '"heartbeat"', "'heartbeat' is true or false"),
        ({"reset": True, "enable": "ease"}, '"enable"', "one line has both 'reset' and 'enable'"),
    ],
)
def test_invalid_line_is_reported_and_skipped(
    line: dict[str, Any], place: str | None, message: str
) -> None:
    """The span is the wrong key or name."""
    trace = read({"t": "1", **line})
    (finding,) = trace.diagnostics
    assert finding.code.name == "DRS501"
    assert message in finding.message
    assert place is None or finding.span.text == place
    assert trace.lines == ()


def test_missing_latches_and_gates_cannot_be_used() -> None:
    """Without latched actions or gates, reset and heartbeat lines are errors."""
    plain = program("action stop; entity e { r: topic /speed.data > 1; } if e.r then { stop; };")
    for line, message in (
        ('{"t": 1, "reset": true}', "no action is 'latched'"),
        ('{"t": 1, "heartbeat": false}', "no gate that hears"),
    ):
        (finding,) = read_trace(SourceFile("t", line), plain, embedded_store()).diagnostics
        assert message in finding.message
    free = program(RULES + GATE.replace(" until reset", ""))
    line = '{"t": 1, "reset": "/cmd_vel"}'
    (finding,) = read_trace(SourceFile("t", line), free, embedded_store()).diagnostics
    assert "no line 'until reset'" in finding.message


HASTY = """use "support/commanded.system" import Commanded
action stop publishes true on /stop : std_msgs.Bool latched;
input wish = topic /nav/cmd_vel.linear.x timeout 1 sec
entity planner { hasty: wish.abs() > 1 m/s; }
if planner.hasty then { stop; };
gate /nav/cmd_vel -> /cmd_vel : geometry_msgs.Twist rate 20 Hz {
  stop: zero; lost input for 0.5 sec: zero;
}
"""


def test_command_passes_before_the_action_that_it_triggers() -> None:
    """As on the robot: a gate passes a command while the safety node is yet to judge it."""
    hasty = program(HASTY)
    wishes = (command("0.1", 0.5), command("0.2", 1.5))
    lines = "\n".join(json.dumps({**each, "topic": "/nav/cmd_vel"}) for each in wishes)
    trace = read_trace(SourceFile("trace", lines), hasty, embedded_store())
    assert not trace.diagnostics
    gates = GateSimulation(hasty, embedded_store(), report_all=True)
    passed = [
        (each.t_ns / 1e9, each.message["linear"]["x"])
        for each in play(Engine(hasty), trace.lines, nanoseconds("0.24"), gates)
        if isinstance(each, GateAnswer) and each.message is not None
    ]
    assert (0.2, 1.5) in passed
    assert passed[-1][1] == 0.0


def test_each_source_of_a_gate_is_played_and_named() -> None:
    """A change of source is an event; the one that takes over has to command zero first."""
    sources = "/joy for 0.2 sec over /nav for 0.5 sec from zero"
    two = program(
        f"gate {sources} -> /cmd_vel : geometry_msgs.Twist rate 1 Hz {{ lost input: zero; }}"
    )
    lines = [command("0.1", 0), command("0.2", 0.4), command("0.4", 0.4)]
    lines.insert(2, {"t": "0.3", "topic": "/joy", "data": {"linear.x": 0.1}})
    text = "\n".join(map(json.dumps, [*lines, command("0.6", 0)]))
    trace = read_trace(SourceFile("t", text), two, embedded_store())
    gates = GateSimulation(two, embedded_store())
    found = play(Engine(two), trace.lines, nanoseconds("0.7"), gates)
    assert [answer_line(each) for each in found if isinstance(each, GateAnswer)] == [
        "0.000000000 /cmd_vel: zero, lost input: zero",
        "0.100000000 /cmd_vel: commands pass, source /nav",
        "0.300000000 /cmd_vel: commands pass, source /joy",
        "0.500000000 /cmd_vel: zero, waits for a zero command",
        "0.600000000 /cmd_vel: commands pass, source /nav",
    ]


def test_shared_boolean_is_idle_as_the_first_action_is() -> None:
    """It is the opposite of what the action declared first publishes, as in generated nodes."""
    rules = program(
        """
        action slow publishes true on /slow : std_msgs.Bool latched;
        action stop publishes false on /slow : std_msgs.Bool latched;
        input v = topic /speed.data timeout 1 sec
        entity drive { fast: v > 30; }
        if drive.fast then { slow; };
        gate /nav -> /cmd_vel : geometry_msgs.Twist rate 20 Hz {
          slow: limit linear.x to [-0.1, 0.1] m/s;
          lost heartbeat for 0.3 sec: zero;
          lost input for 0.5 sec: zero;
        }
        """
    )
    gates = GateSimulation(rules, embedded_store())
    lines = read(
        speed("0", 5), command("0.2", 1), speed("0.4", 31), command("0.5", 1), speed("0.6", 5)
    ).lines
    found = play(Engine(rules), lines, nanoseconds("0.6"), gates)
    kinds = [each.event for each in found if isinstance(each, GateAnswer)]
    assert kinds == ["zero", "passed", "limited"]
