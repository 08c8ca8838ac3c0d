"""The Frobit's controllers and rules on its physics, in simulated time and without ROS."""

from __future__ import annotations

import random
from dataclasses import replace
from typing import Any

import pytest

from tests.examples.test_frobit import AXLE, PERIOD, TICKS, differential, regulation, route
from tests.support.examples import example_module
from tests.support.judge import Judge, each_of_20_robots

pytest.importorskip("mujoco", reason="the extra 'physics' is not installed")

FrobitBoard = example_module("physics", "wheeled_physics.frobit_board").FrobitBoard
FROBIT = example_module("physics", "wheeled_physics.measures").FROBIT
FAULTS = example_module("physics", "wheeled_physics.robot").FAULTS
SIDES = ("left", "right")
STAND, STRAIGHT, TURN = (0.0, 0.0), (0.3, 0.0), (0.0, 1.0)
HALT = 1.5
"""Time, in s, from a fault until the robot is to halt: by then a throttle that sticks has stuck."""

SEEN = {
    "left_encoder": ({"left_wheel.no_answer"}, 0.3, 0.7),
    "right_encoder": ({"right_wheel.no_answer"}, 0.3, 0.7),
    "left_motor": ({"left_wheel.astray"}, 0.5, 1.5),
    "right_motor": ({"right_wheel.astray"}, 0.5, 1.5),
    "left_throttle": ({"left_wheel.astray"}, HALT + 0.5, HALT + 0.7),
    "right_throttle": ({"right_wheel.astray"}, HALT + 0.5, HALT + 0.7),
    "left_runaway": ({"left_wheel.astray"}, 0.5, 0.9),
    "right_runaway": ({"right_wheel.astray"}, 0.5, 0.9),
    "runaway": ({"drive_system.max_speed_exceeded"}, 0.2, 0.9),
    "line": ({"left_wheel.silent", "right_wheel.silent", "drive_system.silent"}, 0.5, 0.75),
}
"""The rules that find each fault, and the least and the most seconds that it takes."""


UNSEEN = ("caster", "battery", "gyro")
"""The wheels are regulated, and turn as told with these; no rule reads a gyroscope."""


class Loop:
    """The robot and what its nodes do every 20 ms, with the messages that its rules read."""

    def __init__(self, seed: int = 0, measures: Any = None) -> None:
        """Stand; a seed is another robot, unless it has measures of its own."""
        self.board = FrobitBoard(seed, measures)
        self.robot = self.board.robot
        self.tachometers = [regulation.Tachometer(TICKS) for _ in SIDES]
        self.regulators = [regulation.Regulator(12.0, 0.05, 0.3) for _ in SIDES]
        self.setpoints = [0.0, 0.0]
        self.pose = differential.Pose()
        self.judge = Judge("frobit")

    def drive(self, motion: tuple[float, float], duration: float) -> None:
        """Drive at a speed (m/s) and a turn rate (rad/s) for some seconds."""
        for _ in range(round(duration / PERIOD)):
            self.cycle(motion)

    def cycle(self, motion: tuple[float, float]) -> None:
        """Drive so for a cycle of the nodes."""
        wanted = AXLE.wheels(*motion)
        now = self.robot.time
        speeds = []
        for number, side in enumerate(SIDES):
            tachometer = self.tachometers[number]
            if self.robot.heard:
                tachometer.count(self.board.ticks(side), now)
            seen = tachometer.age(now) <= 0.2
            speed = tachometer.speed()
            setpoint = differential.towards(
                self.setpoints[number], wanted[number], PERIOD / AXLE.wheel_radius
            )
            self.setpoints[number] = setpoint
            thrust = self.regulators[number].thrust(setpoint if seen else 0.0, speed, PERIOD)
            self.board.command(side, thrust)
            self.judge.hear(now, f"/{side}/setpoint", {"data": setpoint})
            self.judge.hear(now, f"/{side}/thrust", {"data": thrust})
            if seen:
                self.judge.hear(now, f"/{side}/speed", {"data": speed})
                speeds.append(speed)
        if len(speeds) == len(SIDES):
            forward, turn = AXLE.motion(*speeds)
            self.pose.advance(forward, turn, PERIOD)
            self.judge.hear(now, "/odometry", {"twist.twist.linear.x": forward})
        self.board.advance(PERIOD)
        self.judge.advance(self.robot.time)


def with_fault(fault: str, seed: int) -> tuple[Loop, float]:
    """Return a drive with a fault, straight on and then to halt, and the time (s) of the fault."""
    loop = Loop(seed)
    loop.drive(STRAIGHT, 1.5 + PERIOD * random.Random(seed).randrange(50))
    began = loop.robot.time
    loop.robot.fail(fault)
    loop.drive(STRAIGHT, HALT)
    loop.drive(STAND, 1.0)
    return loop, began


