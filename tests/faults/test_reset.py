"""A latched stop is not reset while nobody knows whether its cause is over."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from tests.faults.test_gate import assert_zeros_only, stands
from tests.support.faults import NODE, Robot
from tests.support.played import scan, speed
from tests.support.ros import Peer, short_lease

pytestmark = pytest.mark.ros

CLEAR, BLOCKED = 5.0, 0.1
"""Distances ahead, in m, with which the robot may drive and may not."""


def refused(robot: Robot, unknown: str) -> bool:
    """Ask for a reset, which must be refused; tell whether it is because of what is unknown."""
    success, message = robot.reset()
    assert not success, message
    why = message.partition("stop stays active, not known to be false: ")[2]
    return "racing (faulty.deros:" in why and why.endswith(f", unknown: {unknown}")


def assert_refused(robot: Robot, unknown: str) -> None:
    """See that a reset is refused because of what is unknown, and that no command passes."""
    robot.until(lambda: stands(robot))
    stopped = len(robot.commands)
    robot.until(lambda: refused(robot, unknown))
    assert robot.is_active("/stop")
    assert_zeros_only(robot, stopped)


def assert_reset(robot: Robot) -> None:
    """See that the reset is granted once all is known to be well, and that commands pass."""
    robot.until(lambda: robot.reset()[0])
    robot.until_driving()


NEAREST = "scan.nearest(-0.523599, 0.523599)"


def test_no_reset_while_the_lidar_measures_nothing(robot: Robot) -> None:
    """A scan of NaN alone says nothing of the obstacle that has stopped the robot."""
    with robot.safety_node(), robot.gate(), robot.sensors() as sensors:
        sensors.drive()
        robot.until_driving()
        sensors.play("/scan", scan(BLOCKED))
        robot.until_stopped()
        sensors.play("/scan", scan(math.nan))
        assert_refused(robot, NEAREST)
        sensors.play("/scan", scan(CLEAR))
        assert_reset(robot)


def test_no_reset_before_the_first_scan(robot: Robot, tmp_path: Path) -> None:
    """After a restart nothing is known of the obstacle until the lidar has said something."""
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


def test_no_reset_while_a_sensor_is_dead(robot: Robot) -> None:
    """A speed that has gone missing is not known to be slow enough."""
    with robot.safety_node(), robot.gate(), robot.sensors() as sensors:
        sensors.drive()
        robot.until_driving()
        sensors.play("/speed", speed(2.0))
        robot.until_stopped()
        sensors.quiet("/speed")
        assert_refused(robot, "speed")
        sensors.drive()
        assert_reset(robot)


def test_a_second_reset_finds_nothing_to_reset(robot: Robot) -> None:
    """Of two that call at once, one resets the stop; the other is answered, and undoes nothing."""
    with robot.safety_node(), robot.sensors() as sensors:
        sensors.drive()
        robot.violate()
        robot.until(lambda: robot.reset() == (True, "stop is reset"))
        assert robot.reset() == (True, "no latched action was active")

        def answers_of_two() -> list[str]:
            robot.violate()
            assert robot.is_active("/stop")
            requests = [robot.call_reset() for _ in range(2)]
            robot.until(lambda: all(each.done() for each in requests))
            return sorted(each.result().message for each in requests)

        answers = answers_of_two()
        for _ in range(20):  # a node that has not heard yet that it is over refuses
            if not answers[-1].startswith("stop stays active"):
                break
            robot.until(lambda: robot.reset()[0])
            answers = answers_of_two()
        assert answers == ["no latched action was active", "stop is reset"]


def test_a_reset_that_comes_late_is_judged_when_it_is_served(robot: Robot) -> None:
    """Called while the node hangs, it is not answered; then what is known by then refuses it."""
    with robot.safety_node() as node, robot.sensors() as sensors:
        sensors.drive()
        robot.until_free()
        sensors.play("/scan", scan(BLOCKED))
        robot.until_stopped()
        sensors.play("/scan", scan(CLEAR))
        robot.spin(0.3)  # by now a reset would be granted
        sensors.quiet("/speed")
        robot.spin(0.2)  # what it has sent is taken
        node.freeze()
        request = robot.call_reset()
        robot.spin(1.0)  # longer than the timeout of the speed
        assert not request.done()
        assert robot.is_active("/stop")
        node.thaw()
        robot.until(request.done)
        assert not request.result().success
        assert request.result().message.endswith(", unknown: speed")
        assert robot.is_active("/stop")


def test_a_reset_of_a_stranger_is_judged_like_any_other(robot: Robot) -> None:
    """Whoever may call is believed: refused while the cause lasts, and granted when it is over."""
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
