"""A robot with two driven wheels, in physics: how far it goes, and what its faults look like."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest
from builtin_interfaces.msg import Time

from tests.support.examples import example_module

pytest.importorskip("mujoco", reason="the extra 'physics' is not installed")

physics = example_module("physics", "wheeled_physics.robot")
measures = example_module("physics", "wheeled_physics.measures")
experiment = example_module("physics", "wheeled_physics.experiment")
# Which the boards in physics take their times from.
example_module("frobit", "frobit_base.board")
example_module("kobuki", "kobuki_base.base")
BOARDS = {
    "frobit": example_module("physics", "wheeled_physics.frobit_board").FrobitBoard,
    "kobuki": example_module("physics", "wheeled_physics.kobuki_board").KobukiBoard,
    "intelligent_one": example_module(
        "physics", "wheeled_physics.intelligent_one_board"
    ).IntelligentOneBoard,
}
FrobitBoard = BOARDS["frobit"]
passing_time = example_module("physics", "wheeled_physics.passing_time")
Experiment = experiment.Experiment
FROBIT, INTELLIGENT_ONE = measures.FROBIT, measures.INTELLIGENT_ONE
PERIOD = 0.02
SETPOINT = 0.4 / FROBIT.wheel_radius
"""Speed of the wheels, in rad/s, at 0.4 m/s."""


def drive(robot: Any, duration: float) -> None:
    """Regulate both wheels to 0.4 m/s, by their true speeds."""
    for _ in range(round(duration / PERIOD)):
        thrusts = [
            SETPOINT / FROBIT.top_speed + 0.2 * (SETPOINT - robot.wheel_speed(side))
            for side in physics.SIDES
        ]
        robot.thrust(*thrusts)
        robot.step(PERIOD)


def driving(fault: str | None = None) -> Any:
    """Return a robot that has driven for two seconds, and then has had a fault."""
    robot = physics.Robot(FROBIT)
    drive(robot, 2.0)
    if fault is not None:
        robot.fail(fault)
    return robot


def test_three_seconds_at_0_4_m_s_are_somewhat_less_than_1_2_m() -> None:
    """The robot has to set off, and its wheels slip a little; it goes straight on."""
    robot = physics.Robot(FROBIT)
    drive(robot, 3.0)
    x, y = robot.position()
    assert 1.05 < x < 1.2
    assert abs(y) < 0.01


def test_encoders_count_the_way_that_the_robot_goes() -> None:
    """180 ticks for each turn of a wheel, less those that are still on their way."""
    robot = driving()
    way = robot.encoder("left") / FROBIT.ticks_per_turn * math.tau * FROBIT.wheel_radius
    late = 0.4 * FROBIT.encoder_delay
    assert way - late / 2 > robot.position()[0] - 0.05
    assert robot.position()[0] - way == pytest.approx(late, abs=0.03)


def test_wheels_against_one_another_turn_the_robot_on_the_spot() -> None:
    """To the left, where the right wheel drives forwards; the gyroscope shows it."""
    robot = physics.Robot(FROBIT)
    robot.thrust(-0.4, 0.4)
    robot.step(1.0)
    assert math.hypot(*robot.position()) < 0.05
    assert robot.gyro() > 0.5


def states(seed: int) -> list[tuple[bytes, float, int]]:
    """Return states and measurements of a drive with a fault."""
    robot = physics.Robot(FROBIT, seed)
    seen = []
    for cycle in range(100):
        if cycle == 50:
            robot.fail("caster")
        drive(robot, PERIOD)
        seen.append((robot.state(), robot.gyro(), robot.encoder("left")))
    return seen


def test_same_seed_gives_the_same_states_to_the_bit() -> None:
    """Another seed gives other noise, in the same physics."""
    first, again, other = states(1), states(1), states(2)
    assert first == again
    assert [each[0] for each in first] == [each[0] for each in other]
    assert [each[1] for each in first] != [each[1] for each in other]


@pytest.mark.parametrize("side", physics.SIDES)
def test_cut_encoder_shows_no_tick_while_the_wheel_turns(side: str) -> None:
    """The count stands once those on their way have come."""
    robot = driving(f"{side}_encoder")
    drive(robot, FROBIT.encoder_delay + PERIOD)
    shown = robot.encoder(side)
    drive(robot, 1.0)
    assert robot.encoder(side) == shown
    assert robot.wheel_speed(side) > 0.8 * SETPOINT


def test_cut_motor_is_dragged_along_and_turns_the_robot() -> None:
    """The other wheel drives on, so the robot turns towards the one without a motor."""
    robot = driving("left_motor")
    drive(robot, 1.0)
    assert robot.wheel_speed("left") < 0.9 * robot.wheel_speed("right")
    assert robot.gyro() > 0.1


def test_stuck_throttle_drives_on_without_thrust() -> None:
    """A whole one stops."""
    stuck, whole = driving("right_throttle"), driving()
    for robot in (stuck, whole):
        robot.thrust(0.0, 0.0)
        robot.step(1.0)
    assert stuck.wheel_speed("right") > 0.5 * SETPOINT
    assert abs(whole.wheel_speed("right")) < 0.1 * SETPOINT


def test_blocked_caster_brakes() -> None:
    """At the same thrust the robot is slower."""
    free, blocked = driving(), driving("caster")
    for robot in (free, blocked):
        robot.thrust(0.5, 0.5)
        robot.step(1.5)
    assert blocked.wheel_speed("left") < 0.95 * free.wheel_speed("left")


def test_weak_battery_sags_under_load_and_slows_the_robot_down() -> None:
    """Its voltage is that of a whole one as soon as there is no load."""
    whole, weak = driving(), driving("battery")
    for robot in (whole, weak):
        robot.thrust(0.9, 0.9)
        robot.step(1.0)
    assert weak.voltage < whole.voltage - 2.0
    assert weak.wheel_speed("left") < 0.85 * whole.wheel_speed("left")
    for robot in (whole, weak):
        robot.thrust(0.0, 0.0)
        robot.step(0.1)
    assert weak.voltage == pytest.approx(whole.voltage, abs=0.01)


def onto_the_bank() -> Any:
    """Return an Intelligent One that has driven straight on until all of it is on the bank."""
    robot = physics.Robot(INTELLIGENT_ONE)
    robot.thrust(1.0, 1.0)
    while robot.position()[0] < INTELLIGENT_ONE.bank.distance + 1.0:
        robot.step()
        assert robot.time < 10.0, "it does not get up there"
    return robot


def test_bank_lifts_the_robot_and_tilts_it_backwards() -> None:
    """By the angle of the bank, which is steeper than any rule allows."""
    robot = onto_the_bank()
    x, y, _, _ = robot.orientation()
    assert abs(x) < 0.01
    assert 2 * math.asin(y) == pytest.approx(-INTELLIGENT_ONE.bank.angle, abs=0.02)
    assert robot.height() == pytest.approx(math.tan(INTELLIGENT_ONE.bank.angle), abs=0.03)


def test_imu_shows_the_attitude_with_noise() -> None:
    """Each look another one, about the truth."""
    robot = onto_the_bank()
    shown = [robot.imu() for _ in range(100)]
    assert len(set(shown)) == 100
    pitches = [2 * math.asin(y) for _, y, _, _ in shown]
    assert sum(pitches) / 100 == pytest.approx(2 * math.asin(robot.orientation()[1]), abs=0.01)
    assert max(pitches) - min(pitches) > INTELLIGENT_ONE.attitude_noise


def test_imu_is_late_by_its_delay() -> None:
    """A robot that turns has been where the IMU shows it."""
    robot = physics.Robot(replace(INTELLIGENT_ONE, attitude_noise=0.0, attitude_delay=0.2))
    robot.thrust(-0.5, 0.5)
    robot.step(1.0)
    then = robot.orientation()
    robot.step(0.2)
    assert robot.imu() == pytest.approx(then, abs=1e-12)
    assert robot.orientation()[2] - then[2] > 0.05


def test_imu_whose_gyroscope_drifts_shows_a_roll_that_there_is_not() -> None:
    """A quarter of a rad after a second; a Kobuki's gyroscope shows the rate."""
    robot = physics.Robot(INTELLIGENT_ONE)
    robot.fail("gyro")
    robot.step(1.0)
    assert 2 * math.asin(robot.imu()[0]) == pytest.approx(physics.DRIFT / 2, abs=0.03)
    assert abs(robot.orientation()[0]) < 0.001


