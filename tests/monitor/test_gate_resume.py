"""The reference gate after a zero: what it takes until commands pass again."""

from __future__ import annotations

import math
from typing import Any

import pytest

from deros.interfaces.types import InterfaceType
from deros.monitor.commands import is_zero, zero
from tests.support.gate_driver import INPUT, LOW, STOP, Driver, at, shown, twist
from tests.support.rules import embedded_store

HEARTBEAT = "lost heartbeat for 0.3 sec: zero until reset;"
PLAIN_HEARTBEAT = "lost heartbeat for 0.3 sec: zero;"
RESUME = "resume on zero command;"

# until reset --------------------------------------------------------------------------------------


def test_a_latched_loss_outlasts_its_end() -> None:
    """The heartbeat is back, the stop is known to be off, commands come: zero until the reset."""
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


def test_a_start_is_latched() -> None:
    """A gate that has been started again cannot know what was latched before, and needs a reset."""
    gate = Driver(STOP, HEARTBEAT).open()
    assert gate.engine.applying == (False, False, True)
    assert gate.drive(10, 0.5) == []
    assert gate.reset(11) == ()
    assert gate.drive(12, 0.5) == [(12, "pass", 0.5)]


def test_a_reset_publishes_nothing() -> None:
    """It starts nothing: the next command is the first to pass."""
    gate = Driver(STOP, HEARTBEAT).open()
    before = len(gate.engine.outputs)
    gate.drive(10, 0.5)
    assert gate.reset(11) == ()
    assert len(gate.engine.outputs) == before
    assert gate.wait(200) == []


def test_a_reset_is_refused_while_something_is_lost_or_active() -> None:
    """It names the lines that apply, and is not remembered."""
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


def test_a_limit_of_an_action_refuses_no_reset() -> None:
    """A robot that may be slow may be reset; one whose input is lost may not, slow or not."""
    gate = Driver(LOW, HEARTBEAT, "lost input for 0.5 sec: limit linear.x to [-0.2, 0.2];").open()
    gate.state(1, "low_speed", True)
    assert gate.reset(2) == ()
    gate.beat(250)
    gate.beat(500)
    assert gate.reset(510) == (2,)


def test_a_reset_beats_no_deadline_of_its_instant() -> None:
    """What is due when it comes is settled first."""
    gate = Driver(HEARTBEAT).open()
    assert gate.reset(300) == (0,)


def test_no_limit_speaks_while_a_line_is_latched() -> None:
    """Nobody creeps on under the limit of an action that is written first."""
    gate = Driver(LOW, HEARTBEAT).open()
    gate.reset(1)
    gate.state(2, "low_speed", True)
    assert gate.drive(3, 0.5) == [(3, "limited", 0.1)]
    assert gate.wait(300) == [(300, "zero", 0.0)]
    gate.beat(310)
    gate.drive(311, 0.5)
    assert gate.wait(350) == [(350, "zero", 0.0)]


def test_nor_does_the_limit_of_a_loss() -> None:
    """A zero until the reset is one in every number, wherever its line stands."""
    gate = Driver("lost heartbeat for 0.1 sec: limit linear.x to [-0.1, 0.1];", INPUT, HEARTBEAT)
    gate.open()
    gate.reset(1)
    gate.drive(290, 0.5)
    assert gate.wait(300) == [(300, "zero", 0.0)]


def test_a_refused_command_latches_a_lost_input() -> None:
    """One NaN is a loss like any other."""
    gate = Driver("lost input for 0.5 sec: zero until reset;").open()
    gate.reset(1)
    assert gate.drive(2, 0.5) == [(2, "pass", 0.5)]
    assert gate.drive(3, math.nan) == [(3, "zero", 0.0)]
    assert gate.drive(4, 0.5) == []
    assert gate.reset(5) == ()
    assert gate.drive(6, 0.5) == [(6, "pass", 0.5)]


def test_a_late_timer_latches_too() -> None:
    """A loss that nobody saw begin or end, because the gate hung, is one."""
    gate = Driver(HEARTBEAT).open()
    gate.reset(1)
    gate.drive(10, 0.5)
    assert gate.beat(5000) == [(300, "zero", 0.0)]
    assert gate.drive(5001, 0.5) == []
    assert gate.engine.applying == (False, True)


def test_an_action_can_be_latched_by_the_gate() -> None:
    """Then its end at the safety node is not enough."""
    gate = Driver("stop: zero until reset;").open()
    gate.reset(1)
    gate.state(2, "stop", True)
    gate.state(3, "stop", False)
    assert gate.drive(4, 0.5) == []
    assert gate.reset(5) == ()
    assert gate.drive(6, 0.5) == [(6, "pass", 0.5)]


def test_a_step_back_of_the_clock_is_latched() -> None:
    """Everything is lost then, as at the start."""
    gate = Driver(STOP, HEARTBEAT).open()
    gate.reset(100)
    gate.drive(100, 0.5)
    gate.beat(40)
    gate.beat(41)
    gate.state(42, "stop", False)
    assert gate.drive(43, 0.5) == []
    assert gate.reset(44) == ()


