"""Faults around the gate: the safety node, the controller or the gate itself is missing."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.support.faults import GATE, PROMPT, Robot
from tests.support.needs import needs
from tests.support.played import COMMANDER, SENSES, TOPICS, command, load
from tests.support.preload import WallClock
from tests.support.profiles import slow
from tests.support.ros import short_lease
from tests.support.victims import Process, Sensors

pytestmark = pytest.mark.ros

LOST_HEARTBEAT, LOST_INPUT = 0.3, 0.5
"""Times after which the gate considers heartbeat or input lost, in s; see the rules."""

LIMIT = 0.1
"""The speed, in m/s, to which the gate limits commands while the arm is overloaded."""

DAY = 86400


def assert_zeros_only(robot: Robot, first: int) -> None:
    """Assert that the drive gets only zeros from the command of that index on, at a steady rate."""
    commands = len(robot.commands)
    robot.spin(0.5)
    assert len(robot.commands) >= commands + 5, "the gate fell silent"
    assert not any(each.value for each in robot.commands[first:])


def is_stopped(robot: Robot) -> bool:
    """Return whether the drive gets zeros permanently; a single one may be due to load."""
    return len(robot.commands) >= 5 and not any(each.value for each in robot.commands[-5:])


def is_driving(robot: Robot) -> bool:
    """Return whether the drive has received nonzero commands for half a second."""
    return len(robot.commands) >= 10 and all(each.value for each in robot.commands[-10:])


@pytest.mark.slow
@pytest.mark.parametrize("fault", [Process.kill, Process.freeze])
def test_dead_or_hung_safety_node_stops_the_robot(
    robot: Robot, tmp_path: Path, fault: Callable[[Process], None]
) -> None:
    """Only zeros come then; tests/faults/virtual asks that they come after 0.3 s."""
    lease = short_lease(tmp_path)  # after which the gate accepts the restarted node
    with robot.safety_node(**lease) as node, robot.gate(), robot.sensors() as sensors:
        sensors.drive()
        robot.until(lambda: is_driving(robot))
        fault(node)
        robot.until(lambda: is_stopped(robot))
        zero = max(n for n, each in enumerate(robot.commands) if each.value) + 1
        assert_zeros_only(robot, zero)
        node.kill()
        robot.restart()
        robot.until_driving()


@pytest.mark.slow
def test_latched_stop_survives_any_crash(robot: Robot, tmp_path: Path) -> None:
    """From the stop to its reset the drive gets only zeros, whichever process dies."""
    lease = short_lease(tmp_path)
    with robot.safety_node(**lease) as node, robot.sensors() as sensors:
        gate = robot.start(GATE)
        sensors.drive()
        robot.until_driving()
        robot.violate()
        robot.until(lambda: robot.commands[-1].value == 0.0)
        stopped = len(robot.commands)
        node.kill()
        robot.restart()
        assert_zeros_only(robot, stopped)
        gate.kill()
        killed = time.time()
        gate = robot.start(GATE)
        robot.until(lambda: robot.commands[-1].sent > killed)
        robot.spin(1.0)
        assert_zeros_only(robot, stopped)
        robot.until(lambda: robot.reset()[0])
        robot.until_driving()
        gate.end()


@pytest.mark.slow
def test_gate_without_a_safety_node_commands_zero(robot: Robot) -> None:
    """Started alone, it lets no command pass."""
    with robot.sensors() as sensors:
        sensors.play("/cmd_vel_nav", command(), rate=20.0)
        gate = robot.start(GATE)
        robot.until(lambda: robot.commands)
        robot.spin(2 * LOST_HEARTBEAT)
        assert_zeros_only(robot, 0)
        gate.end()


@pytest.mark.slow
@pytest.mark.parametrize("fault", [Sensors.kill, slow(Sensors.freeze)])
def test_dead_or_hung_controller_is_followed_by_zeros(
    robot: Robot, fault: Callable[[Sensors], None]
) -> None:
    """Without a command for 0.5 s the drive gets zeros, even if no sensor is missing."""
    with (
        robot.safety_node(),
        robot.gate(),
        robot.sensors(SENSES) as sensors,
        robot.sensors(COMMANDER) as commander,
    ):
        sensors.drive()
        commander.drive()
        robot.until_driving()
        fault(commander)
        robot.until(lambda: is_stopped(robot), limit=LOST_INPUT + PROMPT)
        assert_zeros_only(robot, len(robot.commands))
        assert not robot.is_active("/halt")


@pytest.mark.slow
def test_nan_command_counts_as_lost_input(robot: Robot) -> None:
    """No NaN reaches the drive; a zero does, at once."""
    with robot.safety_node(), robot.gate(), robot.sensors() as sensors:
        sensors.drive()
        robot.until_driving()
        sensors.play("/cmd_vel_nav", command(math.nan), rate=20.0)
        robot.until(lambda: robot.commands[-1].value == 0.0, limit=PROMPT)
        sensors.play("/cmd_vel_nav", command(math.inf), command(-math.inf), rate=20.0)
        robot.spin(1.0)
        assert {each.value for each in robot.commands[-10:]} == {0.0}
        sensors.play("/cmd_vel_nav", command(), rate=20.0)
        robot.until_driving()


@pytest.mark.slow
def test_flood_of_commands_does_not_block_a_stop(robot: Robot) -> None:
    """At twenty thousand commands a second, a stop still becomes a zero."""
    with robot.safety_node(), robot.gate(), robot.sensors() as sensors:
        sensors.drive()
        robot.until_driving()
        sensors.play("/cmd_vel_nav", command(), rate=20_000.0)
        robot.spin(1.0)
        robot.violate()
        robot.until(lambda: robot.commands[-1].value == 0.0, limit=PROMPT)
        sensors.play("/cmd_vel_nav", command(), rate=20.0)
        robot.spin(0.5)  # earlier commands have passed
        assert_zeros_only(robot, len(robot.commands))


@pytest.mark.slow
def test_limit_becomes_zero_when_the_safety_node_dies(robot: Robot) -> None:
    """The robot does not creep under a limit that is no longer monitored."""
    with robot.safety_node() as node, robot.gate(), robot.sensors() as sensors:
        sensors.drive()
        sensors.match("/load")
        robot.until_driving()
        sensors.send("/load", load(99.0))
        robot.until(lambda: robot.commands[-1].value == LIMIT, limit=PROMPT)
        limited = len(robot.commands)
        robot.spin(0.5)
        assert {each.value for each in robot.commands[limited:]} == {LIMIT}
        node.kill()
        robot.until(lambda: robot.commands[-1].value == 0.0, limit=LOST_HEARTBEAT + PROMPT)
        assert_zeros_only(robot, len(robot.commands))
        robot.restart()


@needs("gcc")
@pytest.mark.slow
def test_zeros_survive_a_wall_clock_step(robot: Robot, tmp_path: Path) -> None:
    """Set back by a year, without messages, the gate still detects the loss and still commands."""
    wall_clock = WallClock(tmp_path)
    env = wall_clock.env
    with (
        robot.safety_node(**env) as node,
        robot.gate(**env),
        robot.sensors(TOPICS, **env) as sensors,
    ):
        sensors.drive()
        robot.until_driving()
        wall_clock.step(-400 * DAY)
        sensors.freeze()
        node.freeze()
        robot.until(lambda: robot.commands[-1].value == 0.0, limit=LOST_HEARTBEAT + PROMPT)
        assert_zeros_only(robot, len(robot.commands))
        node.thaw()
