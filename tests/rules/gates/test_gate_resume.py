"""The reference gate after a zero: conditions for commands to pass again."""

from __future__ import annotations

import math
from typing import Any

import pytest

from deros.interfaces.types import InterfaceType
from deros.rules.program.commands import is_zero, zero
from tests.support.gate_driver import INPUT, LOW, STOP, Driver, at, shown, twist
from tests.support.rules import embedded_store

HEARTBEAT = "lost heartbeat for 0.3 sec: zero until reset;"
PLAIN_HEARTBEAT = "lost heartbeat for 0.3 sec: zero;"
RESUME = "resume on zero command;"

# until reset --------------------------------------------------------------------------------------


def test_latched_loss_survives_its_end() -> None:
    """With heartbeat, states and commands back, zero is published until the reset."""
    gate = Driver(STOP, HEARTBEAT).open()
    assert gate.reset(1) == ()
    gate.drive(10, 0.5)
    assert gate.wait(300) == [(300, "zero", 0.0)]
    gate.beat(310)
    gate.state(311, "stop", False)
    assert gate.drive(320, 0.5) == []
    assert gate.wait(400) == [(350, "zero", 0.0), (400, "zero", 0.0)]
    assert gate.reset(401) == ()
    assert gate.drive(402, 0.5) == [(402, "pass", 0.5)]


def test_start_is_latched() -> None:
    """A restarted gate cannot know earlier latches, and needs a reset."""
    gate = Driver(STOP, HEARTBEAT).open()
    assert gate.engine.applying == (False, False, True)
    assert gate.drive(10, 0.5) == []
    assert gate.reset(11) == ()
    assert gate.drive(12, 0.5) == [(12, "pass", 0.5)]


def test_reset_publishes_nothing() -> None:
    """It starts no motion: the next command is the first to pass."""
    gate = Driver(STOP, HEARTBEAT).open()
    before = len(gate.engine.outputs)
    gate.drive(10, 0.5)
    assert gate.reset(11) == ()
    assert len(gate.engine.outputs) == before
    assert gate.wait(200) == []


def test_reset_is_refused_during_a_loss_or_stop() -> None:
    """It returns the lines that apply, and is not repeated."""
    gate = Driver(STOP, HEARTBEAT, INPUT)
    assert gate.reset(0) == (0, 1, 2)
    gate.beat(1)
    gate.beat(2)
    assert gate.reset(3) == (0, 2)
    gate.drive(4, 0.5)
    assert gate.reset(5) == (0,)
    gate.state(6, "stop", False)
    assert gate.drive(7, 0.5) == []
    assert gate.reset(8) == ()
    assert gate.drive(9, 0.5) == [(9, "pass", 0.5)]


def test_limit_of_an_action_does_not_refuse_a_reset() -> None:
    """A slow robot may be reset; one with a lost input may not, slow or not."""
    gate = Driver(LOW, HEARTBEAT, "lost input for 0.5 sec: limit linear.x to [-0.2, 0.2];").open()
    gate.state(1, "low_speed", True)
    assert gate.reset(2) == ()
    gate.beat(250)
    gate.beat(500)
    assert gate.reset(510) == (2,)


def test_deadline_precedes_a_reset_at_the_same_time() -> None:
    """Deadlines due at the time of the reset are handled first."""
    gate = Driver(HEARTBEAT).open()
    assert gate.reset(300) == (0,)


def test_limit_does_not_apply_while_a_line_is_latched() -> None:
    """The robot does not creep under the limit of an action that is written first."""
    gate = Driver(LOW, HEARTBEAT).open()
    gate.reset(1)
    gate.state(2, "low_speed", True)
    assert gate.drive(3, 0.5) == [(3, "limited", 0.1)]
    assert gate.wait(300) == [(300, "zero", 0.0)]
    gate.beat(310)
    gate.drive(311, 0.5)
    assert gate.wait(350) == [(350, "zero", 0.0)]


def test_limit_of_a_loss_does_not_apply_while_a_line_is_latched() -> None:
    """A latched zero applies to every field, wherever its line is."""
    gate = Driver("lost heartbeat for 0.1 sec: limit linear.x to [-0.1, 0.1];", INPUT, HEARTBEAT)
    gate.open()
    gate.reset(1)
    gate.drive(290, 0.5)
    assert gate.wait(300) == [(300, "zero", 0.0)]


