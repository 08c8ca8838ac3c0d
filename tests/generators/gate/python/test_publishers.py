"""Whom a gate obeys, in each language: the safety node alone, whoever else publishes."""

from __future__ import annotations

import math
import signal
from collections.abc import Callable
from pathlib import Path
from subprocess import Popen
from typing import Any

import pytest

from tests.support.gate_nodes import GATE, STILL, Stranger, World
from tests.support.gate_runners import RunGate
from tests.support.ros import LIMIT

pytestmark = pytest.mark.ros

LOST_HEARTBEAT = 0.3


def in_turn(*callbacks: Callable[[], object]) -> Callable[[], None]:
    """Return a function that calls others, one after the other."""

    def call() -> None:
        for callback in callbacks:
            callback()

    return call


def twist(speed: float) -> Any:
    """Return a command."""
    from geometry_msgs.msg import Twist

    message = Twist()
    message.linear.x = speed
    return message


def stop_for_good(world: World) -> None:
    """Have the safety node stop the robot, and see it stand."""
    world.stop(True)
    world.wish_until(0.3, lambda: world.last == STILL)


@pytest.mark.usefixtures("gate")
def test_a_foreign_inactive_state_frees_nobody(world: World, ros_env: dict[str, str]) -> None:
    """Latched or repeated, not one command passes while the safety node says active."""
    stop_for_good(world)
    with Stranger(ros_env) as stranger:
        publisher = stranger.stop(False)
        world.wish_until(0.3, publisher.get_subscription_count)
        world.assert_stands(1.0)
        world.beating.callback = in_turn(world.beat, lambda: stranger.stop(False))
        world.assert_stands(2.0)
        world.until_fault("publishers where one is expected: /stranger, /test_peer")
    world.beating.callback = world.live
    world.assert_stands(0.5)
    world.stop(False)
    world.until_driving()


@pytest.mark.usefixtures("gate")
def test_a_drive_that_gets_nothing_is_a_fault(world: World) -> None:
    """One that asks for more than the gate offers stands for ever; the fault says why."""
    from geometry_msgs.msg import Twist
    from rclpy.duration import Duration
    from rclpy.qos import QoSProfile

    asked = QoSProfile(depth=1, deadline=Duration(seconds=1))
    subscription = world.peer.node.create_subscription(Twist, "/cmd_vel", lambda _: None, asked)
    world.until_fault("/test_peer asks for a QoS on it that is not offered")
    world.peer.node.destroy_subscription(subscription)
    world.wish_until(0.3, lambda: "asks for a QoS" not in world.status["message"])


@pytest.mark.usefixtures("gate")
def test_a_stranger_that_comes_speaks_and_goes_frees_nobody(
    world: World, ros_env: dict[str, str]
) -> None:
    """However short its stay is, its word is not taken for the safety node's."""
    stop_for_good(world)
    before = len(world.heard)
    for _ in range(5):
        with Stranger(ros_env) as stranger:
            publisher = stranger.stop(False)
            world.wish_until(0.3, publisher.get_subscription_count)
            publisher.wait_for_all_acked()
    world.assert_stands(0.5)
    assert {world.speeds(data) for _, data in world.heard[before:]} == {STILL}


def test_a_stranger_that_goes_while_the_gate_hangs_frees_nobody(
    gate: Popen[str], world: World, ros_env: dict[str, str]
) -> None:
    """What has come meanwhile is dealt with in whatever order; nothing of it is believed."""
    stop_for_good(world)
    with Stranger(ros_env) as stranger:
        publisher = stranger.stop(True)
        world.wish_until(0.3, publisher.get_subscription_count)
        before = len(world.heard)
        gate.send_signal(signal.SIGSTOP)
        stranger.stop(False)
    gate.send_signal(signal.SIGCONT)
    world.wish_until(0.3, lambda: len(world.heard) > before + 10)
    assert {world.speeds(data) for _, data in world.heard[before:]} == {STILL}


@pytest.mark.usefixtures("gate")
def test_a_foreign_active_state_stops(world: World, ros_env: dict[str, str]) -> None:
    """It counts until the stranger is gone, however often the safety node says the contrary."""
    with Stranger(ros_env) as stranger:
        stranger.stop(True)
        world.wish_until(0.3, lambda: world.last == STILL)
        world.assert_stands(1.0)
    world.until_driving()


@pytest.mark.usefixtures("gate")
def test_a_second_heartbeat_is_a_lost_one(world: World, ros_env: dict[str, str]) -> None:
    """Nobody can tell which of the two is the safety node; with the second gone it goes on."""
    with Stranger(ros_env) as stranger:
        publisher = stranger.heartbeat(1)
        world.wish_until(0.3, publisher.get_subscription_count)
        world.wish_until(0.3, lambda: world.last == STILL)
        world.assert_stands(1.5)
        world.until_fault("publishers where one is expected: /stranger, /test_peer")
    world.until_driving()


@pytest.mark.usefixtures("gate")
def test_a_foreign_heartbeat_keeps_no_dead_safety_node_alive(
    world: World, ros_env: dict[str, str]
) -> None:
    """A stranger that beats beside the safety node opens nothing when that has died."""
    with Stranger(ros_env) as stranger:
        world.beating.callback = in_turn(world.live, lambda: stranger.heartbeat(1))
        publisher = stranger.heartbeat(1)
        world.wish_until(0.3, publisher.get_subscription_count)
        world.beating.callback = lambda: stranger.heartbeat(1)
        world.wish_for(2 * LOST_HEARTBEAT)
        world.assert_stands(1.0)


