"""The reference engine, called as by a node."""

from __future__ import annotations

import math

import pytest

from deros.rules.engine.engine import Engine, Event
from deros.rules.program.ir import Program
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


def test_reset_ends_latched_actions(latched: Program) -> None:
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


def test_refused_reset_is_not_repeated(latched: Program) -> None:
    """After a refusal another call is needed; a call without active actions does nothing."""
    engine = Engine(latched)
    assert engine.reset(0) is True
    _speed(engine, 1, 0.6)
    assert engine.reset(2) is False
    assert _speed(engine, 3, 0.1) == []
    assert engine.reset(4) is True
    assert engine.reset(5) is True
    assert [e.kind for e in engine.events] == ["trigger", "refused", "reset"]


def test_deadlines_come_before_a_reset() -> None:
    """A timeout due at the time of the reset decides about it."""
    rules = LATCHED.replace("/speed.data", "/speed.data timeout 5 ns")
    engine = Engine(program(rules.replace("v > 0.5;", "v.missing();")))
    assert engine.reset(5) is False
    assert [(e.t_ns, e.kind) for e in engine.events] == [(5, "trigger"), (5, "refused")]


def test_events_have_their_span(latched: Program) -> None:
    """A trigger has the span of its behaviour, a reset that of the action."""
    engine = Engine(latched)
    (trigger,) = _speed(engine, 1, 0.6)
    assert trigger.span is not None
    assert (trigger.behaviour, trigger.span.line) == ("behaviour_1", 7)
    assert trigger.span.text.startswith("if ")
    _speed(engine, 2, 0.1)
    engine.reset(3)
    reset = engine.events[-1]
    assert reset.span is not None
    assert (reset.behaviour, reset.span.line) == (None, 2)


def test_next_deadline_is_the_earliest() -> None:
    """It is the earliest time at which anything can change without a message."""
    engine = Engine(program(TIMED), start_ns=1_000)
    assert engine.next_deadline == 1_000 + 10**9
    _speed(engine, 2_000, 0.6)
    assert engine.next_deadline == 2_000 + 10**9
    engine.advance(2_000 + 10**9)
    assert engine.next_deadline == 2_000 + 5 * 10**9 + 1
    engine.advance(2_000 + 5 * 10**9 + 1)
    assert engine.next_deadline is None


def test_advance_into_the_past_is_a_clock_step() -> None:
    """In any call, an earlier time means that the clock stepped back."""
    engine = Engine(program(TIMED))
    _speed(engine, 10**9, 0.1)
    assert [(e.t_ns, e.kind) for e in engine.advance(3)] == [(3, "clock_step")]
    assert engine.next_deadline == 3 + 10**9


def test_unknown_topic_raises(latched: Program) -> None:
    """A topic without an input is an error of the caller."""
    with pytest.raises(ValueError, match="/odometry"):
        Engine(latched).message(1, "/odometry", {})


def test_grace_delays_the_first_timeouts() -> None:
    """Timeouts count from the end of the grace period, or from the first message."""
    engine = Engine(program(TIMED), start_ns=100, grace_ns=50)
    assert engine.next_deadline == 150 + 10**9
    _speed(engine, 120, 0.1)
    assert engine.next_deadline == 120 + 10**9


def test_grace_applies_only_at_the_start() -> None:
    """After a clock step, timeouts count from the new time."""
    engine = Engine(program(TIMED), start_ns=100, grace_ns=50)
    engine.advance(10)
    assert engine.next_deadline == 10 + 10**9


def test_waiting_ends_with_the_first_message_or_timeout() -> None:
    """A monitor waits for inputs with a timeout until they arrive or are missing."""
    heard, unheard = Engine(program(TIMED)), Engine(program(TIMED))
    assert heard.waiting
    _speed(heard, 1, 0.1)
    assert not heard.waiting
    unheard.advance(10**9 - 1)
    assert unheard.waiting
    unheard.advance(10**9)
    assert not unheard.waiting


def test_nan_is_not_a_first_message(latched: Program) -> None:
    """The monitor still waits for a valid message; inputs without a timeout are not awaited."""
    engine = Engine(program(TIMED))
    _speed(engine, 1, math.nan)
    assert engine.waiting
    assert not Engine(latched).waiting


def test_latched_actions_may_be_active_at_the_start(latched: Program) -> None:
    """They have no event until they are reset; unknown names are ignored."""
    engine = Engine(latched, latched={"stop", "gone"})
    assert engine.events == []
    _speed(engine, 1, 0.1)
    assert engine.reset(2) is True
    assert [(e.kind, e.action) for e in engine.events] == [("reset", "stop")]


