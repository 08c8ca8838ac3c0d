"""Silence and nonsense of sensors, in virtual time."""

from __future__ import annotations

import math

import pytest

from tests.support.played import TOPICS, imu, speed
from tests.support.virtual_robot import VirtualRobot, ns

SILENT = ns(0.5)
"""How long speed and attitude may be missing."""

TILTED = math.radians(20.0)


@pytest.mark.parametrize("topic", ["/speed", "/imu"])
def test_silent_sensor_stops_the_robot(robot: VirtualRobot, topic: str) -> None:
    """The halt comes when the timeout of the last message ends, without any message."""
    robot.start()
    sensors = robot.sensors()
    sensors.drive()
    robot.until_free()
    robot.run(0.123)
    sensors.quiet(topic)
    halted = robot.until_active("/halt")
    assert halted == sensors.last[topic] + SILENT
    robot.run(0.1)
    event = [each for each in robot.events if each["kind"] == "trigger"][-1]
    assert (event["action"], event["time_ns"], event["published_ns"]) == (
        "halt",
        *[str(halted)] * 2,
    )
    robot.assert_protects()


def test_dead_sensor_stops_the_robot(robot: VirtualRobot) -> None:
    """So it is if the process dies, or hangs, and its publishers stay in the graph."""
    robot.start()
    sensors = robot.sensors()
    sensors.drive()
    robot.until_free()
    sensors.freeze()
    last = max(sensors.last["/speed"], sensors.last["/imu"])
    assert robot.until_active("/halt") == last + SILENT
    sensors.thaw()
    robot.until_free()
    sensors.kill()
    robot.until_active("/halt")
    again = robot.sensors()
    again.drive()
    robot.until_free()
    again.play("/speed", speed(2.0))
    assert robot.until_active("/stop") == again.last["/speed"]


def test_nan_counts_as_silence(robot: VirtualRobot) -> None:
    """A sensor that publishes NaN is missing like a silent one; infinity is too fast."""
    robot.start()
    sensors = robot.sensors()
    sensors.drive()
    robot.until_free()
    last = sensors.last["/speed"]
    sensors.play("/speed", speed(math.nan), rate=100.0)
    assert robot.until_active("/halt") == last + SILENT
    assert not robot.is_active("/stop")
    sensors.send("/speed", speed(math.inf))
    assert robot.until_active("/stop") == robot.now


def test_nan_between_valid_messages_misses_no_stop(robot: VirtualRobot) -> None:
    """One valid message among many NaN is enough for an immediate rule."""
    robot.start()
    sensors = robot.sensors()
    sensors.drive()
    robot.until_free()
    sensors.send("/speed", *[speed(math.nan)] * 9, speed(2.0), *[speed(math.nan)] * 9)
    assert robot.until_active("/stop") == robot.now


@pytest.mark.parametrize("garbage", [b"\x00\x01\x00\x00", b"\xff" * 400])
def test_garbage_counts_as_silence(robot: VirtualRobot, garbage: bytes) -> None:
    """Data that cannot be decoded restarts no timeout, and is reported once."""
    robot.start()
    sensors = robot.sensors()
    sensors.drive()
    robot.until_free()
    last = sensors.last["/imu"]
    sensors.play("/imu", garbage, rate=100.0)
    assert robot.until_active("/halt") == last + SILENT
    robot.run(1.0)
    reports = [each["message"] for each in robot.events if each["kind"] == "undecodable"]
    assert len(reports) == 1
    assert reports[0].startswith("/imu has carried data that cannot be read")
    sensors.play("/imu", imu())
    robot.until_free()
    robot.assert_protects()


def test_unordered_stamps_change_no_verdict(robot: VirtualRobot) -> None:
    """Times are those of receipt, not of the stamps: a 'for' elapses normally."""
    robot.start()
    sensors = robot.sensors()
    sensors.drive()
    robot.until_free()
    robot.run(0.007)
    began = robot.now
    stamps = [50.0, 10.0, 90.0, 90.0, 0.0, 2e9, 30.0]
    sensors.play("/imu", *(imu(TILTED, stamp=stamp) for stamp in stamps))
    assert robot.until_active("/halt") == began + ns(0.4)


def test_plausible_wrong_value_is_believed(robot: VirtualRobot) -> None:
    """A stuck sensor is alive, and its value is used: only another sensor can contradict it."""
    robot.start()
    sensors = robot.sensors()
    sensors.drive()
    robot.until_free()
    robot.run(10.0)
    assert not robot.is_active("/halt")
    assert not robot.is_active("/stop")
    second = robot.sensors({"/speed": TOPICS["/speed"]})
    second.send("/speed", speed(2.0))
    assert robot.until_active("/stop") == robot.now


def test_second_publisher_does_not_hide_a_dead_sensor(robot: VirtualRobot) -> None:
    """Two publishers of one input are a fault, whichever of them is alive; one is not."""
    robot.start()
    sensors = robot.sensors()
    sensors.drive()
    robot.until_free()
    text = "/imu: 2 publishers where one is expected"
    robot.run(2.0)
    assert not any(each["kind"] == "fault" for each in robot.events)
    second = robot.sensors({"/imu": TOPICS["/imu"]})
    second.play("/imu", imu())
    robot.until(lambda: any(each["message"].startswith(text) for each in robot.events), 2.0)
    sensors.quiet("/imu")
    robot.run(5.0)
    assert "2 publishers where one is expected" in robot.statuses["faulty_safety_node"].message
    assert not robot.is_active("/halt")
    second.quiet("/imu")
    assert robot.until_active("/halt") == second.last["/imu"] + SILENT
    second.destroy_node()
    robot.until(lambda: "2 publishers" not in robot.statuses["faulty_safety_node"].message, 3.0)