def test_a_constant_heartbeat_opens_nothing(
    run_gate: RunGate, ros_env: dict[str, str], world: World
) -> None:
    """A message that comes is no sign of life; a counter that advances is."""

    def same_count() -> None:
        world.beats = 0

    world.beating.callback = in_turn(same_count, world.live)
    with run_gate(GATE, ros_env):
        world.meet()
        world.stop(False)
        world.mode(0)
        world.assert_stands(2.0)
        world.beating.callback = world.live
        world.until_driving()


def test_a_state_of_another_node_than_the_heartbeat_is_not_obeyed(
    run_gate: RunGate, ros_env: dict[str, str], world: World
) -> None:
    """Though it is the only publisher of the topic: it says inactive, and nothing passes."""
    world.peer.node.destroy_publisher(world.stop_publisher)
    with Stranger(ros_env) as stranger, run_gate(GATE, ros_env):
        stranger.stop(False)
        world.mode(0)
        world.peer.until(lambda: world.heard and world.status)
        world.beating.callback = in_turn(world.live, lambda: stranger.stop(False))
        world.assert_stands(1.5)
        world.until_fault("/stranger publishes it, not the safety node /test_peer")
    world.beating.callback = world.live


@pytest.mark.usefixtures("gate")
def test_a_second_commander_is_a_fault(world: World, ros_env: dict[str, str]) -> None:
    """It is reported; which of the two is right, the gate cannot know, so both pass."""
    with Stranger(ros_env) as stranger:
        publisher = stranger.say("/cmd_vel_nav", twist(0.1))
        world.until_fault("2 publishers where one is expected: /stranger, /test_peer")
        before = len(world.heard)
        world.wish_until(0.3, publisher.get_subscription_count)
        world.wish_until(
            0.3,
            lambda: stranger.say("/cmd_vel_nav", twist(0.1)) and world.last == (0.1, 0.0, 0.0),
        )
        passed = {world.speeds(data) for _, data in world.heard[before:]}
    assert passed == {(0.3, 0.0, 0.0), (0.1, 0.0, 0.0)}


@pytest.mark.usefixtures("gate")
def test_a_publisher_past_the_gate_is_a_fault(world: World, ros_env: dict[str, str]) -> None:
    """The gate cannot hold it back, but it says so; it listens to nothing on its target."""
    found = world.peer.node.get_subscriptions_info_by_topic("/cmd_vel")
    assert [each.node_name for each in found] == ["test_peer"]
    with Stranger(ros_env) as stranger:
        stranger.say("/cmd_vel", twist(math.nan))
        world.until_fault("published past the gate: /stranger")
        assert world.status["refused"] == "0"
    world.wish_until(0.3, lambda: "stranger" not in world.status["message"])


@pytest.mark.usefixtures("gate")
def test_a_second_gate_that_shares_no_lock_ends(
    run_gate: RunGate, world: World, ros_env: dict[str, str], tmp_path: Path
) -> None:
    """It finds the first by the graph, as on another machine, and gives way; commands pass on."""
    (tmp_path / "elsewhere").mkdir()
    with run_gate(GATE, {**ros_env, "TMPDIR": str(tmp_path / "elsewhere")}) as second:
        world.wish_until(0.3, lambda: second.poll() is not None)
        output, _ = second.communicate(timeout=LIMIT)
    assert second.returncode == 1
    assert f"a second gate of the name /{GATE} publishes on it; this one started last" in output
    world.until_driving()


@pytest.mark.usefixtures("gate")
def test_a_second_gate_that_stays_is_a_fault(world: World, ros_env: dict[str, str]) -> None:
    """One that does not give way, as an older one does not, is reported by both."""
    from geometry_msgs.msg import Twist

    world.wish_for(5.0)  # the gate is not young any more
    with Stranger(ros_env, GATE) as second:
        second.node.create_publisher(Twist, "/cmd_vel", 10)
        world.until_fault(f"a second gate of the name /{GATE} publishes on it")


def test_a_gate_without_a_heartbeat_obeys_a_sole_publisher_only(
    run_gate: RunGate, ros_env: dict[str, str], world: World
) -> None:
    """It cannot know which of two is the safety node, so it believes neither."""
    from std_msgs.msg import Int32

    heard: list[int] = []
    wish = world.peer.node.create_publisher(Int32, "/lamp/goal", 10)
    world.peer.node.create_subscription(
        Int32, "/lamp/command", lambda message: heard.append(message.data), 10
    )

    def wish_until(condition: Callable[[], object]) -> None:
        def once() -> object:
            wish.publish(Int32(data=7))
            return condition()

        world.peer.until(once)

    with run_gate("lamp_command_gate", ros_env):
        world.stop(True)
        world.peer.until(lambda: heard and wish.get_subscription_count())
        with Stranger(ros_env) as stranger:
            publisher = stranger.stop(False)
            wish_until(publisher.get_subscription_count)
            world.beating.callback = in_turn(world.live, lambda: stranger.stop(False))
            wish_until(lambda: len(heard) > 4)
        world.beating.callback = world.live
        assert set(heard) == {0}
        world.stop(False)
        wish_until(lambda: heard[-1] == 7)
