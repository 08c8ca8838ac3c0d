"""Limits whose ends are inputs or tunable constants, in milliseconds."""

from __future__ import annotations

import math
from typing import Any

import pytest

from deros.generators.runtime.python.deros_runtime.gate_limits import held
from deros.interfaces.types import INTEGER_RANGES
from tests.support.gate_driver import HEARTBEAT, INPUT, MS, STOP, Driver, Shown, at, shown

BOUNDED = "always: limit linear.x to [-0.5 m/s, greatest];"
DECLARED = """
input greatest = topic /speed.data [m/s] timeout 0.2 sec
const most = 2 m/s tunable in [0, 5] m/s
"""


class Bounded(Driver):
    """A gate of velocity commands, with the number that limits them."""

    def __init__(self, *lines: str, **constants: float) -> None:
        """Start at 0 a gate of these lines."""
        super().__init__(*lines, declared=DECLARED, constants=constants)

    def say(self, t_ms: float, number: float | None) -> Shown:
        """Publish the number; ``None`` is a message that cannot be decoded."""
        message: Any = None if number is None else {"data": number}
        return shown(self.engine.reading(at(t_ms), "/speed", message))


@pytest.fixture
def gate() -> Bounded:
    """Return a gate that passes commands within the limits, of which the upper one is 1 m/s."""
    made = Bounded(BOUNDED, STOP, INPUT)
    made.open()
    made.say(0, 1.0)
    return made


def test_end_is_that_of_the_last_message(gate: Bounded) -> None:
    """A wider limit holds for the next command, and publishes nothing."""
    assert gate.drive(10, 3.0) == [(10, "limited", 1.0)]
    assert gate.say(20, 2.0) == []
    assert gate.drive(30, 3.0) == [(30, "limited", 2.0)]
    assert gate.drive(40, 1.5) == [(40, "pass", 1.5)]


def test_narrower_limit_holds_for_the_command_in_effect(gate: Bounded) -> None:
    """It is published again, at once."""
    gate.drive(10, 3.0)
    assert gate.say(20, 0.25) == [(20, "limited", 0.25)]


def test_expired_end_is_zero_at_its_instant(gate: Bounded) -> None:
    """Inclusive, without another command; the other end of the limit still holds."""
    gate.drive(150, 3.0)
    assert gate.wait(199.999999) == []
    assert gate.wait(200) == [(200, "limited", 0.0)]
    assert gate.drive(210, 3.0) == [(210, "limited", 0.0)]
    assert gate.drive(220, -3.0) == [(220, "limited", -0.5)]
    assert gate.say(230, 1.0) == []
    assert gate.drive(240, 3.0) == [(240, "limited", 1.0)]


def test_late_call_lets_no_command_pass_an_expired_limit(gate: Bounded) -> None:
    """The expiry is settled first."""
    gate.drive(150, 3.0)
    assert gate.drive(250, 3.0) == [(200, "limited", 0.0), (250, "limited", 0.0)]


@pytest.mark.parametrize("number", [math.nan, None])
def test_end_that_is_no_number_is_zero_at_once(gate: Bounded, number: float | None) -> None:
    """Such a message does not count as one."""
    gate.drive(10, 3.0)
    assert gate.say(20, number) == [(20, "limited", 0.0)]
    assert "input greatest is unknown, so its bounds are 0" in gate.reported


def test_end_is_zero_before_the_first_message() -> None:
    """The gate reports that the input is unknown."""
    gate = Bounded(BOUNDED, STOP, INPUT)
    gate.open()
    assert gate.drive(10, 3.0) == [(10, "limited", 0.0)]
    assert gate.reported == ["input greatest is unknown, so its bounds are 0"]
    gate.say(20, 1.0)
    assert gate.reported == []


def test_end_is_forgotten_when_the_clock_steps_back(gate: Bounded) -> None:
    """It is zero until the next message, as at the start."""
    gate.drive(50, 3.0)
    gate.wait(10)
    gate.open()
    assert gate.drive(20, 3.0) == [(20, "limited", 0.0)]


@pytest.mark.parametrize(("number", "passed"), [(-0.25, 0.0), (-3.0, 0.0), (math.inf, 3.0)])
def test_end_never_makes_the_robot_move(gate: Bounded, number: float, passed: float) -> None:
    """An upper end below zero is zero; infinity is none."""
    gate.say(10, number)
    assert gate.drive(20, 3.0)[0][2] == passed
    assert gate.drive(30, 0.0) == [(30, "pass", 0.0)]


def test_interval_that_runs_backwards_is_zero(gate: Bounded) -> None:
    """The lower end, a constant, does not hold then either."""
    gate.say(10, -3.0)
    assert gate.drive(20, -0.25) == [(20, "limited", 0.0)]


def test_held_command_is_limited() -> None:
    """It stays as limited when the limit becomes wider again."""
    gate = Bounded(BOUNDED, "stop: hold;", INPUT)
    gate.open()
    gate.say(0, 2.0)
    gate.drive(10, 3.0)
    gate.state(20, "stop", True)
    assert gate.say(30, 1.0) == [(30, "hold", 1.0)]
    gate.say(40, 2.0)
    assert {each[2] for each in gate.wait(160)} == {1.0}


def test_ramp_falls_on_from_a_narrower_limit() -> None:
    """By its rate from there, and not up again."""
    gate = Bounded(BOUNDED, "stop: zero ramp linear.x 10 m/s2;", INPUT)
    gate.open()
    gate.say(0, 2.0)
    gate.drive(10, 3.0)
    gate.state(20, "stop", True)
    assert gate.say(70, 1.75) == [(70, "zero", 1.5)]  # its period, and no reason besides
    assert gate.say(80, 1.0) == [(80, "zero", 1.0)]
    assert gate.say(90, 2.0) == []
    assert gate.wait(130) == [(130, "zero", 0.5)]


def test_tunable_constant_limits() -> None:
    """As it is set, else as it is by default."""
    line = "always: limit linear.x to [-most, most];"
    assert Bounded(line, INPUT).open().drive(10, 9.0)[-1][2] == 2.0
    assert Bounded(line, INPUT, most=0.5).open().drive(10, -9.0)[-1][2] == -0.5


def test_limits_of_several_lines_hold_together() -> None:
    """That of an action, and the one that messages give."""
    gate = Bounded(BOUNDED, "low_speed: limit linear.x to [-0.1, 0.1] m/s;", INPUT, HEARTBEAT)
    gate.open()
    gate.say(0, 1.0)
    gate.state(10, "low_speed", True)
    assert gate.drive(20, 3.0) == [(20, "limited", 0.1)]
    assert gate.say(30, 0.05) == [(30, "limited", 0.05)]


@pytest.mark.parametrize("kind", sorted(set(INTEGER_RANGES) - {"byte", "char"}))
def test_end_of_an_integer_field_is_cut_to_its_type(kind: str) -> None:
    """Towards zero, and to the range."""
    least, greatest = INTEGER_RANGES[kind]
    assert held(math.inf, kind) == greatest
    assert held(-math.inf, kind) == least
    assert held(1e30, kind) == greatest
    assert (held(2.9, kind), held(-0.9, kind)) == (2, 0)
    assert held(-2.9, kind) == max(-2, least)
    assert isinstance(held(0.0, kind), int)


def test_times_are_whole_nanoseconds() -> None:
    """The timeout of the tests is that of the input."""
    gate = Bounded(BOUNDED, INPUT)
    assert gate.engine.table.inputs[0].silent_ns == 200 * MS