def test_refused_command_latches_a_lost_input() -> None:
    """A NaN is a loss like any other."""
    gate = Driver("lost input for 0.5 sec: zero until reset;").open()
    gate.reset(1)
    assert gate.drive(2, 0.5) == [(2, "pass", 0.5)]
    assert gate.drive(3, math.nan) == [(3, "zero", 0.0)]
    assert gate.drive(4, 0.5) == []
    assert gate.reset(5) == ()
    assert gate.drive(6, 0.5) == [(6, "pass", 0.5)]


def test_late_timer_latches_too() -> None:
    """A loss that began and ended while the gate hung is latched."""
    gate = Driver(HEARTBEAT).open()
    gate.reset(1)
    gate.drive(10, 0.5)
    assert gate.beat(5000) == [(300, "zero", 0.0)]
    assert gate.drive(5001, 0.5) == []
    assert gate.engine.applying == (False, True)


def test_gate_may_latch_an_action() -> None:
    """The end of the action at the safety node is then not enough."""
    gate = Driver("stop: zero until reset;").open()
    gate.reset(1)
    gate.state(2, "stop", True)
    gate.state(3, "stop", False)
    assert gate.drive(4, 0.5) == []
    assert gate.reset(5) == ()
    assert gate.drive(6, 0.5) == [(6, "pass", 0.5)]


def test_clock_step_is_latched() -> None:
    """Everything is lost, as at the start."""
    gate = Driver(STOP, HEARTBEAT).open()
    gate.reset(100)
    gate.drive(100, 0.5)
    gate.beat(40)
    gate.beat(41)
    gate.state(42, "stop", False)
    assert gate.drive(43, 0.5) == []
    assert gate.reset(44) == ()


def test_reset_without_a_latch_succeeds() -> None:
    """It changes nothing."""
    gate = Driver(HEARTBEAT).open()
    assert gate.reset(1) == gate.reset(2) == ()
    assert gate.drive(3, 0.5) == [(3, "pass", 0.5)]


# resume on zero command ---------------------------------------------------------------------------


@pytest.mark.parametrize("line", [STOP, PLAIN_HEARTBEAT, INPUT])
def test_zero_command_is_required_after_the_start(line: str) -> None:
    """The zero itself passes, and so do the commands after it."""
    gate = Driver(line, RESUME).open()
    assert gate.drive(10, 0.5) == []
    assert gate.engine.applying == (False, True)
    assert gate.stand(20) == [(20, "pass", 0.0)]
    assert gate.engine.applying == (False, False)
    assert gate.drive(30, 0.5) == [(30, "pass", 0.5)]


def test_zero_command_is_required_after_a_stop() -> None:
    """A controller that kept commanding motion must first command zero."""
    gate = Driver(STOP, RESUME).open()
    gate.stand(1)
    gate.drive(10, 0.5)
    assert gate.state(20, "stop", True) == [(20, "zero", 0.0)]
    assert gate.state(30, "stop", False) == []
    assert gate.drive(40, 0.5) == []
    assert gate.wait(120) == [(70, "zero", 0.0), (120, "zero", 0.0)]
    assert gate.stand(130) == [(130, "pass", 0.0)]
    assert gate.drive(140, 0.5) == [(140, "pass", 0.5)]


def test_zero_command_during_a_stop_does_not_count() -> None:
    """It is outdated when the stop ends: the controller may command motion by then."""
    gate = Driver(STOP, RESUME).open()
    gate.stand(1)
    gate.state(10, "stop", True)
    assert gate.stand(20) == []
    gate.state(30, "stop", False)
    assert gate.drive(40, 0.5) == []
    assert gate.stand(50) == [(50, "pass", 0.0)]


def test_zero_command_before_the_reset_does_not_count() -> None:
    """The order is reset, zero command, motion."""
    gate = Driver(HEARTBEAT, RESUME).open()
    gate.stand(1)
    assert gate.reset(2) == ()
    assert gate.drive(3, 0.5) == []
    assert gate.engine.applying == (False, False, True)
    gate.stand(4)
    assert gate.drive(5, 0.5) == [(5, "pass", 0.5)]


def test_zero_command_that_ends_a_lost_input_counts() -> None:
    """A controller that starts with zero may continue at once."""
    gate = Driver(INPUT, RESUME)
    gate.wait(0)
    assert gate.stand(10) == [(10, "pass", 0.0)]
    assert gate.drive(20, 0.5) == [(20, "pass", 0.5)]
    assert gate.wait(520) == [(520, "zero", 0.0)]
    assert gate.drive(530, 0.5) == []
    assert gate.stand(540) == [(540, "pass", 0.0)]