def test_reset_is_refused_before_the_first_event(latched: Program) -> None:
    """Nothing is known at the start, so an action that survived a restart stays active."""
    engine = Engine(latched, latched={"stop", "low"})
    assert engine.reset(1) is False
    _speed(engine, 2, 0.1)
    assert engine.reset(3) is False
    assert [(e.kind, e.action, e.unknown) for e in engine.events] == [
        ("refused", "stop", ("behaviour_1",)),
        ("refused", "low", ("behaviour_2",)),
        ("reset", "stop", ()),
        ("refused", "low", ("behaviour_2",)),
    ]


def test_missing_is_unknown_before_the_first_event() -> None:
    """The start is not an event: no condition has been evaluated before the first one."""
    rules = LATCHED.replace("/speed.data", "/speed.data timeout 5 ns")
    engine = Engine(program(rules.replace("v > 0.5;", "v.missing();")), latched={"stop"})
    assert engine.reset(1) is False
    _flag(engine, 2, False)
    assert engine.reset(3) is True


@pytest.mark.parametrize("value", [math.nan, None])
def test_reset_is_refused_while_the_cause_is_unknown(latched: Program, value: float) -> None:
    """An unknown value does not show that the danger is over."""
    engine = Engine(latched)
    _speed(engine, 1, 0.6)
    engine.message(2, "/speed", {0: value})
    assert engine.reset(3) is False
    assert (engine.events[-1].holding, engine.events[-1].unknown) == ((), ("behaviour_1",))
    _speed(engine, 4, 0.1)
    assert engine.reset(5) is True


def test_reset_is_refused_after_a_clock_step(latched: Program) -> None:
    """The step makes every input unknown until its next message."""
    engine = Engine(latched)
    _speed(engine, 5, 0.6)
    _speed(engine, 6, 0.1)
    engine.advance(2)
    assert engine.reset(3) is False
    _speed(engine, 4, 0.1)
    assert engine.reset(5) is True


def test_refused_reset_lists_holding_and_unknown_behaviours() -> None:
    """Behaviours known to be false are not listed."""
    rules = LATCHED + "if e.flag then { stop; };\nif e.fast for 1 sec then { stop; };\n"
    engine = Engine(program(rules))
    _speed(engine, 1, 0.6)
    assert engine.reset(2) is False
    assert engine.events[-1].holding == ("behaviour_1",)
    assert engine.events[-1].unknown == ("behaviour_3",)


def test_disabled_outer_behaviour_does_not_refuse_a_reset() -> None:
    """Behaviours nested in it are false, even while they are unknown."""
    rules = LATCHED.replace(
        "if e.fast then { stop; };",
        "optional behaviour fast: if e.fast then { if e.flag then { stop; }; };",
    )
    engine = Engine(program(rules), latched={"stop"})
    _speed(engine, 1, 0.6)
    assert engine.reset(2) is False
    engine.enable(3, "fast", False)
    assert engine.reset(4) is True


def test_action_without_a_trigger_can_be_reset() -> None:
    """No condition refuses it."""
    rules = LATCHED.replace("if e.fast then { stop; };", "")
    assert Engine(program(rules), latched={"stop"}).reset(1) is True


WATCHING = (
    LATCHED
    + """action cut latched;
entity s { stopped: stop.active; idle: not low.active for 3 ns; }
behaviour again: if s.stopped then { cut; };
behaviour rests: if s.idle then { log_state("idle"); };
"""
)


def _kinds(events: list[Event]) -> list[tuple[int, str, str]]:
    return [(each.t_ns, each.kind, each.action) for each in events]


def test_reset_of_a_named_action_is_an_event() -> None:
    """What names the action sees it at once, so that a later trigger is another one."""
    engine = Engine(program(WATCHING))
    _flag(engine, 1, True)
    _flag(engine, 2, False)
    assert engine.next_deadline is None
    assert engine.reset(3) is True
    assert engine.next_deadline == 6
    assert _kinds(engine.advance(6)) == [(6, "trigger", "log_state")]


def test_reset_decides_by_the_verdicts_of_the_last_event() -> None:
    """An action that only the state of another one triggers is reset by the next call."""
    engine = Engine(program(WATCHING))
    assert _kinds(_speed(engine, 1, 0.6)) == [(1, "trigger", "stop"), (1, "trigger", "cut")]
    _speed(engine, 2, 0.1)
    before = len(engine.events)
    assert engine.reset(3) is False
    assert _kinds(engine.events[before:]) == [(3, "reset", "stop"), (3, "refused", "cut")]
    assert engine.events[-1].holding == ("again",)
    assert engine.reset(4) is True


