"""The Frobit's controllers and rules on its physics, in simulated time and without ROS."""

from __future__ import annotations

import json
from typing import Any

import pytest

from tests.examples.test_frobit import AXLE, PERIOD, TICKS, differential, regulation, verdicts
from tests.support.examples import example_module

pytest.importorskip("mujoco", reason="the extra 'physics' is not installed")

physics = example_module("physics", "wheeled_physics.robot")
FROBIT = example_module("physics", "wheeled_physics.measures").FROBIT
STAND, STRAIGHT, TURN = (0.0, 0.0), (0.3, 0.0), (0.0, 1.0)


class Loop:
    """The robot and what its nodes do every 20 ms, with the messages that its rules read."""

    def __init__(self) -> None:
        """Stand."""
        self.robot = physics.Robot(FROBIT)
        self.tachometers = [regulation.Tachometer(TICKS) for _ in physics.SIDES]
        self.regulators = [regulation.Regulator(12.0, 0.05, 0.3) for _ in physics.SIDES]
        self.setpoints = [0.0, 0.0]
        self.lines: list[str] = []

    def drive(self, motion: tuple[float, float], duration: float) -> None:
        """Drive at a speed (m/s) and a turn rate (rad/s) for some seconds."""
        wanted = AXLE.wheels(*motion)
        for _ in range(round(duration / PERIOD)):
            speeds, thrusts = [], []
            for number, side in enumerate(physics.SIDES):
                self.tachometers[number].count(self.robot.encoder(side), self.robot.time)
                speed = self.tachometers[number].speed()
                setpoint = differential.towards(
                    self.setpoints[number], wanted[number], PERIOD / FROBIT.wheel_radius
                )
                thrust = self.regulators[number].thrust(setpoint, speed, PERIOD)
                self.setpoints[number] = setpoint
                speeds.append(speed)
                thrusts.append(thrust)
                for name, value in (("setpoint", setpoint), ("thrust", thrust), ("speed", speed)):
                    self._say(f"/{side}/{name}", {"data": value})
            self._say("/odometry", {"twist.twist.linear.x": AXLE.motion(*speeds)[0]})
            self.robot.thrust(*thrusts)
            self.robot.step(PERIOD)

    def _say(self, topic: str, data: dict[str, Any]) -> None:
        self.lines.append(json.dumps({"t": f"{self.robot.time:.3f}", "topic": topic, "data": data}))


def test_whole_robot_sets_off_turns_and_halts_without_a_stop() -> None:
    """Slip, lag and the encoders' delay are within the tolerance of the rules."""
    loop = Loop()
    for motion in (STAND, STRAIGHT, TURN, STRAIGHT, STAND, STRAIGHT):
        loop.drive(motion, 2.0)
    assert verdicts(loop.lines, 12.0) == []
    assert loop.robot.encoder("right") > 2 * TICKS, "it has not moved"


@pytest.mark.parametrize(
    ("fault", "most"),
    [("left_encoder", 0.7), ("right_encoder", 0.7), ("left_motor", 1.5), ("right_motor", 1.5)],
)
def test_cut_line_stops_the_robot(fault: str, most: float) -> None:
    """An encoder's soon, though the counts come late; without its motor a wheel rolls on a while.

    The other wheel drags it along, the slower the more its gear resists.
    """
    loop = Loop()
    loop.drive(STRAIGHT, 3.0)
    loop.robot.fail(fault)
    loop.drive(STRAIGHT, 2.0)
    when, action, _ = verdicts(loop.lines, 5.0)[0]
    assert action == "stop"
    assert 3.3 < when < 3.0 + most


def test_stuck_throttle_stops_the_robot_when_it_should_halt() -> None:
    """Half a second later, once the wheel should have rolled out."""
    loop = Loop()
    loop.drive(STRAIGHT, 3.0)
    loop.robot.fail("left_throttle")
    loop.drive(STAND, 2.0)
    when, action, behaviour = verdicts(loop.lines, 5.0)[0]
    assert (action, behaviour) == ("stop", "wheel_astray")
    assert 3.5 <= when < 4.0


def test_same_drive_gives_the_same_messages() -> None:
    """Byte for byte, with a fault in it."""
    drives = []
    for _ in range(2):
        loop = Loop()
        loop.drive(STRAIGHT, 1.0)
        loop.robot.fail("caster")
        loop.drive(TURN, 1.0)
        drives.append(loop.lines)
    assert drives[0] == drives[1]