def test_every_fault_of_the_hardware_is_tried() -> None:
    """Those that the rules see, and those that they do not."""
    assert {*SEEN, *UNSEEN} == {*FAULTS}


@each_of_20_robots
@pytest.mark.parametrize("fault", SEEN)
def test_rules_find_a_fault_in_time_in_each_of_20_robots(fault: str, seeds: range) -> None:
    """Robots, noise and the time of the fault differ by the seed; the first to act is its rule."""
    rules, least, most = SEEN[fault]
    for seed in seeds:
        loop, began = with_fault(fault, seed)
        loop.judge.require_stop(rules, began + least - PERIOD, began + most, f"seed {seed}")


@each_of_20_robots
@pytest.mark.parametrize("fault", UNSEEN)
def test_robot_with_a_fault_that_no_rule_sees_goes_as_it_is_told(fault: str, seeds: range) -> None:
    """None is stopped, and each halts when it is to."""
    for seed in seeds:
        loop, _ = with_fault(fault, seed)
        assert loop.judge.verdicts == [], f"seed {seed}"
        assert loop.robot.speed() < 0.05, f"seed {seed}"


def test_wheel_whose_gear_hardly_resists_is_dragged_along_unseen() -> None:
    """A limit of the rules, which the README states: the wheel stays within the tolerance."""
    loop = Loop(measures=replace(FROBIT, gear_friction=0.02))
    loop.drive(STRAIGHT, 2.0)
    loop.robot.fail("left_motor")
    loop.drive(STRAIGHT, 3.0)
    assert loop.judge.verdicts == []
    assert loop.robot.wheel_speed("left") < 0.9 * loop.robot.wheel_speed("right")


@each_of_20_robots
def test_faster_than_the_route_is_driven_slows_the_robot_down(seeds: range) -> None:
    """A route driver that wants 0.42 m/s gets low speed after 2 s, and no stop."""
    for seed in seeds:
        loop = Loop(seed)
        loop.drive((0.42, 0.0), 4.0)
        first, *others = loop.judge.verdicts
        assert (first.action, others) == ("low_speed", []), f"seed {seed}"
        assert first.rules == {"drive_system.cruise_speed_exceeded"}, f"seed {seed}"
        assert 2.3 < first.time < 3.2, f"seed {seed}"


@each_of_20_robots
@pytest.mark.parametrize("fault", ["left_throttle", "left_runaway", "runaway"])
def test_relay_ends_what_no_command_can(fault: str, seeds: range) -> None:
    """The robot rolls out, slowed by its gears."""
    for seed in seeds:
        loop, _ = with_fault(fault, seed)
        assert loop.robot.speed() > 0.05, f"seed {seed}"
        loop.robot.relay(True)
        loop.drive(STAND, 2.0)
        assert loop.robot.speed() < 0.01, f"seed {seed}"


@pytest.mark.slow
def test_nothing_stops_a_robot_in_ten_minutes_of_its_route() -> None:
    """Slip, lag, delay and noise are within the tolerance of the rules, round after round.

    A person lets the switch go for one second of nine, as in a rehearsal.
    """
    loop = Loop(1)
    corners = route.pairs([1.5, 0.0, 1.5, 1.0, 0.0, 1.0, 0.0, 0.0])
    way = route.Route(corners, 0.3)
    rounds = before = 0
    while loop.robot.time < 600.0:
        pose = loop.pose
        held = loop.robot.time % 9.0 >= 1.0
        loop.cycle(way.command(pose.x, pose.y, pose.yaw) if held else STAND)
        rounds += before == 3 and way._next == 0
        before = way._next
    assert loop.judge.verdicts == []
    assert rounds > 20


@each_of_20_robots
def test_motor_that_is_cut_before_the_robot_sets_off_stops_it(seeds: range) -> None:
    """The wheel does not answer to thrust, or is dragged along too slowly."""
    for seed in seeds:
        loop = Loop(seed)
        loop.robot.fail("right_motor")
        loop.drive(STRAIGHT, 3.0)
        first = loop.judge.verdicts[0]
        assert first.action == "stop", f"seed {seed}"
        assert 0.3 < first.time < 1.5, f"seed {seed}"


def test_same_seed_gives_the_same_messages() -> None:
    """Byte for byte, with a fault in it; another seed is another robot."""
    first, again, other = (with_fault("caster", seed)[0].judge.lines for seed in (3, 3, 4))
    assert first == again
    assert first != other
