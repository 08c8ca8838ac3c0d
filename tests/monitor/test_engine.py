"""The reference engine, called as a node calls it."""

from __future__ import annotations

import pytest

from deros.monitor.engine import Engine, Event
from deros.monitor.ir import Program
from tests.support.timelines import program

LATCHED = """use "robot.system" import Robot
action stop publishes true on /stop : std_msgs.Bool latched;
action low publishes true on /low : std_msgs.Bool latched;
input v = topic /speed.data
input f = topic /flag.data
entity e { fast: v > 0.5; flag: f; }
if e.fast then { stop; };
if e.flag then { low; };
"""
TIMED = """use "robot.system" import Robot
action stop;
input v = topic /speed.data timeout 1 sec
entity e { fast: v > 0.5 for 2 sec; old: v.age() > 5 sec; gone: v.missing(); }
if e.fast or e.old or e.gone then { stop; };
"""


@pytest.fixture
def latched() -> Program:
    """Return a program with two latched actions."""
    return program(LATCHED)


def _speed(engine: Engine, t_ns: int, value: float) -> list[Event]:
    return engine.message(t_ns, "/speed", {0: value})


def _flag(engine: Engine, t_ns: int, value: bool) -> list[Event]:
    return engine.message(t_ns, "/flag", {1: value})


def test_reset_of_latched_actions(latched: Program) -> None:
    """Each active latched action is reset, unless its condition still holds."""
    engine = Engine(latched)
    _speed(engine, 1, 0.6)
    _flag(engine, 2, True)
    _speed(engine, 3, 0.1)
    assert engine.reset(4) is False
    assert [(e.t_ns, e.kind, e.action) for e in engine.events[2:]] == [
        (4, "reset", "stop"),
        (4, "refused", "low"),
    ]


def test_refused_reset_is_not_remembered(latched: Program) -> None:
    """After a refusal it takes another call to reset; a call with nothing active does nothing."""
    engine = Engine(latched)
    assert engine.reset(0) is True
    _speed(engine, 1, 0.6)
    assert engine.reset(2) is False
    assert _speed(engine, 3, 0.1) == []
    assert engine.reset(4) is True
    assert engine.reset(5) is True
    assert [e.kind for e in engine.events] == ["trigger", "refused", "reset"]


def test_reset_settles_deadlines_first() -> None:
    """A timeout that is due when the reset comes decides on it."""
    rules = LATCHED.replace("/speed.data", "/speed.data timeout 5 ns")
    engine = Engine(program(rules.replace("v > 0.5;", "v.missing();")))
    assert engine.reset(5) is False
    assert [(e.t_ns, e.kind) for e in engine.events] == [(5, "trigger"), (5, "refused")]


def test_events_tell_their_place(latched: Program) -> None:
    """A trigger names its behaviour and the call in it, a reset the action's declaration."""
    engine = Engine(latched)
    (trigger,) = _speed(engine, 1, 0.6)
    assert trigger.span is not None
    assert (trigger.behaviour, trigger.span.line, trigger.span.text) == ("behaviour_1", 7, "stop;")
    _speed(engine, 2, 0.1)
    engine.reset(3)
    reset = engine.events[-1]
    assert reset.span is not None
    assert (reset.behaviour, reset.span.line) == (None, 2)


def test_next_deadline() -> None:
    """It is the earliest instant at which something can happen without a message."""
    engine = Engine(program(TIMED), start_ns=1_000)
    assert engine.next_deadline == 1_000 + 10**9
    _speed(engine, 2_000, 0.6)
    assert engine.next_deadline == 2_000 + 10**9
    engine.advance(2_000 + 10**9)
    assert engine.next_deadline == 2_000 + 5 * 10**9 + 1
    engine.advance(2_000 + 5 * 10**9 + 1)
    assert engine.next_deadline is None


def test_advance_into_the_past_is_a_step_back() -> None:
    """Whatever the call, an earlier time shows that the clock stepped back."""
    engine = Engine(program(TIMED))
    _speed(engine, 10**9, 0.1)
    assert [(e.t_ns, e.kind) for e in engine.advance(3)] == [(3, "clock_step")]
    assert engine.next_deadline == 3 + 10**9


def test_unknown_topic_is_refused(latched: Program) -> None:
    """Calling it with a topic that no input is on is the caller's mistake."""
    with pytest.raises(ValueError, match="/odometry"):
        Engine(latched).message(1, "/odometry", {})