def test_unknown_fault_is_refused() -> None:
    """With the names of those that there are."""
    with pytest.raises(ValueError, match="left_encoder"):
        physics.Robot(FROBIT).fail("left wing")


def test_drive_prints_what_the_sensors_show(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """As the README starts it: after two seconds the ticks of the cut line stand."""
    script = example_module("physics", "wheeled_physics.drive")
    monkeypatch.setattr("sys.argv", ["drive", "left_encoder"])
    assert script.main() == 0
    lines = [line.split() for line in capsys.readouterr().out.splitlines()]
    left, right = [int(line[8]) for line in lines], [int(line[9]) for line in lines]
    assert left[3] < right[5] < right[7]
    assert left[4] == left[7]
    monkeypatch.setattr("sys.argv", ["drive", "left_wing"])
    assert script.main() == 2
    assert "left_encoder" in capsys.readouterr().err


def test_robots_of_one_kind_differ_within_their_spread() -> None:
    """The same seed stands for the same one."""
    robots = [measures.individual(FROBIT, seed) for seed in range(20)]
    assert robots[3] == measures.individual(FROBIT, 3)
    assert len({each.mass for each in robots}) == 20
    for name, share in measures.SPREAD.items():
        off = [getattr(each, name) / getattr(FROBIT, name) - 1.0 for each in robots]
        assert max(map(abs, off)) <= share
        assert max(off) > 0.5 * share


def test_relay_takes_the_supply_of_both_motors_and_gives_it_back() -> None:
    """An open one ends the load of the battery, too."""
    robot = driving("runaway")
    robot.relay(True)
    robot.step(3.0)
    assert robot.speed() < 0.001
    charge = robot.charge
    robot.step(1.0)
    assert robot.charge == charge
    robot.relay(False)
    robot.step(1.0)
    assert robot.speed() > 0.3


def test_cut_line_takes_no_command_and_the_board_stands() -> None:
    """The motor drivers' timeout is on the board's side of the line."""
    board = FrobitBoard()
    board.command("left", 0.6)
    board.command("right", 0.6)
    board.advance(0.14)
    assert board.robot.speed() > 0.02
    board.robot.fail("line")
    board.command("left", 1.0)
    board.advance(1.5)
    assert board.robot.speed() < 0.01


class Said:
    """An experiment with a Frobit at 0.6 of its thrust, from 100 s of a clock on."""

    def __init__(self, fault: str) -> None:
        """Stand."""
        self.texts: list[str] = []
        self.board = FrobitBoard()
        self.now = 100.0
        time = passing_time.RealTime(lambda: self.now, Time)
        self.experiment = Experiment(self.board, time, fault, 1.0, self.texts.append)

    def run(self, duration: float, cycle: float = 0.02) -> None:
        """Let the clock run on, and look at it each cycle."""
        for _ in range(round(duration / cycle)):
            self.now += cycle
            self.board.command("left", 0.6)
            self.board.command("right", 0.6)
            self.experiment.advance()


def test_experiment_keeps_pace_with_the_clock() -> None:
    """In cycles that are no whole number of pulses, too; one that was held up does not leap."""
    said = Said("none")
    said.run(3.0, cycle=0.0173)
    assert said.board.robot.time == pytest.approx(said.now - 100.0, abs=0.011)
    before = said.board.robot.time
    said.run(5.0, cycle=5.0)
    assert said.board.robot.time - before == pytest.approx(0.1, abs=0.011)


def test_experiment_fails_some_time_after_the_robot_has_moved() -> None:
    """Once, and it says so; ``none`` never does."""
    said, whole = Said("left_encoder"), Said("none")
    said.run(0.9)
    assert said.texts == ["the robot moves"]
    said.run(1.0)
    whole.run(1.9)
    assert said.texts == ["the robot moves", "fault: left_encoder"]
    assert whole.texts == ["the robot moves"]
    assert said.board.ticks("left") < said.board.ticks("right") - 20
    said.run(2.0)
    assert len(said.texts) == 2


@pytest.mark.parametrize("robot", BOARDS)
def test_robot_that_settles_on_its_casters_does_not_yet_move(robot: str) -> None:
    """Its wheels turn a little as these give way, which would begin the time to the fault."""
    for seed in range(3):
        texts: list[str] = []
        time = passing_time.SimulatedTime(lambda _: None)
        settling = Experiment(BOARDS[robot](seed), time, "left_motor", 0.0, texts.append)
        for _ in range(50):
            settling.advance()
        assert texts == [], f"seed {seed}"


def test_truth_is_where_the_robot_really_is() -> None:
    """Its place, its angle, and its speed over ground."""
    robot = physics.Robot(FROBIT)
    robot.thrust(0.4, 0.6)
    robot.step(2.0)
    msg = experiment.truth(robot, Time(sec=7))
    assert msg.header.stamp.sec == 7
    assert (msg.pose.pose.position.x, msg.pose.pose.position.y) == robot.position()
    yaw = 2 * math.atan2(msg.pose.pose.orientation.z, msg.pose.pose.orientation.w)
    assert yaw == pytest.approx(robot.yaw())
    assert yaw > 0.2
    assert msg.twist.twist.linear.x == pytest.approx(robot.speed())


def test_truth_of_a_robot_on_the_bank_is_above_the_level() -> None:
    """With the whole attitude, not its yaw alone."""
    robot = onto_the_bank()
    pose = experiment.truth(robot, Time()).pose.pose
    assert pose.position.z == robot.height() > 0.2
    shown = pose.orientation
    assert (shown.x, shown.y, shown.z, shown.w) == robot.orientation()
