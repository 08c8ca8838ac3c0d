"""Faults of the sensors: dead, hung, confused, replaced."""

from __future__ import annotations

import math

import pytest

from tests.support.faults import Robot
from tests.support.played import SENSES, imu, speed

pytestmark = pytest.mark.ros

TILTED = math.radians(20.0)


@pytest.mark.slow
def test_dead_sensor_stops_the_robot(robot: Robot) -> None:
    """Silence is detected when the timeout ends, without any message."""
    with robot.safety_node(), robot.sensors() as sensors:
        sensors.drive()
        robot.until_free()
        sensors.kill()
        robot.until_stopped("/halt", limit=0.5 + 1.0)


@pytest.mark.slow
def test_restarted_sensor_is_used_again(robot: Robot) -> None:
    """The safety node need not be restarted."""
    with robot.safety_node():
        with robot.sensors() as sensors:
            sensors.drive()
            robot.until_free()
            sensors.kill()
            robot.until_stopped("/halt")
        with robot.sensors() as sensors:
            sensors.drive()
            robot.until_free()
            sensors.play("/speed", speed(2.0))
            robot.until_stopped()


@pytest.mark.slow
def test_hung_sensor_stops_the_robot_and_is_used_again(robot: Robot) -> None:
    """Its messages count as before."""
    with robot.safety_node(), robot.sensors() as sensors:
        sensors.drive()
        robot.until_free()
        sensors.freeze()
        robot.until_stopped("/halt", limit=0.5 + 1.0)
        sensors.thaw()
        robot.until_free()


@pytest.mark.slow
def test_nan_counts_as_silence(robot: Robot) -> None:
    """A sensor that publishes NaN is missing like a silent one, at any rate."""
    with robot.safety_node(), robot.sensors() as sensors:
        sensors.drive()
        robot.until_free()
        sensors.play("/speed", speed(math.nan), rate=100.0)
        robot.until_stopped("/halt", limit=0.5 + 1.0)
        assert not robot.is_active("/stop")
        sensors.play("/speed", speed(math.inf))
        robot.until_stopped()


@pytest.mark.slow
def test_nan_between_valid_messages_misses_no_stop(robot: Robot) -> None:
    """One valid message among many NaN is enough for an immediate rule."""
    with robot.safety_node(), robot.sensors() as sensors:
        sensors.drive()
        robot.until_free()
        nan = speed(math.nan)
        sensors.play("/speed", *[nan] * 9, speed(2.0), rate=200.0)
        robot.until_stopped()


@pytest.mark.slow
def test_unordered_stamps_change_no_verdict(robot: Robot) -> None:
    """Times are those of receipt, not of the stamps: a 'for' elapses normally."""
    with robot.safety_node(), robot.sensors() as sensors:
        sensors.drive()
        robot.until_free()
        stamps = [50.0, 10.0, 90.0, 90.0, 0.0, 2e9, 30.0]
        sensors.play("/imu", *(imu(TILTED, stamp=stamp) for stamp in stamps))
        robot.until_stopped("/halt", limit=0.4 + 1.0)


@pytest.mark.slow
def test_plausible_wrong_value_is_believed(robot: Robot) -> None:
    """A stuck sensor is alive, and its value is used: only another sensor can contradict it."""
    with robot.safety_node(), robot.sensors() as sensors:
        sensors.drive()
        robot.until_free()
        robot.spin(2.0)  # four times the timeout, in which the robot may have run away
        assert not robot.is_active("/halt")
        assert not robot.is_active("/stop")
        with robot.sensors({"/speed": SENSES["/speed"]}) as second:
            second.match("/speed")
            second.play("/speed", speed(2.0))
            robot.until_stopped()
