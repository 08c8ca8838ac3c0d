"""Faults of the start: who comes first, who comes late, who never comes."""

from __future__ import annotations

import pytest

from tests.support.faults import NODE, PROMPT, Robot
from tests.support.played import TOPICS, imu, speed

pytestmark = pytest.mark.ros

GRACE = 3.0


def test_inputs_that_are_there_first_are_heard_from_the_start(robot: Robot) -> None:
    """A node that is started into a running robot sees the violation that is under way."""
    with robot.sensors() as sensors:
        sensors.play("/speed", speed(2.0))
        sensors.play("/imu", imu())
        with robot.safety_node():
            robot.until_stopped()


def test_inputs_that_come_late_are_heard_when_they_come(robot: Robot) -> None:
    """Publishers that are discovered seconds after the node are heard like any other."""
    with robot.safety_node():
        robot.spin(2.0)
        with robot.sensors() as sensors:
            sensors.drive()
            robot.until_free()
            sensors.play("/speed", speed(2.0))
            robot.until_stopped()


def test_within_the_grace_nobody_is_missing_and_nobody_may_drive(robot: Robot) -> None:
    """While inputs are awaited there is no halt, and no heartbeat either; then it beats at once."""
    with robot.sensors() as sensors:
        node = robot.start(NODE, [f"startup_grace:={10 * GRACE}"])
        robot.until(lambda: robot.states["/halt"])
        robot.spin(1.0)  # longer than the timeouts
        assert not robot.beats
        sensors.drive()
        robot.until_alive()
        assert not any(each.value for each in robot.states["/halt"])
        sensors.play("/speed", speed(2.0))
        robot.until_stopped(limit=PROMPT)
        node.end()


def test_who_never_comes_is_missing_when_the_grace_ends(robot: Robot) -> None:
    """The grace ends by itself: the halt comes, and the heartbeat."""
    with robot.sensors({"/speed": TOPICS["/speed"]}) as sensors:
        sensors.play("/speed", speed(0.1))
        with robot.safety_node(f"startup_grace:={GRACE}"):
            assert robot.is_active("/halt")
