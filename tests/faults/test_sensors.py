"""Faults of the sensors: dead, hung, confused, replaced."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest

from tests.support.faults import Robot
from tests.support.played import SENSES, imu, speed
from tests.support.victims import Sensors

pytestmark = pytest.mark.ros

TILTED = math.radians(20.0)


@pytest.mark.parametrize("fault", [Sensors.kill, Sensors.freeze])
def test_a_sensor_that_dies_or_hangs_stops_the_robot(
    robot: Robot, fault: Callable[[Sensors], None]
) -> None:
    """Silence is noticed when the timeout passes, without any message."""
    with robot.safety_node(), robot.sensors() as sensors:
        sensors.drive()
        robot.until_free()
        fault(sensors)
        robot.until_stopped("/halt", limit=0.5 + 1.0)


def test_a_sensor_that_comes_back_is_heard_again(robot: Robot) -> None:
    """A sensor process that is killed and started anew needs no restart of the safety node."""
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


def test_a_sensor_that_thaws_is_heard_again(robot: Robot) -> None:
    """After a hang the sensor's messages count as before."""
    with robot.safety_node(), robot.sensors() as sensors:
        sensors.drive()
        robot.until_free()
        sensors.freeze()
        robot.until_stopped("/halt")
        sensors.thaw()
        robot.until_free()


def test_nan_counts_as_silence(robot: Robot) -> None:
    """A sensor that sends NaN goes missing like a silent one, however often it sends."""
    with robot.safety_node(), robot.sensors() as sensors:
        sensors.drive()
        robot.until_free()
        sensors.play("/speed", speed(math.nan), rate=100.0)
        robot.until_stopped("/halt", limit=0.5 + 1.0)
        assert not robot.is_active("/stop")
        sensors.play("/speed", speed(math.inf))
        robot.until_stopped()


def test_nan_between_good_messages_loses_no_stop(robot: Robot) -> None:
    """One good message among many of NaN is enough for an immediate rule."""
    with robot.safety_node(), robot.sensors() as sensors:
        sensors.drive()
        robot.until_free()
        nan = speed(math.nan)
        sensors.play("/speed", *[nan] * 9, speed(2.0), rate=200.0)
        robot.until_stopped()


def test_stamps_out_of_order_change_no_verdict(robot: Robot) -> None:
    """Time is when a message came, not what its stamp says: a 'for' runs through all the same."""
    with robot.safety_node(), robot.sensors() as sensors:
        sensors.drive()
        robot.until_free()
        stamps = [50.0, 10.0, 90.0, 90.0, 0.0, 2e9, 30.0]
        sensors.play("/imu", *(imu(TILTED, stamp=each) for each in stamps))
        robot.until_stopped("/halt", limit=0.4 + 1.0)


def test_a_plausible_wrong_value_is_believed(robot: Robot) -> None:
    """A stuck sensor is alive, and what it repeats is judged: only another sensor contradicts."""
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
