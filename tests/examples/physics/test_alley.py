"""The feeding robot in its alley, in physics: scanner, bumpers, engine, and what is in its way."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest

from tests.support.examples import example_module

pytest.importorskip("mujoco", reason="the extra 'physics' is not installed")

example_module("frobit", "frobit_drive.differential")  # which the odometry sums up with
physics = example_module("physics", "wheeled_physics.robot")
measures = example_module("physics", "wheeled_physics.measures")
FeedingRobotBoard = example_module(
    "physics", "wheeled_physics.feeding_robot_board"
).FeedingRobotBoard
FEEDING_ROBOT = measures.FEEDING_ROBOT
LIDAR = FEEDING_ROBOT.lidar
PERIOD = 0.02


def in_the_alley(fault: str | None = None, **changes: Any) -> Any:
    """Return a feeding robot that stands in its alley, with a fault."""
    robot = physics.Robot(replace(FEEDING_ROBOT, **changes))
    if fault is not None:
        robot.fail(fault)
    robot.step(0.2)
    return robot


def bearing(beam: int) -> float:
    """Return the bearing of a beam in rad, to the left."""
    return (beam - 90) * math.pi / 180


def test_scanner_shows_the_walls_of_the_alley_beam_by_beam() -> None:
    """At the distance that each beam has to them, up to its range, within its noise."""
    scan = in_the_alley().scan()
    assert len(scan) == LIDAR.beams == 181
    noises = []
    for beam, shown in enumerate(scan):
        aside = abs(math.sin(bearing(beam)))
        far = FEEDING_ROBOT.alley / aside if aside else math.inf
        if far < LIDAR.range_max - 0.5:
            noises.append(shown - far)
        elif far > LIDAR.range_max + 0.5:
            assert shown == math.inf
    assert max(map(abs, noises)) < 6 * LIDAR.noise  # the robot leans a little on its rear caster
    assert max(noises) > LIDAR.noise


def test_scanner_turns_with_the_robot() -> None:
    """To the left, the left wall is before it, and comes nearer with each look."""
    robot = in_the_alley()
    robot.thrust(-0.3, 0.3)
    while robot.yaw() < math.pi / 2:
        robot.step()
        assert robot.time < 20.0, "it does not turn"
    assert robot.scan()[90] == pytest.approx(FEEDING_ROBOT.alley - LIDAR.ahead, abs=0.1)


@pytest.mark.parametrize(
    ("thing", "distance", "beams"), [("obstacle", 5.0, range(82, 99)), ("person", 1.2, [90])]
)
def test_thing_in_the_way_is_seen_by_the_beams_that_meet_it(
    thing: str, distance: float, beams: range
) -> None:
    """As far from the scanner as its measures say, and by no beam beside it."""
    before, scan = in_the_alley().scan(), in_the_alley(thing).scan()
    for beam in beams:
        assert scan[beam] == pytest.approx(distance / math.cos(bearing(beam)), abs=0.05)
    assert scan[45] == pytest.approx(before[45], abs=0.1)


@pytest.mark.parametrize("thing", ["crate", "ramp"])
def test_thing_below_the_scanner_is_not_seen(thing: str) -> None:
    """Its plane is above them: that is what bumpers are for, and the IMU."""
    scan = in_the_alley(thing).scan()
    assert min(scan[60:121]) > 5.5


def test_what_is_nearer_than_the_scanner_measures_is_blind() -> None:
    """It shows 0, which rules take as blind."""
    near = measures.Thing((0.1, 0.5, 0.9), (LIDAR.ahead + 0.12, 0.0, 0.9))
    robot = in_the_alley(things={"obstacle": near})
    robot.fail("obstacle")
    robot.step()
    assert robot.scan()[90] == 0.0


def test_faults_of_the_scanner_are_what_its_driver_would_see() -> None:
    """No sweep; blind beams ahead; nothing anywhere; the same sweep, whatever comes near."""
    assert in_the_alley("lidar_line").scan() is None
    dirty = in_the_alley("lidar_dirt").scan()
    assert [beam for beam, shown in enumerate(dirty) if shown == 0.0] == [*range(81, 100)]
    assert set(in_the_alley("lidar_dark").scan()) == {math.inf}
    stuck = in_the_alley()
    sweep = stuck.scan()
    assert stuck.scan() != sweep
    last = stuck.scan()
    stuck.fail("lidar_stuck")
    stuck.fail("person")
    stuck.step()
    assert stuck.scan() == last


def test_bumpers_touch_where_something_is() -> None:
    """The crate before the robot, the wall behind it."""
    robot = in_the_alley("crate")
    robot.thrust(0.4, 0.4)
    while not robot.touched():
        robot.step()
        assert robot.time < 20.0, "it does not get there"
    assert robot.touched() == [pytest.approx(0.0, abs=0.1)]
    board = FeedingRobotBoard()
    board.engine(True)
    board.robot.thrust(0.3, -0.3)
    while board.robot.yaw() > -math.pi / 2:
        board.robot.step()
    board.robot.thrust(-0.4, -0.4)
    while not board.robot.touched():
        board.robot.step()
        assert board.robot.time < 20.0, "it does not get there"
    assert board.bumpers() == (False, True)


def test_engine_drives_and_its_brakes_hold_without_it() -> None:
    """A pedal that is down moves nothing while the engine is off; a driving robot is halted."""
    board = FeedingRobotBoard()
    for engine, moves in ((False, False), (True, True), (False, False)):
        board.engine(engine)
        for _ in range(60):
            board.pedal(0.3)
            board.advance(PERIOD)
        assert (board.robot.speed() > 0.3) is moves, engine
        assert (board.engine_speed > 0.0) is engine


def test_brakes_hold_the_robot_on_the_ramp() -> None:
    """They do not creep, though the wheel stands on a slope of 8 degrees."""
    robot = in_the_alley("ramp")
    robot.thrust(0.3, 0.3)
    while robot.position()[0] < 3.2:
        robot.step()
        assert robot.time < 20.0, "it does not get up there"
    robot.relay(True)
    robot.step(2.0)
    x, _ = robot.position()
    robot.step(10.0)
    assert robot.position()[0] == pytest.approx(x, abs=0.01)
    assert 2 * math.asin(robot.orientation()[0]) > 0.08


def test_steering_turns_the_robot_as_front_wheels_would() -> None:
    """By the angle's tangent over the distance of the axles; no more than it can."""
    board = FeedingRobotBoard()
    board.engine(True)
    board.steer(0.3)
    for _ in range(150):
        board.pedal(0.3)
        board.advance(PERIOD)
    turn = board.robot.speed() * math.tan(0.3) / 1.6
    assert board.robot.turn_rate() == pytest.approx(turn, rel=0.05)
    board.steer(math.nan)
    board.pedal(math.nan)
    board.advance(2.0)
    assert board.robot.speed() < 0.01


def test_robot_without_a_scanner_has_none_of_its_faults() -> None:
    """Nor of things that it does not meet."""
    robot = physics.Robot(measures.FROBIT)
    assert robot.scan() is None
    assert robot.faults == physics.FAULTS
    with pytest.raises(ValueError, match="lidar_dark"):
        robot.fail("lidar_dark")
