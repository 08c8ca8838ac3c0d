"""A stopped robot moves again on request, and not because a fault is over: in virtual time.

The controller keeps commanding throughout, like one that knows nothing of gates.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest

from tests.support.faults import WHEELS_GATE
from tests.support.played import COMMAND, COMMANDER, SENSES, command, imu, speed
from tests.support.virtual_graph import VirtualNode
from tests.support.virtual_robot import Sensors, VirtualRobot

pytestmark = pytest.mark.essential

RESET, ZERO = "waits for a reset", "waits for a zero command"


@pytest.fixture
def gate(robot: VirtualRobot, node: VirtualNode) -> VirtualNode:
    """Return the running gate, which has received nothing yet."""
    assert node.is_running
    return robot.start(WHEELS_GATE)


@pytest.fixture
def sensors(robot: VirtualRobot, gate: VirtualNode) -> Sensors:
    """Return the sensors of a robot that moves."""
    assert gate.is_running
    sensors = robot.sensors(SENSES)
    sensors.drive()
    return sensors


@pytest.fixture
def controller(robot: VirtualRobot, sensors: Sensors) -> Sensors:
    """Return what commands the robot, after the start of the motion by an operator."""
    assert sensors.is_running
    controller = robot.sensors(COMMANDER)
    drive(controller)
    robot.until_free()
    restart_motion(robot, controller)
    return controller


def drive(controller: Sensors, value: float = COMMAND) -> None:
    """Command a speed, repeatedly."""
    controller.play("/cmd_vel_nav", command(value), rate=20.0)


def assert_waits(robot: VirtualRobot, why: str, seconds: float = 2.0) -> None:
    """Assert that the gate reports why it waits, and that nothing moves while it does."""
    before = len(robot.wheels)
    robot.run(seconds)
    assert len(robot.wheels) >= before + 20 * seconds - 1
    assert not any(wheel.value for wheel in robot.wheels[before:])
    assert robot.waiting().startswith(why)


def release(robot: VirtualRobot, controller: Sensors) -> None:
    """Command zero until it passes, and then a speed again, which passes too."""
    drive(controller, 0.0)
    robot.until(lambda: robot.waiting() == "commands pass")
    assert not robot.wheels[-1].value
    drive(controller)
    robot.run(0.001)
    assert robot.wheels[-1].value == COMMAND


def restart_motion(robot: VirtualRobot, controller: Sensors) -> None:
    """Reset the gate, as a person does, and release it."""
    assert_waits(robot, RESET)
    assert robot.reset(WHEELS_GATE) == (True, f"reset: {ZERO}")
    assert_waits(robot, ZERO)
    release(robot, controller)


def test_start_needs_a_reset_and_a_zero(robot: VirtualRobot, controller: Sensors) -> None:
    """From the start to the operator's request nothing has moved."""
    assert controller.is_running
    moving = next(n for n, wheel in enumerate(robot.wheels) if wheel.value)
    assert moving >= 80


@pytest.mark.parametrize("is_killed", [True, False])
def test_recovered_safety_node_starts_no_motion(
    robot: VirtualRobot, node: VirtualNode, controller: Sensors, is_killed: bool
) -> None:
    """After a crash or a hang, a person resets the gate, and then the controller releases it."""
    if is_killed:
        robot.kill(node)
        robot.run(2.0)
        robot.start()
    else:
        node.freeze()
        robot.run(2.0)
        node.thaw()
    assert not robot.wheels[-1].value
    restart_motion(robot, controller)


def test_restarted_gate_starts_no_motion(
    robot: VirtualRobot, gate: VirtualNode, controller: Sensors
) -> None:
    """Killed while commands passed, it starts as after a loss."""
    robot.kill(gate)
    robot.run(2.0)
    robot.start(WHEELS_GATE)
    restart_motion(robot, controller)


