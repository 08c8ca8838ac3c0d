"""The Intelligent One's driver and rules on its physics, in simulated time and without ROS."""

from __future__ import annotations

import math
import random

import pytest

from tests.support.examples import example_module
from tests.support.judge import Judge, each_of_20_robots

pytest.importorskip("mujoco", reason="the extra 'physics' is not installed")

example_module("frobit", "frobit_drive.differential")  # which the driver finds its way with
boards = example_module("physics", "wheeled_physics.intelligent_one_board")
INTELLIGENT_ONE = example_module("physics", "wheeled_physics.measures").INTELLIGENT_ONE
FAULTS = example_module("physics", "wheeled_physics.robot").FAULTS
PERIOD = 0.02
TILT = math.radians(10.0)
"""The most, in rad, by which the rules let the robot be tilted, but for a while."""

CLEARLY = math.radians(11.0), 0.52
"""Tilt in rad and speed in m/s that no noise of a sensor brings back to what is allowed."""

TOLERATED = {"tilt": 0.7, "speed": 2.5}
"""For how many seconds the truth may be that: the time of the rule, and what is late."""

TOO_FAST, TILTED = "drive_system.max_speed_exceeded", "imu_sensor_system.tilt_not_ok"

SEEN = {
    "runaway": ({TOO_FAST}, 2.0, 2.2),
    "gyro": ({TILTED}, 1.0, 1.5),
    "line": ({TOO_FAST, TILTED}, 0.45, 0.6),
}
"""The rules that find each fault, and the least and the most seconds that it takes."""

UNSEEN = ("left_encoder", "right_encoder", "left_motor", "right_motor", "caster", "battery")
"""The odometry shows no more than 0.5 m/s with these, and the field is level."""

UNSURE = ("left_throttle", "right_throttle", "left_runaway", "right_runaway")
"""These are seen where the robot gets onto the bank, or keeps on driving too fast."""


class Loop:
    """The robot and what its driver does every 20 ms; the gate commands zero after a stop."""

    def __init__(self, seed: int = 0) -> None:
        """Stand at the first corner of the field."""
        self.board = boards.IntelligentOneBoard(seed)
        self.robot = self.board.robot
        self.judge = Judge("intelligent_one")
        self.fastest = 0.0
        self.tilted_at: float | None = None
        self.beyond = {"tilt": 0.0, "speed": 0.0}
        self.missed = False

    def drive(self, duration: float) -> None:
        """Drive along the lines for some seconds."""
        for _ in range(round(duration / PERIOD)):
            self.cycle()

    def cycle(self) -> None:
        """Drive so for a cycle."""
        now = self.robot.time
        wish = self.board.wish()
        self.board.command(*((0.0, 0.0) if self.judge.verdicts else wish))
        if self.robot.heard:
            if self.board.reckon():
                forward, _ = self.board.motion
                self.judge.hear(now, "/odometry", {"twist.twist.linear.x": forward})
            attitude = zip("xyzw", self.robot.imu(), strict=True)
            self.judge.hear(now, "/imu", {f"orientation.{axis}": part for axis, part in attitude})
        self.board.advance(PERIOD)
        self.judge.advance(self.robot.time)
        self._watch()

    def tilt(self) -> float:
        """Return the greater of roll and pitch, in rad and without a sign, as it truly is."""
        x, y, z, w = self.robot.orientation()
        roll = math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
        return max(abs(roll), abs(math.asin(2 * (w * y - z * x))))

    def _watch(self) -> None:
        """Compare the truth with the rules: what they should have found by now is missed."""
        tilt, speed = self.tilt(), self.robot.speed()
        for name, holds in {"tilt": tilt > CLEARLY[0], "speed": speed > CLEARLY[1]}.items():
            self.beyond[name] = self.beyond[name] + PERIOD if holds else 0.0
            late = self.beyond[name] > TOLERATED[name]
            self.missed = self.missed or (late and not self.judge.verdicts)
        self.fastest = max(self.fastest, speed)
        if tilt > TILT and self.tilted_at is None:
            self.tilted_at = self.robot.time


def with_fault(fault: str, seed: int, duration: float = 4.0) -> tuple[Loop, float]:
    """Return a drive along the lines with a fault, and the time (s) of the fault."""
    loop = Loop(seed)
    loop.drive(4.0 + PERIOD * random.Random(seed).randrange(50))
    assert loop.judge.verdicts == []
    began = loop.robot.time
    loop.board.fail(fault)
    loop.drive(duration)
    return loop, began