def test_refused_reset_of_a_named_action_is_not_an_event() -> None:
    """The action is as it was, and no interval begins."""
    engine = Engine(program(WATCHING))
    _flag(engine, 1, True)
    assert engine.reset(2) is False
    assert engine.next_deadline is None


def test_named_action_may_be_active_at_the_start() -> None:
    """A condition sees a latched action that an earlier run has left active."""
    engine = Engine(program(WATCHING), latched={"stop"})
    assert _kinds(_speed(engine, 1, 0.1)) == [(1, "trigger", "cut")]


def test_explain_names_an_action() -> None:
    """It is among what a rule reads, and a cause."""
    engine = Engine(program(WATCHING))
    _speed(engine, 1, 0.6)
    explanation = engine.explain()
    state = next(each for each in explanation.rules if each.name == "s.stopped")
    assert state.reads == (("stop.active", True),)
    assert state.causes == ("stop is active",)
    assert explanation.causes["again"] == ("s.stopped: stop is active",)


OPTIONAL = LATCHED.replace("if e.fast then", "optional behaviour fast: if e.fast for 5 ns then")


def test_disabled_behaviour_does_not_act() -> None:
    """Its condition counts as false: it neither acts nor prevents a reset."""
    engine = Engine(program(OPTIONAL))
    _speed(engine, 1, 0.6)
    engine.advance(6)
    assert engine.reset(7) is False
    assert engine.enable(8, "fast", False) == []
    assert engine.reset(9) is True


def test_intervals_of_a_disabled_behaviour_continue() -> None:
    """Enabled after its condition has held long enough, a behaviour acts at once."""
    engine = Engine(program(OPTIONAL))
    engine.enable(0, "fast", False)
    _speed(engine, 1, 0.6)
    assert engine.advance(6) == []
    assert [(e.t_ns, e.action) for e in engine.enable(7, "fast", True)] == [(7, "stop")]
    assert engine.enable(8, "fast", True) == []


def test_only_optional_behaviours_can_be_disabled() -> None:
    """Other behaviours and unknown names raise."""
    engine = Engine(program(OPTIONAL))
    for name in ("behaviour_2", "nobody"):
        with pytest.raises(ValueError, match=name):
            engine.enable(1, name, False)


def test_explain_shows_values_and_times() -> None:
    """A rule is false only if everything that it reads is known."""
    engine = Engine(program(TIMED), start_ns=5)
    fast, old, gone = engine.explain().rules
    assert (fast.name, fast.value, fast.since, fast.reads) == ("e.fast", None, 5, (("v", None),))
    assert (old.value, old.reads) == (None, (("v.age()", None),))
    assert (gone.line, gone.text) == (4, "gone: v.missing();")
    assert (gone.value, gone.reads) == (False, (("v.missing()", False),))
    _speed(engine, 10, 0.6)
    engine.advance(10 + 10**9)
    fast, old, gone = engine.explain().rules
    assert (fast.value, old.value, old.reads) == (None, False, (("v.age()", 1.0),))
    assert (gone.value, gone.since) == (True, 10 + 10**9)


def test_explain_shows_rates_as_written() -> None:
    """The unwrapping of angles inside a rate is not shown."""
    rules = """use "robot.system" import Robot
    action stop;
    input q = topic /imu.orientation
    entity e { r: q.yaw().rate(0.1 sec) > 1 or q.roll().rate().abs() > 1; }
    if e.r then { stop; };
    """
    (state,) = Engine(program(rules)).explain().rules
    names = [name for name, _ in state.reads]
    assert names == ["q.yaw().rate(0.1 sec)", "q.roll().rate().abs()"]


def test_explain_shows_terms_as_written() -> None:
    """A function follows its operand; bearings are in radians."""
    rules = """use "robot.system" import Robot
    action stop;
    input scan = topic /scan
    input q = topic /imu.orientation
    input v = topic /speed.data [rad]
    entity e {  // a comment
      r: scan.nearest(-1 rad, 0.5 rad) < 1 or q.roll() > v  // another
         or v.rate() > 2;
    }
    if e.r then { stop; };
    """
    (state,) = Engine(program(rules)).explain().rules
    names = [name for name, _ in state.reads]
    assert names == ["scan.nearest(-1, 0.5)", "q.roll()", "v", "v.rate()"]
    assert state.text == "r: scan.nearest(-1 rad, 0.5 rad) < 1 or q.roll() > v or v.rate() > 2;"