def test_hung_gate_starts_no_motion(
    robot: VirtualRobot, gate: VirtualNode, controller: Sensors
) -> None:
    """It cannot know what it has missed, so it latches first; a late reset starts no motion."""
    gate.freeze()
    robot.run(2.0)
    gate.thaw()
    restart_motion(robot, controller)


def freeze(robot: VirtualRobot, controller: Sensors) -> Sensors:
    """Let a controller hang for a while."""
    controller.freeze()
    robot.run(2.0)
    controller.thaw()
    return controller


def replace(robot: VirtualRobot, controller: Sensors) -> Sensors:
    """Kill a controller, and start another one in its place."""
    controller.kill()
    robot.run(2.0)
    again = robot.sensors(COMMANDER)
    drive(again)
    return again


@pytest.mark.parametrize("fault", [freeze, replace])
def test_recovered_controller_starts_no_motion(
    robot: VirtualRobot, controller: Sensors, fault: Callable[[VirtualRobot, Sensors], Sensors]
) -> None:
    """The same controller, or one in its place, has to begin with zero."""
    controller = fault(robot, controller)
    assert not robot.wheels[-1].value
    robot.run(2.0)
    assert_waits(robot, ZERO)
    release(robot, controller)


def test_reset_of_an_action_starts_no_motion(
    robot: VirtualRobot, sensors: Sensors, controller: Sensors
) -> None:
    """This holds for a latched action that a person resets, and for one that ends by itself."""
    sensors.send("/speed", speed(9.0))
    robot.run(1.0)
    robot.until(lambda: robot.reset()[0])
    assert not robot.is_active("/stop")
    assert_waits(robot, ZERO)
    release(robot, controller)
    sensors.play("/imu", imu(math.radians(30.0)))
    robot.until_active("/halt")
    robot.run(1.0)
    sensors.play("/imu", imu())
    robot.until_free()
    assert_waits(robot, ZERO)
    release(robot, controller)


def test_nan_between_commands_starts_no_motion(robot: VirtualRobot, controller: Sensors) -> None:
    """It is a loss that ends with the next command, which does not pass."""
    controller.send("/cmd_vel_nav", command(), command(math.nan), command())
    robot.run(1.1)
    assert_waits(robot, ZERO)
    release(robot, controller)


def test_zero_during_the_stop_does_not_release(
    robot: VirtualRobot, sensors: Sensors, controller: Sensors
) -> None:
    """It is outdated when the stop ends: the controller commands a speed by then."""
    sensors.send("/speed", speed(9.0))
    robot.run(0.5)
    drive(controller, 0.0)
    robot.run(0.5)
    drive(controller)
    robot.run(0.5)
    robot.until(lambda: robot.reset()[0])
    assert_waits(robot, ZERO)
    release(robot, controller)


def test_reset_is_refused_while_its_cause_lasts(
    robot: VirtualRobot, node: VirtualNode, controller: Sensors
) -> None:
    """The response names the cause, and the request is not remembered."""
    robot.kill(node)
    robot.run(1.5)
    done, why = robot.reset(WHEELS_GATE)
    assert not done
    assert why.startswith("not reset, because this applies: stop: zero (")
    assert "lost heartbeat for 1 sec: zero until reset" in why
    robot.start()
    assert_waits(robot, RESET)
    controller.quiet("/cmd_vel_nav")
    robot.until(lambda: "lost input" in robot.waiting())
    done, why = robot.reset(WHEELS_GATE)
    assert not done
    assert "lost input for 1 sec: zero" in why
    drive(controller)
    restart_motion(robot, controller)


def test_late_reset_starts_no_motion(
    robot: VirtualRobot, gate: VirtualNode, controller: Sensors
) -> None:
    """A call during a hang of the gate is decided when it is served, by the state then."""
    gate.freeze()
    robot.graph.later(1.0, gate.thaw)
    robot.reset(WHEELS_GATE)
    robot.run(1.1)
    assert_waits(robot, "waits")
    robot.until(lambda: robot.reset(WHEELS_GATE)[0])
    assert_waits(robot, ZERO)
    release(robot, controller)
