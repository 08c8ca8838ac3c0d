"""Inputs that are early, late or missing at the start, in virtual time."""

from __future__ import annotations

from tests.support.played import TOPICS, imu, speed
from tests.support.virtual_robot import VirtualRobot, ns

GRACE = 10.0
TIMEOUT = 0.5


def test_existing_inputs_are_used_from_the_start(robot: VirtualRobot) -> None:
    """A node started in a running robot detects a violation in progress."""
    sensors = robot.sensors()
    sensors.play("/speed", speed(2.0))
    sensors.play("/imu", imu())
    robot.run(0.51)
    robot.start()
    assert robot.until_active("/stop") == sensors.last["/speed"]
    assert not robot.is_active("/halt")


def test_late_inputs_are_used_when_they_appear(robot: VirtualRobot) -> None:
    """Publishers discovered seconds after the node are used like any other."""
    robot.start()
    robot.run(20.0)
    sensors = robot.sensors()
    sensors.drive()
    robot.until_free()
    robot.assert_protects()


def test_node_without_inputs_halts_after_their_timeout(robot: VirtualRobot) -> None:
    """Without a grace they are missing as early as later on."""
    began = robot.now
    robot.start()
    assert robot.until_active("/halt") == began + ns(TIMEOUT)
    assert not robot.beats
    robot.until(lambda: robot.beats, 0.1)


def test_grace_has_neither_halt_nor_heartbeat(robot: VirtualRobot) -> None:
    """While inputs are awaited there is neither; the heartbeat starts with the inputs."""
    sensors = robot.sensors()
    robot.start(startup_grace=GRACE)
    robot.run(GRACE - 0.1)
    assert not robot.beats
    assert not any(state.value for state in robot.states["/halt"])
    assert len(robot.states["/halt"]) > 10 * (GRACE - 0.2)
    assert robot.statuses["faulty_safety_node"].message.startswith("starting")
    sensors.drive()
    came = robot.now
    robot.until(lambda: robot.beats, 0.1)
    assert robot.beats[0].at >= came
    robot.until(lambda: not robot.statuses["faulty_safety_node"].message.startswith("starting"))
    robot.run(GRACE)
    assert not any(state.value for state in robot.states["/halt"])
    robot.assert_protects()


def test_absent_input_is_missing_after_the_grace(robot: VirtualRobot) -> None:
    """The grace ends by itself; after the timeout the halt comes, and only then the heartbeat."""
    sensors = robot.sensors({"/speed": TOPICS["/speed"]})
    sensors.play("/speed", speed(0.1))
    began = robot.now
    robot.start(startup_grace=GRACE)
    assert robot.until_active("/halt") == began + ns(GRACE + TIMEOUT)
    assert not robot.beats
    robot.until(lambda: robot.beats, 0.1)
    assert robot.beats[0].at > began + ns(GRACE + TIMEOUT)
    robot.assert_protects()
