"""Faults of the safety node itself: killed, hung, restarted, started twice."""

from __future__ import annotations

import math
import time

import pytest

from tests.support.faults import PROMPT, Robot
from tests.support.played import imu, speed
from tests.support.profiles import scaled

pytestmark = pytest.mark.ros

TILTED = math.radians(20.0)


@pytest.mark.slow
def test_killed_node_falls_silent(robot: Robot) -> None:
    """Heartbeat and states are not repeated, so that readers detect the loss."""
    with robot.safety_node() as node:
        node.kill()
        robot.until_silent()
        robot.restart()


@pytest.mark.slow
def test_hung_node_falls_silent_and_continues(robot: Robot) -> None:
    """A hang stops the heartbeat; afterwards a lasting violation still stops the robot."""
    with robot.safety_node() as node, robot.sensors() as sensors:
        sensors.drive()
        robot.until_free()
        node.freeze()
        sensors.play("/speed", speed(2.0))
        robot.until_silent()
        assert not robot.is_active("/stop")
        node.thaw()
        robot.until_stopped(limit=PROMPT)


@pytest.mark.slow
def test_deadline_during_a_hang_is_late_but_not_lost(robot: Robot) -> None:
    """The 'for' of a rule ends while the node hangs; the halt follows when it continues."""
    with robot.safety_node() as node, robot.sensors() as sensors:
        sensors.drive()
        robot.until_free()
        sensors.play("/imu", imu(TILTED))
        robot.spin(0.1)
        node.freeze()
        robot.spin(1.0)
        node.thaw()
        robot.until_stopped("/halt", limit=PROMPT)


@pytest.mark.slow
def test_events_delayed_by_a_hang_have_the_causes_of_their_time(
    robot: Robot,
) -> None:
    """A reset is refused because of a tilt; that its sensor has fallen silent comes later."""
    with robot.safety_node() as node, robot.sensors() as sensors:
        sensors.drive()
        robot.until_free()
        sensors.play("/imu", imu(TILTED))
        robot.until_stopped("/halt", limit=PROMPT)
        sensors.quiet("/button")
        robot.until_alive()  # by then it has reported all received messages
        robot.events.clear()
        sensors.play("/speed", speed(0.43))
        robot.spin(0.1)
        node.freeze()
        robot.spin(1.0)
        sensors.quiet("/imu")
        node.thaw()
        refused = robot.event("refused", "halt")
        assert (refused["holding"], refused["unknown"]) == ("leaning", "")
        assert refused["rule body.tilted"] == "true"
        assert refused["value orientation.tilt()"].startswith("0.349")
        assert refused["message"].startswith("halt stays active, called for by leaning (")
        released = robot.event("trigger", "release")
        assert released["rule drive.crept"] == "true"
        assert released["value speed"] == "0.43"


@pytest.mark.essential
def test_latched_stop_survives_kill(robot: Robot) -> None:
    """The restarted node publishes the stop from its first message on."""
    with robot.safety_node() as node, robot.sensors() as sensors:
        sensors.drive()
        robot.violate()
        robot.until_alive()  # by now it has finished its work after the stop
        node.kill()
        robot.until_silent()
        seen = len(robot.states["/stop"])
        node = robot.restart()
        assert all(state.value for state in robot.states["/stop"][seen:]), (
            "the stop was undone by a restart"
        )

        robot.until(lambda: robot.reset()[0])  # once it knows that the cause is over
        robot.until(lambda: not robot.is_active("/stop"))
        node.kill()
        node = robot.restart()
        assert not robot.is_active("/stop"), "the reset was undone by a restart"


@pytest.mark.slow
def test_node_restarts_after_a_kill_at_any_moment(robot: Robot) -> None:
    """Wherever it is killed, it can be started again, and monitors."""
    with robot.safety_node() as node, robot.sensors() as sensors:
        sensors.drive()
        for moment in range(scaled(3, least=1)):
            robot.violate()
            time.sleep(moment * 0.001)  # the moment is the variable here
            node.kill()
            node = robot.restart()
            robot.until(lambda: robot.reset()[0])
            robot.until(lambda: not robot.is_active("/stop"))


def test_second_node_refuses_to_run(robot: Robot) -> None:
    """The second exits at once and names the first, which continues."""
    with robot.safety_node() as node:
        second = robot.start()
        assert second.popen.wait(PROMPT + 10.0) == 1
        assert str(node.popen.pid) in second.output()
        assert "Traceback" not in second.output()
