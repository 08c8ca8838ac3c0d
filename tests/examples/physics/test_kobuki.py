"""The Kobuki's pilot, odometry and rules on its physics, in simulated time and without ROS."""

from __future__ import annotations

import math
import random

import pytest

from tests.examples.test_kobuki import CRUISE, PERIOD, base, odometry, star
from tests.support.examples import example_module
from tests.support.judge import Judge, each_of_20_robots

pytest.importorskip("mujoco", reason="the extra 'physics' is not installed")

KobukiBoard = example_module("physics", "wheeled_physics.kobuki_board").KobukiBoard
FAULTS = example_module("physics", "wheeled_physics.robot").FAULTS

SEEN = {
    "left_encoder": ({"kobuki.spins"}, 0.8),
    "right_encoder": ({"kobuki.spins"}, 0.8),
    "left_runaway": ({"kobuki.too_fast", "kobuki.spins"}, 0.7),
    "right_runaway": ({"kobuki.too_fast", "kobuki.spins"}, 0.7),
    "runaway": ({"kobuki.too_fast"}, 0.6),
    "gyro": ({"kobuki.spins"}, 0.3 + 2.5 / 0.5),
    "line": ({"kobuki.outside", "kobuki.spins", "kobuki.too_fast"}, 0.6),
}
"""The rules that find each fault, and the most seconds that it takes.

A wheel whose encoder is cut is regulated to full speed. A gyroscope drifts by 0.5 rad/s in a
second, and the robot may turn against that at 1 rad/s.
"""

UNSURE = ("left_motor", "right_motor", "left_throttle", "right_throttle", "caster", "battery")
"""No rule reads wheels or voltage: these are seen only where the robot moves as it must not."""


class Loop:
    """The robot and what its pilot does every 20 ms, with the messages that its rules read."""

    def __init__(self, seed: int = 0) -> None:
        """Stand in the middle of the room."""
        self.board = KobukiBoard(seed)
        self.robot = self.board.robot
        self.odometry = odometry.DeadReckoning()
        self.star = star.Star(CRUISE)
        self.judge = Judge("kobuki")
        self.astray = False
        self.load = 5.0
        self.bumps = 0
        self.fastest = self.farthest = 0.0

    def drive(self, duration: float) -> None:
        """Drive along the star for some seconds, or straight on."""
        for _ in range(round(duration / PERIOD)):
            self.cycle()

    def cycle(self) -> None:
        """Drive so for a cycle."""
        now = self.robot.time
        pose = self.odometry.x, self.odometry.y, self.odometry.yaw
        command = (CRUISE, 0.0) if self.astray else self.star.command(*pose)
        bumped = self.robot.heard and self.board.bumper()
        self.bumps += bool(bumped)
        if bumped or star.stands(now):
            command = (0.0, 0.0)
        self.board.command(*command)
        if self.robot.heard:
            self._report(now)
        self.judge.hear(now, "/pilot/load", {"data": self.load})
        self.board.advance(PERIOD)
        self.judge.advance(self.robot.time)
        self.fastest = max(self.fastest, self.robot.speed())
        self.farthest = max(self.farthest, *map(abs, self.robot.position()))

    def _report(self, now: float) -> None:
        if self.odometry.count(*self.board.counters(), self.board.stamp()):
            data = {
                "pose.pose.position.x": self.odometry.x,
                "pose.pose.position.y": self.odometry.y,
                "pose.pose.position.z": 0.0,
                "twist.twist.linear.x": self.odometry.forward,
            }
            self.judge.hear(now, "/odometry", data)
        self.judge.hear(now, "/imu", {"angular_velocity.z": self.robot.gyro()})


def with_fault(fault: str, seed: int) -> tuple[Loop, float]:
    """Return a drive along the star with a fault, and the time (s) of the fault."""
    loop = Loop(seed)
    loop.drive(4.0 + PERIOD * random.Random(seed).randrange(50))
    began = loop.robot.time
    loop.robot.fail(fault)
    loop.drive(4.0)
    return loop, began


def test_every_fault_of_the_hardware_is_tried() -> None:
    """Those that the rules see, and those that they need not see."""
    assert {*SEEN, *UNSURE} == {*FAULTS}


