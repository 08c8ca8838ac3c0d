"""Faults of the start: inputs that are early, late or missing."""

from __future__ import annotations

import pytest

from tests.support.faults import NODE, PROMPT, Robot
from tests.support.played import TOPICS, imu, speed

pytestmark = pytest.mark.ros

GRACE = 3.0


@pytest.mark.slow
def test_existing_inputs_are_used_from_the_start(robot: Robot) -> None:
    """A node started in a running robot detects a violation in progress."""
    with robot.sensors() as sensors:
        sensors.play("/speed", speed(2.0))
        sensors.play("/imu", imu())
        with robot.safety_node():
            robot.until_stopped()


@pytest.mark.slow
def test_late_inputs_are_used_when_they_appear(robot: Robot) -> None:
    """Publishers discovered seconds after the node are used like any other."""
    with robot.safety_node():
        robot.spin(2.0)
        with robot.sensors() as sensors:
            sensors.drive()
            robot.until_free()
            sensors.play("/speed", speed(2.0))
            robot.until_stopped()


@pytest.mark.slow
def test_grace_has_neither_halt_nor_heartbeat(robot: Robot) -> None:
    """While inputs are awaited there is neither; the heartbeat starts with the inputs."""
    with robot.sensors() as sensors:
        node = robot.start(NODE, [f"startup_grace:={10 * GRACE}"])
        robot.until(lambda: robot.states["/halt"])
        robot.spin(1.0)  # longer than the timeouts
        assert not robot.beats
        sensors.drive()
        robot.until_alive()
        assert not any(state.value for state in robot.states["/halt"])
        sensors.play("/speed", speed(2.0))
        robot.until_stopped(limit=PROMPT)
        node.end()


@pytest.mark.slow
def test_absent_input_is_missing_after_the_grace(robot: Robot) -> None:
    """The grace period ends by itself: the halt comes, and the heartbeat."""
    with robot.sensors({"/speed": TOPICS["/speed"]}) as sensors:
        sensors.play("/speed", speed(0.1))
        with robot.safety_node(f"startup_grace:={GRACE}"):
            assert robot.is_active("/halt")
