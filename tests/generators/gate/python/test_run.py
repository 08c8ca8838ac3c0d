"""Generated gates on real middleware, in each language, with a simulated robot."""

from __future__ import annotations

import itertools
import math
import signal
import time
from typing import Any

import pytest

from tests.support.gate_nodes import GATE, SAFETY_NODE, STILL, World
from tests.support.gate_runners import RunGate
from tests.support.profiles import slow
from tests.support.ros import LIMIT, Peer, set_parameter

pytestmark = pytest.mark.ros

ON_CLOCK = ("use_sim_time:=true", "losses_in_simulated_time:=true")


def test_commands_pass_byte_for_byte(
    run_gate: RunGate, ros_env: dict[str, str], world: World
) -> None:
    """Without active actions, every command is published, unchanged, before anything else."""
    with run_gate(GATE, ros_env):
        world.meet()
        world.release()
        for number in range(200):
            before = len(world.heard)
            data = world.wish(0.001 * number, y=-0.0)
            world.hear_after(before)
            assert world.heard[before][1] == data


def test_robot_is_held_until_it_is_known_to_be_safe(
    run_gate: RunGate, ros_env: dict[str, str], world: World
) -> None:
    """Zeros are published before anything is known, with and without commands."""
    world.beating.cancel()
    with run_gate(GATE, ros_env):
        world.meet()
        world.wish_until(0.3, lambda: len(world.heard) > 5)
        world.beat()
        world.wish_until(0.3, lambda: len(world.heard) > 10)
    assert {world.speeds(data) for _, data in world.heard} == {STILL}


@pytest.mark.essential
def test_stop_publishes_zero_at_once_and_periodically(
    run_gate: RunGate, ros_env: dict[str, str], world: World
) -> None:
    """Nothing else comes after the stop, and zeros go on, with or without commands.

    At which times they come is asked in tests/faults/virtual.
    """
    with run_gate(GATE, ros_env):
        world.meet()
        world.release()
        before = len(world.heard)
        world.stop(True)
        world.hear_after(before)
        world.peer.until(lambda: len(world.heard) >= before + 20)
        world.wish_until(0.3, lambda: len(world.heard) >= before + 40)
        zeros = world.heard[before:]
    assert {world.speeds(data) for _, data in zeros} == {STILL}


@pytest.mark.slow
def test_no_old_command_is_published_when_a_stop_ends(
    run_gate: RunGate, ros_env: dict[str, str], world: World
) -> None:
    """After a stop the gate is silent until the next command."""
    with run_gate(GATE, ros_env):
        world.meet()
        world.release()
        world.stop(True)
        world.wish_until(0.3, lambda: world.last == STILL)
        world.wish(0.0, 0.1)
        world.stop(False)
        passed = len(world.heard)
        world.wish_until(0.2, lambda: world.last == (0.2, 0.0, 0.0))
    assert {world.speeds(data) for _, data in world.heard[passed:]} <= {STILL, (0.2, 0.0, 0.0)}


def test_limits_apply_at_once_to_each_field(
    run_gate: RunGate, ros_env: dict[str, str], world: World
) -> None:
    """The executed command is limited without a new one, and so are later commands."""
    with run_gate(GATE, ros_env):
        world.meet()
        world.release()
        world.wish(0.9, turn=-0.7, y=0.5)
        world.peer.until(lambda: world.last == (0.9, 0.5, -0.7))
        world.mode(1)
        world.peer.until(lambda: world.last == (0.4, 0.5, -0.2))
        world.mode(2)
        world.peer.until(lambda: world.last == (0.1, 0.5, -0.2))
        # A release takes effect a little later than its message.
        unchanged = world.wish(-0.1, turn=3.0)
        world.wish_until(-0.1, lambda: world.heard[-1][1] == unchanged, turn=3.0)
        world.mode(0)
        world.wish_until(-0.9, lambda: world.last == (-0.9, 0.0, 0.0))


@pytest.mark.parametrize("bad", [math.nan, slow(math.inf), slow(-math.inf)])
def test_non_finite_command_is_refused(
    run_gate: RunGate, ros_env: dict[str, str], world: World, bad: float
) -> None:
    """It counts as lost input: zeros until the next valid command; and it is counted."""
    with run_gate(GATE, ros_env):
        world.meet()
        world.release()
        before = len(world.heard)
        world.wish(0.3, y=bad)
        world.hear_after(before)
        assert world.last == STILL
        world.peer.until(
            lambda: "a NaN or an infinite number" in world.status.get("refused_last", "")
        )
        assert world.status["refused"] == "1"
        world.wish_until(0.25, lambda: world.last == (0.25, 0.0, 0.0))
    assert not [data for _, data in world.heard if not math.isfinite(world.speeds(data)[1])]