@pytest.mark.parametrize(
    ("speed", "turn"), [(math.nan, 0.0), (0.0, math.inf), (5e-324, 0.0), (0.0, -1e-9)]
)
def test_nearly_zero_is_not_a_zero_command(speed: float, turn: float) -> None:
    """NaN and the smallest speed do not count."""
    gate = Driver(STOP, RESUME).open()
    command: Any = {"linear": {"x": speed, "y": 0.0, "z": 0.0}, "angular": dict.fromkeys("xy", 0.0)}
    command["angular"]["z"] = turn
    assert gate.engine.command(at(10), command) == []
    assert gate.drive(20, 0.5) == []


def test_minus_zero_is_a_zero_command() -> None:
    """A controller that multiplies by -1 sends it."""
    gate = Driver(STOP, RESUME).open()
    command = {name: dict.fromkeys("xyz", -0.0) for name in ("linear", "angular")}
    assert shown(gate.engine.command(at(10), command)) == [(10, "pass", 0.0)]


def test_limit_does_not_release_a_waiting_gate() -> None:
    """Neither a new limit nor one that is written first lets a command pass."""
    gate = Driver(LOW, STOP, RESUME).open()
    gate.stand(1)
    gate.drive(2, 0.5)
    gate.state(3, "stop", True)
    gate.state(4, "low_speed", True)
    gate.drive(5, 0.5)
    assert gate.wait(53) == [(53, "zero", 0.0)]
    gate.state(60, "stop", False)
    assert gate.drive(70, 0.05) == []
    gate.stand(80)
    assert gate.drive(90, 0.5) == [(90, "limited", 0.1)]


def test_end_of_a_limit_needs_no_zero_command() -> None:
    """A robot under a limit was not stopped."""
    gate = Driver(LOW, RESUME).open()
    gate.stand(1)
    gate.state(2, "low_speed", True)
    assert gate.drive(3, 0.5) == [(3, "limited", 0.1)]
    gate.state(4, "low_speed", False)
    assert gate.drive(5, 0.5) == [(5, "pass", 0.5)]


def test_gate_without_a_zero_line_waits_at_the_start() -> None:
    """The start is its only zero."""
    gate = Driver(LOW, RESUME)
    assert gate.wait(50) == [(0, "zero", 0.0), (50, "zero", 0.0)]
    gate.state(51, "low_speed", False)
    assert gate.drive(60, 0.5) == []
    assert gate.stand(70) == [(70, "pass", 0.0)]


def test_clock_step_requires_a_zero_command() -> None:
    """It is handled like a start."""
    gate = Driver(LOW, RESUME).open()
    gate.stand(100)
    gate.drive(101, 0.5)
    assert gate.drive(50, 0.5) == [(50, "zero", 0.0)]
    assert gate.stand(60) == [(60, "pass", 0.0)]


# Zero commands ------------------------------------------------------------------------------------

TWIST_STAMPED = {
    "header": {"stamp": {"sec": 5, "nanosec": 6}, "frame_id": "base"},
    "twist": {name: dict.fromkeys("xyz", 0.0) for name in ("linear", "angular")},
}
ARRAY = {"layout": {"dim": [{"label": "x", "size": 2, "stride": 2}], "data_offset": 1}}


@pytest.mark.parametrize(
    ("kind", "command", "expected"),
    [
        ("geometry_msgs.TwistStamped", TWIST_STAMPED, True),
        ("geometry_msgs.Quaternion", {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}, True),
        ("geometry_msgs.Quaternion", {"x": 0.0, "y": 0.0, "z": 1.0, "w": 0.0}, False),
        ("std_msgs.Float64MultiArray", {**ARRAY, "data": [0.0, 0.0]}, True),
        ("std_msgs.Float64MultiArray", {**ARRAY, "data": [0.0, 0.1]}, False),
        ("std_msgs.Float64MultiArray", {**ARRAY, "data": []}, True),
        ("std_msgs.Bool", {"data": True}, False),
        ("std_msgs.Bool", {"data": False}, True),
        ("geometry_msgs.Twist", twist(0.0), False),
    ],
)
def test_recognition_of_zero_commands(kind: str, command: Any, expected: bool) -> None:
    """All numbers are 0 and flags false; stamps, strings and layouts do not matter."""
    package, name = kind.split(".")
    message_type = InterfaceType(package, "msg", name)
    assert is_zero(embedded_store(), message_type, command) is expected
    assert is_zero(
        embedded_store(), message_type, zero(embedded_store(), message_type, command, at(7))
    )