@each_of_20_robots
@pytest.mark.parametrize("fault", SEEN)
def test_rules_find_a_fault_in_time_in_each_of_20_robots(fault: str, seeds: range) -> None:
    """Robots, noise and the time of the fault differ by the seed; the first to act is its rule."""
    rules, most = SEEN[fault]
    for seed in seeds:
        loop, began = with_fault(fault, seed)
        first = loop.judge.verdicts[0]
        assert first.action == "stop", f"seed {seed}"
        assert first.rules, f"seed {seed}"
        assert first.rules <= rules, f"seed {seed}"
        assert 0.3 - PERIOD < first.time - began < most, f"seed {seed}"


@each_of_20_robots
@pytest.mark.parametrize("fault", UNSURE)
def test_fault_that_breaks_no_rule_need_not_be_found(fault: str, seeds: range) -> None:
    """Until a robot is stopped, it is as slow, and where, the rules want it: nothing is missed."""
    for seed in seeds:
        loop, _ = with_fault(fault, seed)
        if not loop.judge.verdicts:
            assert loop.fastest < 0.4, f"seed {seed}"
            assert loop.farthest < 1.2, f"seed {seed}"


@each_of_20_robots
@pytest.mark.parametrize("fault", ["left_runaway", "runaway", "left_encoder"])
def test_relay_ends_what_no_command_can(fault: str, seeds: range) -> None:
    """The robot stands within a second, however its drivers are stuck."""
    for seed in seeds:
        loop, _ = with_fault(fault, seed)
        loop.robot.relay(True)
        loop.drive(1.0)
        assert loop.robot.speed() < 0.02, f"seed {seed}"


@each_of_20_robots
def test_pilot_that_needs_too_much_of_the_processor_is_stopped(seeds: range) -> None:
    """After two seconds, as the rule says."""
    for seed in seeds:
        loop = Loop(seed)
        loop.drive(3.0)
        loop.load = 90.0
        loop.drive(2.5)
        first = loop.judge.verdicts[0]
        assert first.rules == {"kobuki.overloaded"}, f"seed {seed}"
        assert 5.0 - PERIOD < first.time < 5.1, f"seed {seed}"


@each_of_20_robots
def test_pilot_that_goes_astray_is_stopped_at_the_edge_of_the_yard(seeds: range) -> None:
    """By the odometry, which is near the truth then; it has not come to a wall."""
    for seed in seeds:
        loop = Loop(seed)
        loop.astray = True
        loop.drive(9.0)
        first = loop.judge.verdicts[0]
        assert first.rules == {"kobuki.outside"}, f"seed {seed}"
        way = CRUISE * (first.time - star.PAUSE)
        assert 1.1 < way < 1.5, f"seed {seed}"
        assert loop.bumps == 0, f"seed {seed}"


def test_wall_before_the_robot_is_felt() -> None:
    """The pilot stands at it: 2 m, less the radius of the body."""
    loop = Loop()
    loop.astray = True
    loop.drive(25.0)
    assert loop.bumps > 0
    assert loop.board.bumper() in {0, base.MIDDLE}
    assert loop.robot.position()[0] == pytest.approx(base.WALL - base.BODY_RADIUS, abs=0.03)
    assert loop.robot.speed() < 0.02


def test_driver_stands_when_commands_cease() -> None:
    """0.6 s after the last one it begins to, by its ramp; the description says within 2 s."""
    board = KobukiBoard()
    board.command(0.25, 0.0)
    board.advance(0.58)
    assert board.robot.speed() > 0.1
    board.advance(1.42)
    assert board.robot.speed() < 0.01


@pytest.mark.parametrize("command", [(math.nan, 0.0), (0.2, math.inf)])
def test_command_that_is_no_number_is_one_to_stand(command: tuple[float, float]) -> None:
    """Both of its parts."""
    board = KobukiBoard()
    board.command(*command)
    board.advance(0.2)
    assert board.robot.speed() < 0.001


@pytest.mark.slow
def test_nothing_stops_a_robot_in_ten_minutes_of_its_star() -> None:
    """Slip, ramps, noise and the drift of the odometry are within what the rules allow."""
    loop = Loop(1)
    goals = set()
    while loop.robot.time < 600.0:
        loop.cycle()
        goals.add(loop.star._next)
    assert loop.judge.verdicts == []
    assert goals == set(range(star.POINTS))


def test_same_seed_gives_the_same_messages() -> None:
    """Byte for byte, with a fault in it; another seed is another robot."""
    first, again, other = (with_fault("caster", seed)[0].judge.lines for seed in (3, 3, 4))
    assert first == again
    assert first != other