def test_every_fault_of_the_hardware_is_tried() -> None:
    """Those that the rules see, those that they do not, and those that they may see."""
    assert {*SEEN, *UNSEEN, *UNSURE} == {*FAULTS}


@each_of_20_robots
@pytest.mark.parametrize("fault", SEEN)
def test_rules_find_a_fault_in_time_in_each_of_20_robots(fault: str, seeds: range) -> None:
    """Robots, noise and the time of the fault differ by the seed; the first to act is its rule."""
    rules, least, most = SEEN[fault]
    for seed in seeds:
        loop, began = with_fault(fault, seed)
        loop.judge.require_stop(rules, began + least - PERIOD, began + most, f"seed {seed}")


@each_of_20_robots
def test_robot_that_is_led_onto_the_bank_is_stopped_there(seeds: range) -> None:
    """Physics tilts it, for the 0.4 s of the rule; then it stands on the slope and holds."""
    for seed in seeds:
        loop, _ = with_fault("bank", seed, 12.0)
        assert [each.rules for each in loop.judge.verdicts] == [{TILTED}], f"seed {seed}"
        assert loop.tilted_at is not None, f"seed {seed}"
        late = loop.judge.verdicts[0].time - loop.tilted_at
        assert 0.4 - PERIOD < late < 0.5, f"seed {seed}"
        assert loop.tilt() == pytest.approx(INTELLIGENT_ONE.bank.angle, abs=0.02), f"seed {seed}"
        assert loop.robot.speed() < 0.005, f"seed {seed}"


@each_of_20_robots
@pytest.mark.parametrize("fault", UNSEEN)
def test_fault_that_breaks_no_rule_is_not_found(fault: str, seeds: range) -> None:
    """The robot stays on the level; a cut encoder has it circle faster than the odometry shows."""
    fastest = 0.6 if fault.endswith("encoder") else 0.5
    for seed in seeds:
        loop, _ = with_fault(fault, seed, 12.0)
        assert loop.judge.verdicts == [], f"seed {seed}"
        assert not loop.missed, f"seed {seed}"
        assert loop.fastest < fastest, f"seed {seed}"


@each_of_20_robots
@pytest.mark.parametrize("fault", UNSURE)
def test_nothing_that_breaks_a_rule_is_missed(fault: str, seeds: range) -> None:
    """A robot that is truly tilted or too fast is stopped; another may go on with its fault."""
    for seed in seeds:
        loop, _ = with_fault(fault, seed, 12.0)
        assert not loop.missed, f"seed {seed}"


@each_of_20_robots
def test_gate_alone_does_not_end_a_short_circuit(seeds: range) -> None:
    """What the README states: the example has no relay, so drivers that run away drive on."""
    for seed in seeds:
        loop, _ = with_fault("runaway", seed, 6.0)
        assert loop.judge.verdicts[0].action == "stop", f"seed {seed}"
        assert loop.robot.speed() > 0.4, f"seed {seed}"


@each_of_20_robots
@pytest.mark.parametrize("fault", ["gyro", "line"])
def test_stopped_robot_stands(fault: str, seeds: range) -> None:
    """By the gate's zero, or as there are no commands any more; its driver gives up for good."""
    for seed in seeds:
        loop, _ = with_fault(fault, seed)
        assert loop.robot.speed() < 0.005, f"seed {seed}"
        assert loop.board.wish() == (0.0, 0.0), f"seed {seed}"


def test_driver_stands_before_it_sets_off_and_tries_again() -> None:
    """A gate that starts late waits for a zero, which comes every other second."""
    board = boards.IntelligentOneBoard()
    wishes = []
    for _ in range(200):
        wishes.append(board.wish()[0])
        board.command(0.0, 0.0)
        board.advance(PERIOD)
    assert [wishes[index] > 0.0 for index in (10, 60, 110, 160)] == [False, True, False, True]
    assert board.robot.speed() < 0.001


@pytest.mark.slow
def test_nothing_stops_a_robot_in_ten_minutes_of_its_lines() -> None:
    """Slip, lag, delay and noise are within what the rules allow, round after round."""
    loop = Loop(1)
    corners = 0
    while loop.robot.time < 600.0:
        before = loop.board._way._next
        loop.cycle()
        corners += loop.board._way._next != before
    assert loop.judge.verdicts == []
    assert corners > 80


def test_same_seed_gives_the_same_messages() -> None:
    """Byte for byte, with a fault in it; another seed is another robot."""
    first, again, other = (with_fault("caster", seed)[0].judge.lines for seed in (3, 3, 4))
    assert first == again
    assert first != other