@pytest.mark.parametrize(
    "data", [slow(b""), b"\x00\x01\x00\x00", slow(b"\x00\x01\x00\x00" + bytes(17))]
)
def test_undecodable_command_is_refused(
    run_gate: RunGate, ros_env: dict[str, str], world: World, data: bytes
) -> None:
    """Invalid bytes affect only that command."""
    with run_gate(GATE, ros_env):
        world.meet()
        world.release()
        before = len(world.heard)
        world.wish_bytes(data)
        world.hear_after(before)
        assert world.last == STILL
        world.wish_until(0.25, lambda: world.last == (0.25, 0.0, 0.0))


def test_silence_of_input_or_heartbeat_gives_zero(
    run_gate: RunGate, ros_env: dict[str, str], world: World
) -> None:
    """The zero needs no message; at which time it comes is asked in tests/faults/virtual."""
    with run_gate(GATE, ros_env):
        world.meet()
        world.release()
        world.peer.until(lambda: world.last == STILL)

        world.release()
        world.beating.cancel()
        world.wish_until(0.3, lambda: world.last == STILL)
        world.stop(False)
        world.mode(0)

        def passes() -> bool:
            world.live()
            return world.last == (0.3, 0.0, 0.0)

        world.wish_until(0.3, passes)


def test_status_reports_output_and_reason(
    run_gate: RunGate, ros_env: dict[str, str], world: World
) -> None:
    """One status on /diagnostics; tests/faults/virtual asks when, and since when a line applies."""
    with run_gate(GATE, ros_env) as process:
        world.meet()
        world.release()
        world.wish_until(0.3, lambda: world.status.get("message") == "commands pass")
        assert world.status["level"] == "0"
        world.stop(True)
        reason = "stop: zero (gates.deros:24)"
        world.wish_until(0.3, lambda: world.status["message"] == reason)
        assert world.status["level"] == "1"
        assert world.status["name"] == f"/{GATE}"
        seen = world.reports
        world.wish_until(0.3, lambda: world.reports >= seen + 2)
        process.send_signal(signal.SIGTERM)
        output, _ = process.communicate(timeout=LIMIT)
    assert process.returncode == 0
    assert reason in output
    assert "Traceback" not in output


def test_second_instance_does_not_run(
    run_gate: RunGate, ros_env: dict[str, str], world: World
) -> None:
    """It exits at once and names the first, which continues."""
    with run_gate(GATE, ros_env) as first:
        world.meet()
        with run_gate(GATE, ros_env) as second:
            output, _ = second.communicate(timeout=LIMIT)
        assert second.returncode == 1
        assert str(first.pid) in output
        assert "Traceback" not in output
        world.release()


@pytest.mark.slow
def test_simulated_time_pauses_and_steps_back(
    run_gate: RunGate, ros_env: dict[str, str], world: World
) -> None:
    """On request deadlines follow /clock; after a step back everything must be received again."""
    from rosgraph_msgs.msg import Clock  # type: ignore[import-untyped]

    clock = world.peer.node.create_publisher(Clock, "/clock", 10)
    world.beating.cancel()
    seconds = 1000.0

    def tick(step: float) -> None:
        nonlocal seconds
        seconds += step
        message: Any = Clock()
        message.clock.sec, message.clock.nanosec = int(seconds), int(seconds % 1 * 1e9)
        clock.publish(message)

    def ticking(step: float, condition: Any, say: Any = world.live) -> None:
        """Advance time no faster than the gate follows, so that it misses no message."""
        answers, due = -1, 0.0

        def once() -> Any:
            nonlocal answers, due
            if len(world.heard) > answers or time.monotonic() > due:
                answers, due = len(world.heard), time.monotonic() + 0.05
                tick(step)
                say()
                world.wish(0.3)
            return condition()

        world.peer.until(once)

    with run_gate(GATE, ros_env, *ON_CLOCK):
        world.peer.until(clock.get_subscription_count)
        ticking(0.01, lambda: world.heard)
        world.stop(False)
        world.mode(0)
        ticking(0.01, lambda: world.last == (0.3, 0.0, 0.0))
        passed = len(world.heard)
        world.peer.until(lambda: world.silence(1.0) == 0)  # time is paused, so nothing is lost
        assert {world.speeds(data) for _, data in world.heard[passed:]} <= {(0.3, 0.0, 0.0)}
        tick(-500.0)
        world.peer.until(lambda: world.last == STILL)
        unknown = len(world.heard)
        ticking(0.01, lambda: len(world.heard) >= unknown + 10, world.beat)
        assert {world.speeds(data) for _, data in world.heard[unknown:]} == {STILL}
        world.stop(False)
        world.mode(0)
        ticking(0.01, lambda: world.last == (0.3, 0.0, 0.0))
        tick(0.6)
        world.peer.until(lambda: world.last == STILL)


