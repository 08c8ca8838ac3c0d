"""A stopped robot moves again on request, and not because a fault is over.

The controller keeps commanding throughout, like one that knows nothing of gates. Losses of this
gate take a second, in which a busy machine lets each process run.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from tests.support.faults import PROMPT, WHEELS_GATE, Robot
from tests.support.played import COMMAND, COMMANDER, SENSES, command, imu
from tests.support.profiles import slow
from tests.support.ros import Peer, short_lease
from tests.support.victims import Process, Sensors

pytestmark = pytest.mark.ros

RESET, ZERO = "waits for a reset", "waits for a zero command"


def drive(sensors: Sensors) -> None:
    """Command a speed, repeatedly."""
    sensors.play("/cmd_vel_nav", command(), rate=20.0)


def _is_moving(robot: Robot) -> bool:
    """Return whether commands pass."""
    return bool(robot.wheels) and robot.wheels[-1].value == COMMAND


def until_standing(robot: Robot) -> None:
    """Wait until the wheels get zeros permanently: a single one may be due to a busy machine."""
    robot.until(lambda: len(robot.wheels) >= 5 and not any(w.value for w in robot.wheels[-5:]))


def release(robot: Robot, sensors: Sensors) -> None:
    """Command zero until it passes, and then a speed again, which passes too.

    A halt in between, as of a sensor that a busy machine does not let run, asks for zero again.
    """
    while not _passes(robot, sensors):
        pass


def _passes(robot: Robot, sensors: Sensors) -> bool:
    """Command zero until it passes, and then a speed; return whether no halt came in between."""
    heard = len(robot.states["/halt"])

    def is_halted() -> bool:
        halts = any(each.value for each in robot.states["/halt"][heard:])
        return halts and robot.waiting.startswith(ZERO)

    sensors.play("/cmd_vel_nav", command(0.0), rate=20.0)
    robot.until(lambda: robot.waiting == "commands pass")
    drive(sensors)
    robot.until(lambda: _is_moving(robot) or is_halted())
    return _is_moving(robot)


def assert_waits(robot: Robot, why: str, since: int | None = None) -> None:
    """Assert that the gate reports why it waits, and that nothing moves while it does.

    Args:
        robot: the robot.
        why: the reported reason.
        since: number of commands at the wheels when they stopped; by default, at the report.
    """
    robot.until(lambda: _reason(robot).startswith(why))
    first = len(robot.wheels) if since is None else since
    heard = len(robot.wheels)
    robot.spin(1.0)
    robot.until(lambda: len(robot.wheels) >= heard + 10)
    assert not any(wheel.value for wheel in robot.wheels[first:])
    assert _reason(robot).startswith(why)


def _reason(robot: Robot) -> str:
    """Return why the gate waits, once it no longer reports a killed publisher."""
    fault, _, rest = robot.waiting.partition("; ")
    return rest if "publishers where one is expected" in fault else robot.waiting


@contextmanager
def moving(robot: Robot, topics: dict[str, str] | None = None) -> Iterator[Sensors]:
    """Start the motion as an operator does: reset the gate, release, and drive."""
    with robot.sensors({**SENSES, **COMMANDER} if topics is None else topics) as sensors:
        sensors.drive()
        drive(sensors)
        robot.until_free()
        assert_waits(robot, RESET, 0)
        robot.until(lambda: robot.reset(WHEELS_GATE)[0])
        assert_waits(robot, ZERO, 0)
        release(robot, sensors)
        yield sensors


@pytest.mark.parametrize("fault", [Process.kill, slow(Process.freeze)])
def test_recovered_safety_node_starts_no_motion(
    robot: Robot, tmp_path: Path, fault: Callable[[Process], None]
) -> None:
    """After a crash or a hang, a person resets the gate, and then the controller releases it."""
    # The gate accepts the restarted node after the lease, which a hang must not exceed.
    lease = short_lease(tmp_path) if fault is Process.kill else {}
    with robot.safety_node(**lease) as node, robot.wheels_gate(), moving(robot) as sensors:
        fault(node)
        until_standing(robot)
        standing = len(robot.wheels)
        if fault is Process.kill:
            robot.restart()
        else:
            node.thaw()
        assert_waits(robot, RESET, standing)
        assert robot.reset(WHEELS_GATE) == (True, f"reset: {ZERO}")
        assert_waits(robot, ZERO, standing)
        release(robot, sensors)


@pytest.mark.slow
def test_restarted_gate_starts_no_motion(robot: Robot) -> None:
    """Killed while commands passed, it starts as after a loss."""
    with robot.safety_node(), robot.wheels_gate() as gate, moving(robot) as sensors:
        gate.kill()
        killed = len(robot.wheels)
        gate = robot.start(WHEELS_GATE)
        robot.until(lambda: len(robot.wheels) > killed)
        robot.wheels.clear()
        assert_waits(robot, RESET, 0)
        assert robot.reset(WHEELS_GATE) == (True, f"reset: {ZERO}")
        assert_waits(robot, ZERO, 0)
        release(robot, sensors)
        gate.end()


@pytest.mark.slow
def test_hung_gate_starts_no_motion(robot: Robot) -> None:
    """It cannot know what it has missed, so it latches first."""
    with robot.safety_node(), robot.wheels_gate() as gate, moving(robot) as sensors:
        gate.freeze()
        robot.spin(2.0)
        robot.wheels.clear()
        gate.thaw()
        assert_waits(robot, RESET, 0)
        assert robot.reset(WHEELS_GATE)[0]
        release(robot, sensors)


@pytest.mark.slow
@pytest.mark.parametrize("fault", [slow(Sensors.kill), Sensors.freeze])
def test_recovered_controller_starts_no_motion(
    robot: Robot, fault: Callable[[Sensors], None]
) -> None:
    """The same controller, or one in its place, has to begin with zero."""
    with (
        robot.safety_node(),
        robot.wheels_gate(),
        robot.sensors(SENSES) as senses,
    ):
        senses.drive()
        with moving(robot, COMMANDER) as controller:
            fault(controller)
            until_standing(robot)
            standing = len(robot.wheels)
            if fault is Sensors.freeze:
                controller.thaw()
                assert_waits(robot, ZERO, standing)
                release(robot, controller)
                return
        with robot.sensors(COMMANDER) as controller:
            drive(controller)
            assert_waits(robot, ZERO, standing)
            release(robot, controller)


@pytest.mark.slow
def test_reset_of_an_action_starts_no_motion(robot: Robot) -> None:
    """This holds for a latched action that a person resets, and for one that ends by itself."""
    with robot.safety_node(), robot.wheels_gate(), moving(robot) as sensors:
        robot.violate()
        until_standing(robot)
        standing = len(robot.wheels)
        robot.until(lambda: robot.reset()[0])
        assert_waits(robot, ZERO, standing)
        release(robot, sensors)
        sensors.play("/imu", imu(math.radians(30.0)))
        robot.until_stopped("/halt")
        until_standing(robot)
        standing = len(robot.wheels)
        sensors.play("/imu", imu())
        robot.until_free()
        assert_waits(robot, ZERO, standing)
        release(robot, sensors)


@pytest.mark.slow
def test_nan_between_commands_starts_no_motion(robot: Robot) -> None:
    """It is a loss that ends with the next command, which does not pass."""
    with robot.safety_node(), robot.wheels_gate(), moving(robot) as sensors:
        sensors.send("/cmd_vel_nav", command(), command(math.nan), command())
        drive(sensors)
        assert_waits(robot, ZERO)
        release(robot, sensors)


@pytest.mark.slow
def test_zero_during_the_stop_does_not_release(robot: Robot) -> None:
    """It is outdated when the stop ends: the controller commands a speed by then."""
    with robot.safety_node(), robot.wheels_gate(), moving(robot) as sensors:
        robot.violate()
        until_standing(robot)
        standing = len(robot.wheels)
        sensors.play("/cmd_vel_nav", command(0.0), rate=20.0)
        robot.spin(0.5)
        drive(sensors)
        robot.spin(0.5)
        robot.until(lambda: robot.reset()[0])
        assert_waits(robot, ZERO, standing)
        release(robot, sensors)


@pytest.mark.slow
def test_reset_is_refused_while_its_cause_lasts(robot: Robot, tmp_path: Path) -> None:
    """The response names the cause, and the request is not remembered."""
    lease = short_lease(tmp_path)
    with robot.safety_node(**lease) as node, robot.wheels_gate(), moving(robot) as sensors:
        node.kill()
        until_standing(robot)
        standing = len(robot.wheels)
        done, why = robot.reset(WHEELS_GATE)
        assert not done
        assert why.startswith("not reset, because this applies: stop: zero (")
        assert "lost heartbeat for 1 sec: zero until reset" in why
        robot.restart()
        assert_waits(robot, RESET, standing)
        sensors.quiet("/cmd_vel_nav")
        robot.until(lambda: "lost input" in robot.waiting)
        done, why = robot.reset(WHEELS_GATE)
        assert not done
        assert "lost input for 1 sec: zero" in why
        drive(sensors)
        assert_waits(robot, RESET, standing)
        assert robot.reset(WHEELS_GATE)[0]
        assert_waits(robot, ZERO, standing)
        release(robot, sensors)


@pytest.mark.slow
def test_resets_from_other_participants_are_decided_like_any_other(robot: Robot) -> None:
    """Any number may call: each gets a response, and none starts a motion."""
    from std_srvs.srv import Trigger

    stranger = Peer(int(robot.env["ROS_DOMAIN_ID"]), "stranger")
    client = stranger.node.create_client(Trigger, f"/{WHEELS_GATE}/reset")
    with robot.safety_node(), robot.wheels_gate(), robot.sensors() as sensors:
        assert not stranger.call(client, Trigger.Request()).success
        sensors.drive()
        drive(sensors)
        robot.until_free()
        assert_waits(robot, RESET, 0)
        requests = [robot.call_reset(WHEELS_GATE) for _ in range(2)]
        assert stranger.call(client, Trigger.Request()).success
        robot.until(lambda: all(request.done() for request in requests))
        assert {request.result().message for request in requests} == {f"reset: {ZERO}"}
        assert_waits(robot, ZERO, 0)
        release(robot, sensors)
    stranger.close()


@pytest.mark.slow
def test_late_reset_starts_no_motion(robot: Robot) -> None:
    """A call during a hang of the gate is decided when it is served, by the state then."""
    with robot.safety_node(), robot.wheels_gate() as gate, moving(robot) as sensors:
        gate.freeze()
        request = robot.call_reset(WHEELS_GATE)
        robot.spin(2.0)
        assert not request.done()
        robot.wheels.clear()
        gate.thaw()
        robot.until(request.done)
        assert_waits(robot, "waits", 0)
        robot.until(lambda: robot.reset(WHEELS_GATE)[0])
        release(robot, sensors)


@pytest.mark.slow
def test_vanished_reset_client_delays_the_gate_only_briefly(robot: Robot) -> None:
    """The middleware waits 0.1 s per request for a vanished client; then the zeros continue."""
    from std_srvs.srv import Trigger

    stranger = Peer(int(robot.env["ROS_DOMAIN_ID"]), "stranger")
    client = stranger.node.create_client(Trigger, f"/{WHEELS_GATE}/reset")
    requests = 10
    with robot.safety_node(), robot.wheels_gate():
        stranger.until(client.service_is_ready)
        for _ in range(requests):
            client.call_async(Trigger.Request())
        stranger.close()
        now, heard, stalled = time.time(), len(robot.wheels), robot.peer.held_up
        robot.until(lambda: len(robot.wheels) >= heard + 5)
        passed = robot.wheels[-1].received - now - (robot.peer.held_up - stalled)
        assert passed < 0.1 * requests + PROMPT
