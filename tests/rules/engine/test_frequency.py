"""Frequencies, as the reference engine and the emitted monitor have them between two events."""

from __future__ import annotations

import math

import pytest

from deros.generators.monitor.python.run import GeneratedMonitor
from deros.rules.engine.engine import Engine
from deros.rules.engine.evaluate import per_second
from deros.rules.program.ir import Program
from tests.support.timelines import program

RULES = """use "robot.system" import Robot
action stop;
input v = topic /speed.data
entity e { slow: v.frequency(3) < 2 Hz; }
if e.slow then { stop; };
"""


@pytest.fixture
def slow() -> Program:
    """Return a program that asks for a frequency."""
    return program(RULES)


def _come(engine: Engine, *times_ns: int) -> None:
    for t_ns in times_ns:
        engine.message(t_ns, "/speed", {0: 0.1})


def test_grace_stands_for_messages_that_have_not_come(slow: Program) -> None:
    """They count from the end of the grace, as timeouts do; a message in it counts as it comes."""
    engine = Engine(slow, start_ns=100, grace_ns=10**9)
    assert engine.next_deadline == 100 + 10**9 + 1_500_000_001
    _come(engine, 200, 300)
    assert engine.next_deadline == 100 + 10**9 + 1_500_000_001
    _come(engine, 400)
    assert engine.next_deadline == 200 + 1_500_000_001


def test_step_has_no_grace(slow: Program) -> None:
    """After a step back the new time stands for the messages that were forgotten."""
    engine = Engine(slow, start_ns=5 * 10**9, grace_ns=10**9)
    _come(engine, 6 * 10**9, 6 * 10**9 + 1, 6 * 10**9 + 2, 3 * 10**9)
    assert engine.next_deadline == 3 * 10**9 + 1_500_000_001


def test_deadline_is_that_of_the_emitted_monitor(slow: Program) -> None:
    """Both wake at the same nanosecond; a monitor may wake earlier, and then in vain."""
    engine, emitted = Engine(slow), GeneratedMonitor(slow)
    for t_ns in (400_000_000, 800_000_000, 1_200_000_000):
        for monitor in (engine, emitted):
            monitor.message(t_ns, "/speed", {0: 0.1})
    assert engine.next_deadline == 400_000_000 + 1_500_000_001
    assert emitted.next_deadline is not None
    assert emitted.next_deadline <= engine.next_deadline
    assert engine.advance(1_900_000_000) == emitted.advance(1_900_000_000) == []
    assert [each.action for each in emitted.advance(1_900_000_001)] == ["stop"]
    assert [each.action for each in engine.advance(1_900_000_001)] == ["stop"]


def test_cause_is_the_frequency_at_the_event(slow: Program) -> None:
    """It is that of the deadline, cut to a µHz, so that it is less than its bound."""
    engine = Engine(slow)
    _come(engine, 400_000_000, 800_000_000, 1_200_000_000)
    engine.advance(1_900_000_001)
    explained = engine.explain()
    assert explained.causes["behaviour_1"] == ("e.slow: v.frequency(3) 1.999999 < 2 Hz",)
    assert explained.rules[0].reads == (("v.frequency(3)", 1.999999),)


def test_no_time_is_an_infinite_frequency() -> None:
    """Messages of one instant, and those that the grace stands for, have none between them."""
    assert per_second(3, 0) == per_second(3, -5) == math.inf
    assert per_second(10, 1_600_000_000) == 6.25
    assert per_second(1, 3 * 10**9) == 0.333333
