"""Properties of the reference gate under any sequence of events."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from functools import cache
from itertools import pairwise
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deros.rules.gates.gate_engine import GateEngine, Output
from deros.rules.program.commands import Message, is_finite
from deros.rules.program.ir import Gate, GateLine, Program
from tests.support.gate_driver import ACTIONS, HEARTBEAT, INPUT, LOW, STOP, twist
from tests.support.rules import embedded_store, program

pytestmark = pytest.mark.essential

LIMIT = 0.1
LONG = 1_000  # longer than any time of a random gate

Happening = tuple[int, str, Any]

waits = st.sampled_from((0, 0, 1, 1, 2, 3, 5, 8, 13, 40))
waits_and_steps = waits | st.sampled_from((-1, -20))
speeds = st.sampled_from((-0.5, -0.1, -0.05, 0.0, 0.05, 0.1, 0.5, math.nan, math.inf, -math.inf))
calls = st.one_of(
    st.tuples(st.just("command"), st.builds(twist, speeds, speeds) | st.none()),
    st.tuples(st.sampled_from(("/stop", "/low_speed")), st.sampled_from((True, False, False))),
    st.tuples(st.just("beat"), st.sampled_from((1, 1, 1, 2, 0, -1))),
    st.tuples(st.sampled_from(("wait", "wait", "no_safety_node")), st.none()),
    st.tuples(st.just("stranger"), st.booleans()),
)


def histories(of_waits: st.SearchStrategy[int]) -> st.SearchStrategy[list[Happening]]:
    """Draw a sequence of events: time since the one before, kind, and value."""
    return st.lists(st.builds(lambda wait, call: (wait, *call), of_waits, calls), max_size=40)


@cache
def built(*lines: str) -> Program:
    """Build a gate of the given lines."""
    text = " ".join(lines)
    return program(f"{ACTIONS}gate /nav -> /cmd_vel : geometry_msgs.Twist rate 20 Hz {{ {text} }}")


@st.composite
def gates(draw: st.DrawFn, *orders: tuple[str, ...]) -> tuple[Gate, Program]:
    """Draw a gate with one of the given orders of lines and times of a few nanoseconds."""
    whole = built(*draw(st.sampled_from(orders)))
    (gate,) = whole.gates
    lines = tuple(
        line
        if line.lost_ns is None
        else dataclasses.replace(line, lost_ns=draw(st.integers(1, 30)))
        for line in gate.lines
    )
    return dataclasses.replace(gate, period_ns=draw(st.integers(1, 20)), lines=lines), whole


ZERO_FIRST = (STOP, HEARTBEAT, INPUT, LOW)
ALL_ORDERS = (
    ZERO_FIRST,
    (STOP, LOW, HEARTBEAT, INPUT),
    (LOW, STOP, INPUT, HEARTBEAT),
    (INPUT, LOW, HEARTBEAT, STOP),
)


class Run:
    """A running gate; ``check`` gets the run and the published commands after each call."""

    def __init__(self, gate: tuple[Gate, Program]) -> None:
        """Start at 0."""
        self.gate, whole = gate
        self.engine = GateEngine(self.gate, whole.actions, embedded_store())
        self.now = 0
        self.call = ""
        self.value: Any = None
        self.counter: int | None = None
        self.beat: int | None = None
        self.good: int | None = None
        self.said: dict[str, bool] = {}

    def live(
        self, history: list[Happening], check: Callable[[list[Output]], None] = lambda _: None
    ) -> None:
        """Run events; before each, handle deadlines one by one, as a timer does."""
        for wait, call, value in history:
            if wait < 0:
                self.counter = self.beat = self.good = None
                self.said.clear()
            self.call, self.value = "wait", None
            while (due := self.engine.next_deadline) is not None and due < self.now + wait:
                self.now, wait = due, self.now + wait - due
                check(self.engine.advance(due))
            self.now += wait
            self.call, self.value = call, value
            check(self.happen(call, value))

    def happen(self, call: str, value: Any) -> list[Output]:
        """Handle one event now, and record it."""
        # Deadlines due before the event come first, with the state before it.
        published = self.engine.advance(self.now)
        if call == "command":
            published = published + self.engine.command(self.now, value)
            if value is not None and is_finite(value):
                self.good = self.now
        elif call == "beat":
            counter = (self.counter or 5) + value
            published = published + self.engine.heartbeat(self.now, counter)
            self.beat = self.now if self.counter is not None and value > 0 else None
            self.counter = counter
        elif call == "no_safety_node":
            published = published + self.engine.no_safety_node(self.now)
            self.counter = self.beat = None
            self.said.clear()
        elif call == "stranger":
            message = {"data": value}
            published = published + self.engine.state(self.now, "/stop", message, is_trusted=False)
            if value:
                self.said["/stop"] = True
        elif call != "wait":
            published = published + self.engine.state(self.now, call, {"data": value})
            self.said[call] = value
        return published

    def line(self, lost: str) -> GateLine:
        """Return the line about a loss."""
        return next(each for each in self.gate.lines if each.lost == lost)

    def is_silent(self, lost: str, t_ns: int) -> bool:
        """Return whether heartbeat or valid commands have been silent for the time of the line."""
        last = self.beat if lost == "heartbeat" else self.good
        return last is None or t_ns - last >= (self.line(lost).lost_ns or 0)


def speed(output: Output) -> float:
    """Return the commanded speed."""
    value: float = output.message["linear"]["x"]
    return value


def is_zero(message: Message) -> bool:
    """Return whether every number of a command is 0."""
    return all(not value for part in message.values() for value in part.values())


@given(gates(*ALL_ORDERS), histories(waits_and_steps))
def test_only_finite_commands_are_published(
    gate: tuple[Gate, Program], history: list[Happening]
) -> None:
    """NaN and infinity never pass, whatever the lines."""
    run = Run(gate)
    run.live(history)
    assert all(is_finite(output.message) for output in run.engine.outputs)


@given(gates(ZERO_FIRST), histories(waits_and_steps))
def test_silence_publishes_only_zeros(gate: tuple[Gate, Program], history: list[Happening]) -> None:
    """From the time that heartbeat or input have been silent for their time, all is zero.

    A heartbeat whose counter does not advance counts as silence, and so does one whose publisher is
    unknown or ambiguous.
    """
    run = Run(gate)

    def check(published: list[Output]) -> None:
        for each in published:
            if run.is_silent("heartbeat", each.t_ns) or run.is_silent("input", each.t_ns):
                assert each.kind == "zero"
                assert is_zero(each.message)

    run.live(history, check)


@given(gates(ZERO_FIRST), histories(waits_and_steps))
def test_stop_publishes_only_zeros(gate: tuple[Gate, Program], history: list[Happening]) -> None:
    """This holds unless the gate knows that the action is inactive."""
    run = Run(gate)

    def check(published: list[Output]) -> None:
        for each in published:
            if run.said.get("/stop", True):
                assert each.kind == "zero"
                assert is_zero(each.message)

    run.live(history, check)


@given(gates(*ALL_ORDERS), histories(waits_and_steps))
def test_limits_are_never_exceeded(gate: tuple[Gate, Program], history: list[Happening]) -> None:
    """This holds for every command published while the action is, or may be, active."""
    run = Run(gate)

    def check(published: list[Output]) -> None:
        for each in published:
            if run.said.get("/low_speed", True):
                assert abs(speed(each)) <= LIMIT

    run.live(history, check)


@given(gates(*ALL_ORDERS), histories(waits_and_steps), st.builds(twist, st.floats(-9, 9)))
def test_gate_can_always_be_opened(
    gate: tuple[Gate, Program], history: list[Happening], command: Message
) -> None:
    """After two heartbeats and all states inactive, the next command passes at once."""
    run = Run(gate)
    beats = [(0, "beat", 1), (0, "beat", 1)]
    run.live([*history, *beats, (0, "/stop", False), (0, "/low_speed", False)])
    published = run.engine.command(run.now, command)
    assert [(each.t_ns, each.kind) for each in published] == [(run.now, "pass")]
    assert published[0].message is command


@given(gates(*ALL_ORDERS), histories(waits_and_steps))
def test_only_commands_cause_motion(gate: tuple[Gate, Program], history: list[Happening]) -> None:
    """Output without a command is zero, or slower than the output before."""
    run = Run(gate)
    before = [0.0]

    def check(published: list[Output]) -> None:
        for each in published:
            if each.kind == "pass":
                assert (run.call, each.message) == ("command", run.value)
            elif run.call != "command" and each.kind == "limited":
                assert abs(speed(each)) <= abs(before[0])
            before[0] = speed(each)

    run.live(history, check)


@given(gates(*ALL_ORDERS), histories(waits))
def test_zeros_are_periodic(gate: tuple[Gate, Program], history: list[Happening]) -> None:
    """When all inputs are silent, zeros are never further apart than the period."""
    run = Run(gate)
    run.live([*history, (LONG, "wait", None)])
    lost = run.now - LONG + max(line.lost_ns or 0 for line in gate[0].lines)
    times = [output.t_ns for output in run.engine.outputs if output.t_ns > lost]
    period = gate[0].period_ns
    assert all(b - a == period for a, b in pairwise(times))
    assert times[0] - lost <= period
    assert run.now - times[-1] <= period
    assert all(is_zero(output.message) for output in run.engine.outputs if output.t_ns > lost)


def compare_late_calls(timely: Run, late: Run, history: list[Happening]) -> None:
    """Run the events with and without a timer; compare what is published other than zeros."""
    timely.live(history)
    for wait, call, value in history:
        late.now += wait
        late.happen(call, value)
    driven = [output for output in timely.engine.outputs if output.kind != "zero"]
    assert [output for output in late.engine.outputs if output.kind != "zero"] == driven


@given(gates(*ALL_ORDERS), histories(waits_and_steps))
def test_late_calls_give_the_same_commands(
    gate: tuple[Gate, Program], history: list[Happening]
) -> None:
    """A gate without a timer publishes the same for each message; only zeros are missing."""
    compare_late_calls(Run(gate), Run(gate), history)
