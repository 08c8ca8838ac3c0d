"""A latched stop is not reset while its cause is unknown."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from tests.faults.test_gate import assert_zeros_only, is_stopped
from tests.support.faults import NODE, Robot
from tests.support.played import scan, speed
from tests.support.ros import Peer, short_lease

pytestmark = pytest.mark.ros

CLEAR, BLOCKED = 5.0, 0.1
"""Distances ahead, in m, at which the robot may drive and may not."""


def refused(robot: Robot, unknown: str) -> bool:
    """Request a reset, which must be refused; return whether the reason is an unknown value."""
    success, message = robot.reset()
    assert not success, message
    why = message.partition("stop stays active, not known to be false: ")[2]
    return "racing (faulty.deros:" in why and why.endswith(f": {unknown} is unknown)")


def assert_refused(robot: Robot, unknown: str) -> None:
    """Assert that a reset is refused because of an unknown value, and that no command passes."""
    robot.until(lambda: is_stopped(robot))
    stopped = len(robot.commands)
    robot.until(lambda: refused(robot, unknown))
    assert robot.is_active("/stop")
    assert_zeros_only(robot, stopped)


def assert_reset(robot: Robot) -> None:
    """Assert that the reset succeeds once everything is known and safe, and that commands pass."""
    robot.until(lambda: robot.reset()[0])
    robot.until_driving()


NEAREST = "scan.nearest(-0.523599, 0.523599)"


@pytest.mark.slow
def test_reset_is_refused_while_the_lidar_measures_nothing(robot: Robot) -> None:
    """A scan of only NaN does not show that the obstacle is gone."""
    with robot.safety_node(), robot.gate(), robot.sensors() as sensors:
        sensors.drive()
        robot.until_driving()
        sensors.play("/scan", scan(BLOCKED))
        robot.until_stopped()
        sensors.play("/scan", scan(math.nan))
        assert_refused(robot, NEAREST)
        sensors.play("/scan", scan(CLEAR))
        assert_reset(robot)


@pytest.mark.slow
def test_reset_is_refused_before_the_first_scan(robot: Robot, tmp_path: Path) -> None:
    """After a restart the obstacle is unknown until the lidar publishes."""
    lease = short_lease(tmp_path)
    with robot.safety_node(**lease) as node, robot.gate(), robot.sensors() as sensors:
        sensors.drive()
        robot.until_driving()
        sensors.play("/scan", scan(BLOCKED))
        robot.until_stopped()
        node.kill()
        sensors.quiet("/scan")
        robot.restart()
        assert_refused(robot, NEAREST)
        sensors.play("/scan", scan(CLEAR))
        assert_reset(robot)


def test_reset_is_refused_while_a_sensor_is_dead(robot: Robot) -> None:
    """A missing speed is not known to be slow enough."""
    with robot.safety_node(), robot.gate(), robot.sensors() as sensors:
        sensors.drive()
        robot.until_driving()
        sensors.play("/speed", speed(2.0))
        robot.until_stopped()
        sensors.quiet("/speed")
        assert_refused(robot, "speed")
        sensors.drive()
        assert_reset(robot)


@pytest.mark.slow
def test_second_reset_has_nothing_to_reset(robot: Robot) -> None:
    """Of two calls at once, one resets the stop; the other is answered, and undoes nothing."""
    with robot.safety_node(), robot.sensors() as sensors:
        sensors.drive()
        robot.violate()
        robot.until(lambda: robot.reset() == (True, "stop is reset"))
        assert robot.reset() == (True, "no latched action was active")

        def answers_of_two() -> list[str]:
            robot.violate()
            assert robot.is_active("/stop")
            requests = [robot.call_reset() for _ in range(2)]
            robot.until(lambda: all(request.done() for request in requests))
            return sorted(request.result().message for request in requests)

        answers = answers_of_two()
        for _ in range(20):  # a node that does not know yet that it is over refuses
            if not answers[-1].startswith("stop stays active"):
                break
            robot.until(lambda: robot.reset()[0])
            answers = answers_of_two()
        assert answers == ["no latched action was active", "stop is reset"]


@pytest.mark.slow
def test_late_reset_is_decided_when_it_is_served(robot: Robot) -> None:
    """A call during a hang is refused by the values known when it is served."""
    with robot.safety_node() as node, robot.sensors() as sensors:
        sensors.drive()
        robot.until_free()
        sensors.play("/scan", scan(BLOCKED))
        robot.until_stopped()
        sensors.play("/scan", scan(CLEAR))
        robot.spin(0.3)  # by now a reset would succeed
        sensors.quiet("/speed")
        robot.spin(0.2)  # its messages have been received
        node.freeze()
        request = robot.call_reset()
        robot.spin(1.0)  # longer than the timeout of the speed
        assert not request.done()
        assert robot.is_active("/stop")
        node.thaw()
        robot.until(request.done)
        assert not request.result().success
        assert request.result().message.endswith(": speed is unknown)")
        assert robot.is_active("/stop")


@pytest.mark.slow
def test_reset_from_another_participant_is_decided_like_any_other(robot: Robot) -> None:
    """It is refused while the cause lasts, and succeeds when it is over."""
    from std_srvs.srv import Trigger

    stranger = Peer(int(robot.env["ROS_DOMAIN_ID"]), "stranger")
    client = stranger.node.create_client(Trigger, f"/{NODE}/reset")
    with robot.safety_node(), robot.sensors() as sensors:
        sensors.drive()
        sensors.play("/scan", scan(BLOCKED))
        robot.until_stopped()
        answer = stranger.call(client, Trigger.Request())
        assert not answer.success
        assert "stop stays active" in answer.message
        sensors.play("/scan", scan(CLEAR))
        stranger.until(lambda: stranger.call(client, Trigger.Request()).success)
        robot.until(lambda: not robot.is_active("/stop"))
    stranger.close()
