"""Faults of the traffic: floods, huge messages, other types and garbage."""

from __future__ import annotations

import math
import time

import pytest

from tests.support.faults import PROMPT, Robot
from tests.support.played import button, imu, load, scan, speed
from tests.support.stalls import stalls

pytestmark = pytest.mark.ros

TILTED = math.radians(20.0)
SPEED_TIMEOUT = 0.5  # of the rules of these tests


@pytest.mark.slow
def test_flood_on_one_input_does_not_block_others(robot: Robot) -> None:
    """With 20,000 messages a second on one input, rules on others stop, at once and after 0.4 s."""
    with robot.safety_node(), robot.sensors() as sensors, robot.sensors() as flood:
        sensors.drive()
        robot.until_free()
        flood.match("/load")
        flood.play("/load", load(1.0), load(2.0), rate=20_000.0)
        begun, waited = time.monotonic(), flood.waited()
        robot.until_beats()
        assert not robot.is_active("/halt"), "an active sensor was treated as silent"
        sensors.play("/imu", imu(TILTED))
        robot.until_stopped("/halt", limit=0.4 + PROMPT)
        sensors.play("/speed", speed(2.0))
        robot.until_stopped(limit=PROMPT)
        sent = flood.quiet("/load")
        running = time.monotonic() - begun - (flood.waited() - waited)
        assert sent > 10_000 * running, f"{sent} messages in {running:.1f} s are not a flood"


@pytest.mark.slow
def test_violation_within_a_flood_stops_the_robot(robot: Robot) -> None:
    """The flooded input itself is still evaluated."""
    with robot.safety_node(), robot.sensors() as flood:
        flood.match("/load")
        flood.play("/load", load(99.0), *[load(1.0)] * 99, rate=20_000.0)
        robot.until_stopped("/slow")


@pytest.mark.slow
def test_message_of_ten_megabytes_blocks_nothing(robot: Robot) -> None:
    """A scan of at least a million beams is evaluated, and other inputs are monitored meanwhile.

    The lidar is a separate process: sending a scan must not delay the other sensors. A scan is
    larger than the largest receive buffer, so the kernel may drop the messages of the attitude
    meanwhile, which are sent at best effort: then it is missing. The speed is sent reliably. Where
    the machine holds sensors or node up for half of its timeout, its silence tells nothing.
    """
    beams = robot.software.beams
    with (
        robot.safety_node() as node,
        robot.sensors() as sensors,
        robot.sensors() as lidar,
        stalls() as held,
    ):
        sensors.drive()
        sensors.quiet("/scan")
        lidar.match("/scan")
        robot.until_free()
        silences = node.output().count("speed.missing()")
        before = held.seconds + sensors.waited()
        lidar.send("/scan", scan(5.0, beams=beams), times=5, rate=5.0)
        robot.until_alive()
        assert not robot.is_active("/stop")
        # A single one might not arrive.
        lidar.send("/scan", scan(0.1, beams=beams), times=5, rate=5.0)
        robot.until_stopped(limit=PROMPT)
        held_up = held.seconds + sensors.waited() - before
        is_silent = node.output().count("speed.missing()") > silences
        assert not is_silent or held_up > SPEED_TIMEOUT / 2, "an active sensor was silent"


@pytest.mark.slow
def test_publisher_of_another_type_is_not_the_sensor(robot: Robot) -> None:
    """It is reported, has no effect, and does not hide the silence."""
    with robot.safety_node() as node, robot.sensors({"/speed": "std_msgs/msg/Bool"}) as stranger:
        stranger.play("/speed", button(True))
        robot.until(lambda: "std_msgs/msg/Bool" in node.output())
        with robot.sensors() as sensors:
            sensors.drive()
            robot.until_free()
            sensors.quiet("/speed")
            robot.until_stopped("/halt", limit=0.5 + PROMPT)


@pytest.mark.slow
@pytest.mark.parametrize("garbage", [b"\x00\x01\x00\x00", b"\xff" * 400])
def test_garbage_counts_as_silence(robot: Robot, garbage: bytes) -> None:
    """Data that cannot be decoded is reported once and ignored, however often it arrives."""
    with robot.safety_node() as node, robot.sensors() as sensors:
        sensors.drive()
        robot.until_free()
        sensors.play("/imu", garbage, rate=100.0)
        robot.until_stopped("/halt", limit=0.5 + PROMPT)
        report_count = node.output().count("/imu has carried data that cannot be read")
        assert report_count == robot.software.sees_what_it_cannot_read
        sensors.play("/imu", imu())
        robot.until_free()