@pytest.mark.slow
@pytest.mark.parametrize("rate", [0.0, 0.05])
def test_losses_are_measured_on_the_steady_clock(
    run_gate: RunGate, ros_env: dict[str, str], world: World, rate: float
) -> None:
    """With a paused or slow simulated clock, silence is detected all the same, and zeros follow."""
    from rosgraph_msgs.msg import Clock

    clock = world.peer.node.create_publisher(Clock, "/clock", 10)
    with run_gate(GATE, ros_env, "use_sim_time:=true"):
        world.peer.until(clock.get_subscription_count)
        started = time.monotonic()
        ticking = Clock()

        def tick() -> None:
            passed = 1000.0 + rate * (time.monotonic() - started)
            ticking.clock.sec, ticking.clock.nanosec = int(passed), int(passed % 1 * 1e9)
            clock.publish(ticking)

        world.peer.node.create_timer(0.02, tick)
        world.meet()
        world.release()
        world.beating.cancel()
        world.wish_until(0.3, lambda: world.last == STILL)
        before = len(world.heard)
        world.peer.until(lambda: len(world.heard) > before + 5)


@pytest.mark.slow
@pytest.mark.parametrize("chosen", [False, True])
def test_clock_source_cannot_change_at_run_time(
    run_gate: RunGate, ros_env: dict[str, str], world: World, chosen: bool
) -> None:
    """The change is rejected with a reason, and the zeros continue."""
    with run_gate(GATE, ros_env, f"use_sim_time:={str(chosen).lower()}"):
        world.peer.until(lambda: world.status)
        (result,) = set_parameter(world.peer, GATE, use_sim_time=not chosen)
        assert not result.successful
        assert "use_sim_time cannot change" in result.reason
        seen = world.reports
        world.peer.until(lambda: world.reports > seen + 1)


def test_integer_gate_needs_no_nan_check(
    run_gate: RunGate, ros_env: dict[str, str], ros_peer: Peer
) -> None:
    """Int32: commands pass without NaN checks, and zeros are periodic without a loss line."""
    from rclpy.qos import DurabilityPolicy, QoSProfile
    from std_msgs.msg import Bool, Int32

    heard: list[int] = []
    kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    wish = ros_peer.node.create_publisher(Int32, "/lamp/goal", 10)
    stop = ros_peer.node.create_publisher(Bool, "/stop", kept)
    ros_peer.node.create_subscription(
        Int32, "/lamp/command", lambda message: heard.append(message.data), 10
    )
    with run_gate("lamp_command_gate", ros_env) as process:
        ros_peer.until(lambda: wish.get_subscription_count() and stop.get_subscription_count())
        ros_peer.until(lambda: heard)

        def wished() -> bool:
            stop.publish(Bool(data=False))  # a safety node repeats it too
            wish.publish(Int32(data=7))
            return heard[-1] == 7

        ros_peer.until(wished)
        stop.publish(Bool(data=True))
        ros_peer.until(lambda: heard[-2:] == [0, 0])
        process.send_signal(signal.SIGINT)
        output, _ = process.communicate(timeout=LIMIT)
    assert process.returncode == 0
    assert "Traceback" not in output


def test_zero_keeps_the_shape_of_the_command(
    run_gate: RunGate, ros_env: dict[str, str], ros_peer: Peer
) -> None:
    """JointTrajectory: names, frame and lengths stay, numbers are zero, the stamp is current."""
    from rclpy.qos import DurabilityPolicy, QoSProfile
    from std_msgs.msg import Bool, UInt8, UInt64
    from trajectory_msgs.msg import (  # type: ignore[import-untyped]
        JointTrajectory,
        JointTrajectoryPoint,
    )

    heard: list[Any] = []
    node = ros_peer.node
    kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    wish = node.create_publisher(JointTrajectory, "/arm/goal", 10)
    stop = node.create_publisher(Bool, "/stop", kept)
    mode = node.create_publisher(UInt8, "/mode", kept)
    heartbeat = node.create_publisher(UInt64, f"/{SAFETY_NODE}/heartbeat", 10)
    states = {stop: Bool(data=False), mode: UInt8(data=0)}
    beats = itertools.count(1)

    def live() -> None:
        heartbeat.publish(UInt64(data=next(beats)))
        for publisher, state in states.items():
            publisher.publish(state)

    node.create_subscription(JointTrajectory, "/arm/command", heard.append, 10)
    point = JointTrajectoryPoint(positions=[1.0, 2.0], velocities=[0.8, -3.0])
    message = JointTrajectory(joint_names=["lift", "turn"], points=[point])
    message.header.frame_id = "arm"
    message.header.stamp.sec = 5
    with run_gate("arm_command_gate", ros_env):
        # Without a safety node it publishes again and again; with one, nothing before a command.
        ros_peer.until(lambda: heard and wish.get_subscription_count())
        node.create_timer(0.05, live)

        def wished() -> bool:
            wish.publish(message)
            return bool(heard[-1] == message)

        ros_peer.until(wished)
        states[mode] = UInt8(data=1)
        ros_peer.until(lambda: list(heard[-1].points[0].velocities) == [0.5, -0.5])
        states |= {mode: UInt8(data=0), stop: Bool(data=True)}
        ros_peer.until(lambda: heard[-1].points and not any(heard[-1].points[0].velocities))
    zero = heard[-1]
    assert zero.joint_names == ["lift", "turn"]
    assert zero.header.frame_id == "arm"
    assert zero.header.stamp.sec > 5
    assert list(zero.points[0].positions) == [0.0, 0.0]
