"""What becomes of verdicts, foretold by a copy of a monitor, as time goes on without news."""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, given, settings

from deros.generators.monitor.python.interface import render_monitor
from deros.generators.monitor.python.run import GeneratedMonitor
from deros.generators.runtime.python.deros_runtime.look_ahead import (
    INSTANTS,
    SILENT,
    STAYING,
    LookAhead,
)
from deros.rules.engine.engine import Engine
from tests.support.counterexamples import Pair, pairs
from tests.support.foretold import foretold
from tests.support.monitors import START_NS, call, timed, with_arrays
from tests.support.rules import program
from tests.support.strategies import programs

SECOND = 10**9

RULES = """
    action stop;
    action go reset_by stop;
    input speed = topic /odom.twist.twist.linear.x timeout 500 ms
    input level = topic /status.level
    entity e {
      fast: speed > 1 for 2 sec;
      still: speed <= 1 within 3 sec;
      gone: speed.missing();
      high: level = ERROR for 1 sec;
    }
    if e.fast then { stop; };
    """


class Foretold:
    """A generated monitor, and what is foretold of its rules by their names."""

    def __init__(self, text: str) -> None:
        """Generate the monitor."""
        self.program = program(text)
        self.monitor = GeneratedMonitor(self.program)
        self.leaves = {each.topic: each.leaves[0] for each in self.program.inputs}

    def take(self, t_ns: int, topic: str, value: object) -> None:
        """Take a message with one value."""
        self.monitor.message(t_ns, topic, {self.leaves[topic]: value})  # type: ignore[dict-item]

    def of(self, case: str) -> dict[str, tuple[bool | None, float]]:
        """Return what is foretold in a case: the verdict and the time in seconds."""
        return {
            self.program.rules[place].name: (found[case].value, found[case].at / SECOND)
            for place, found in looked(self.monitor).found.items()
            if case in found
        }


def looked(monitor: GeneratedMonitor) -> LookAhead:
    """Look ahead to the end."""
    ahead = LookAhead(monitor._monitor)
    for _ in ahead.steps():
        pass
    return ahead


def test_interval_ends_while_the_values_stay() -> None:
    """Without a message the sensor is missing first, and the interval never ends."""
    robot = Foretold(RULES)
    robot.take(SECOND, "/odom", 2.0)
    assert robot.of(STAYING) == {"fast": (True, 3.0)}
    assert robot.of(SILENT) == {"fast": (None, 1.5), "still": (None, 1.5), "gone": (True, 1.5)}


def test_end_of_within_is_foretold() -> None:
    """What was true a moment ago counts for as long as the rule says."""
    robot = Foretold(RULES)
    robot.take(SECOND, "/odom", 0.5)
    robot.take(14 * SECOND // 10, "/odom", 2.0)
    assert robot.of(STAYING)["still"] == (False, 4.4)


def test_rule_without_a_deadline_has_none() -> None:
    """An input without a timeout may stay silent."""
    robot = Foretold(RULES)
    robot.take(SECOND, "/status", 0)
    assert "high" not in {**robot.of(STAYING), **robot.of(SILENT)}
    robot.take(2 * SECOND, "/status", 2)
    assert robot.of(SILENT)["high"] == robot.of(STAYING)["high"] == (True, 3.0)


def test_looking_ahead_changes_nothing_and_emits_nothing() -> None:
    """The copy is what acts: in the monitor the rule is false still, and nothing has happened."""
    robot = Foretold(RULES)
    robot.take(SECOND, "/odom", 2.0)
    before = robot.monitor.explain(), robot.monitor.next_deadline, list(robot.monitor.events)
    assert robot.of(STAYING)["fast"] == (True, 3.0)
    assert before == (robot.monitor.explain(), robot.monitor.next_deadline, robot.monitor.events)
    assert not robot.monitor.events


class Restless:
    """A monitor that always has something to do, and whose rule never changes."""

    next_deadline = 0

    def copy(self, _keeps: bool) -> Restless:
        """Return another one."""
        return Restless()

    def advance(self, t: int) -> None:
        """Find the next deadline."""
        self.next_deadline = t + 1

    def verdicts(self) -> tuple[bool]:
        """Return the verdict of the rule."""
        return (False,)


def test_work_is_bounded() -> None:
    """A fault that makes deadlines without end does not keep the diagnostics from going out."""
    ahead = LookAhead(Restless())  # type: ignore[arg-type]
    assert sum(1 for _ in ahead.steps()) == 2 * INSTANTS
    assert not ahead.found


thorough = settings(suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])


@thorough
@given(programs().flatmap(pairs))
def test_what_is_foretold_is_what_the_reference_engine_does(pair: Pair) -> None:
    """For any rules, and after any messages: at that instant, and not before."""
    check(pair)


@pytest.mark.slow
@thorough
@given(programs(kinds=("stamped", "number", "quaternion", "scan")).flatmap(pairs))
def test_so_is_what_is_foretold_of_functions_with_a_memory(pair: Pair) -> None:
    """The copy shares the memory of a rate with the monitor, and changes none of it."""
    check(pair)


def check(pair: Pair) -> None:
    """Look ahead after each call, and compare with an engine that plays the same deadlines."""
    start, rules = pair.start, pair.program
    chosen = dict(start.constants)
    texts = render_monitor(rules)
    engine = Engine(rules, START_NS, start.grace_ns, start.latched, chosen)
    monitor = GeneratedMonitor(rules, START_NS, texts, start.grace_ns, start.latched, chosen)
    for t_ns, step in timed(pair.steps):
        call(engine, t_ns, step)
        call(monitor, t_ns, with_arrays(rules, step))
        assert looked(monitor).found == foretold(engine, rules)