def test_a_reset_of_nothing_is_done() -> None:
    """It changes nothing."""
    gate = Driver(HEARTBEAT).open()
    assert gate.reset(1) == gate.reset(2) == ()
    assert gate.drive(3, 0.5) == [(3, "pass", 0.5)]


# resume on zero command ---------------------------------------------------------------------------


@pytest.mark.parametrize("line", [STOP, PLAIN_HEARTBEAT, INPUT])
def test_nothing_passes_after_the_start_before_a_zero_command(line: str) -> None:
    """The zero itself passes, and so does what follows."""
    gate = Driver(line, RESUME).open()
    assert gate.drive(10, 0.5) == []
    assert gate.engine.applying == (False, True)
    assert gate.stand(20) == [(20, "pass", 0.0)]
    assert gate.engine.applying == (False, False)
    assert gate.drive(30, 0.5) == [(30, "pass", 0.5)]


def test_an_action_that_ends_starts_nothing() -> None:
    """The controller that never stopped commanding waits until it has commanded zero."""
    gate = Driver(STOP, RESUME).open()
    gate.stand(1)
    gate.drive(10, 0.5)
    assert gate.state(20, "stop", True) == [(20, "zero", 0.0)]
    assert gate.state(30, "stop", False) == []
    assert gate.drive(40, 0.5) == []
    assert gate.wait(120) == [(70, "zero", 0.0), (120, "zero", 0.0)]
    assert gate.stand(130) == [(130, "pass", 0.0)]
    assert gate.drive(140, 0.5) == [(140, "pass", 0.5)]


def test_a_zero_command_during_a_stop_is_none() -> None:
    """It is stale when the stop ends: the controller may command anything by then."""
    gate = Driver(STOP, RESUME).open()
    gate.stand(1)
    gate.state(10, "stop", True)
    assert gate.stand(20) == []
    gate.state(30, "stop", False)
    assert gate.drive(40, 0.5) == []
    assert gate.stand(50) == [(50, "pass", 0.0)]


def test_a_zero_command_before_the_reset_is_none() -> None:
    """Reset first, then the controller's zero, then motion."""
    gate = Driver(HEARTBEAT, RESUME).open()
    gate.stand(1)
    assert gate.reset(2) == ()
    assert gate.drive(3, 0.5) == []
    assert gate.engine.applying == (False, False, True)
    gate.stand(4)
    assert gate.drive(5, 0.5) == [(5, "pass", 0.5)]


def test_the_zero_command_that_ends_a_lost_input_counts() -> None:
    """A controller that starts by commanding zero may go on at once."""
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
def test_what_is_not_exactly_zero_is_no_zero_command(speed: float, turn: float) -> None:
    """NaN and the least of speeds alike."""
    gate = Driver(STOP, RESUME).open()
    command: Any = {"linear": {"x": speed, "y": 0.0, "z": 0.0}, "angular": dict.fromkeys("xy", 0.0)}
    command["angular"]["z"] = turn
    assert gate.engine.command(at(10), command) == []
    assert gate.drive(20, 0.5) == []


def test_minus_zero_is_zero() -> None:
    """A controller that multiplies by -1 commands it."""
    gate = Driver(STOP, RESUME).open()
    command = {name: dict.fromkeys("xyz", -0.0) for name in ("linear", "angular")}
    assert shown(gate.engine.command(at(10), command)) == [(10, "pass", 0.0)]


def test_a_limit_lets_nothing_pass_that_waits() -> None:
    """Neither a limit that comes into force nor one that is written first."""
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


def test_a_limit_that_ends_waits_for_nothing() -> None:
    """A robot that was slow has not stood."""
    gate = Driver(LOW, RESUME).open()
    gate.stand(1)
    gate.state(2, "low_speed", True)
    assert gate.drive(3, 0.5) == [(3, "limited", 0.1)]
    gate.state(4, "low_speed", False)
    assert gate.drive(5, 0.5) == [(5, "pass", 0.5)]


def test_a_gate_without_a_zero_line_waits_at_its_start() -> None:
    """It commands zero then, and nothing else does."""
    gate = Driver(LOW, RESUME)
    assert gate.wait(50) == [(0, "zero", 0.0), (50, "zero", 0.0)]
    gate.state(51, "low_speed", False)
    assert gate.drive(60, 0.5) == []
    assert gate.stand(70) == [(70, "pass", 0.0)]


def test_a_step_back_of_the_clock_waits() -> None:
    """As the start does."""
    gate = Driver(LOW, RESUME).open()
    gate.stand(100)
    gate.drive(101, 0.5)
    assert gate.drive(50, 0.5) == [(50, "zero", 0.0)]
    assert gate.stand(60) == [(60, "pass", 0.0)]


# What a zero command is ---------------------------------------------------------------------------

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
def test_a_zero_command(kind: str, command: Any, expected: bool) -> None:
    """All numbers are 0 and flags false; stamps, texts and layouts are no motion."""
    package, name = kind.split(".")
    found = InterfaceType(package, "msg", name)
    assert is_zero(embedded_store(), found, command) is expected
    assert is_zero(embedded_store(), found, zero(embedded_store(), found, command, at(7)))
