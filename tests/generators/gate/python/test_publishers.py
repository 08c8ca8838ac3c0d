"""Publishers that a gate obeys, in each language: only the safety node."""

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
    """Return a function that calls others in sequence."""

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


def stop_permanently(world: World) -> None:
    """Have the safety node stop the robot permanently, and wait for it."""
    world.stop(True)
    world.wish_until(0.3, lambda: world.last == STILL)


@pytest.mark.usefixtures("gate")
def test_foreign_inactive_state_does_not_release(world: World, ros_env: dict[str, str]) -> None:
    """Latched or repeated, no command passes while the safety node publishes active."""
    stop_permanently(world)
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
def test_incompatible_drive_is_a_fault(world: World) -> None:
    """A drive that requests more QoS than the gate offers never moves; the fault says why."""
    from geometry_msgs.msg import Twist
    from rclpy.duration import Duration
    from rclpy.qos import QoSProfile

    asked = QoSProfile(depth=1, deadline=Duration(seconds=1))
    subscription = world.peer.node.create_subscription(Twist, "/cmd_vel", lambda _: None, asked)
    world.until_fault("/test_peer asks for a QoS on it that is not offered")
    world.peer.node.destroy_subscription(subscription)
    world.wish_until(0.3, lambda: "asks for a QoS" not in world.status["message"])


@pytest.mark.usefixtures("gate")
@pytest.mark.slow
def test_short_lived_foreign_publisher_does_not_release(
    world: World, ros_env: dict[str, str]
) -> None:
    """However briefly it exists, its state does not count as the safety node's."""
    stop_permanently(world)
    before = len(world.heard)
    for _ in range(5):
        with Stranger(ros_env) as stranger:
            publisher = stranger.stop(False)
            world.wish_until(0.3, publisher.get_subscription_count)
            publisher.wait_for_all_acked()
    world.assert_stands(0.5)
    assert {world.speeds(data) for _, data in world.heard[before:]} == {STILL}


@pytest.mark.slow
def test_foreign_publisher_that_ends_during_a_hang_does_not_release(
    gate: Popen[str], world: World, ros_env: dict[str, str]
) -> None:
    """Messages received meanwhile are handled in any order; none of them counts."""
    stop_permanently(world)
    with Stranger(ros_env) as stranger:
        publisher = stranger.stop(True)
        world.wish_until(0.3, publisher.get_subscription_count)
        before = len(world.heard)
        gate.send_signal(signal.SIGSTOP)
        stranger.stop(False)
    gate.send_signal(signal.SIGCONT)
    world.wish_until(0.3, lambda: len(world.heard) > before + 10)
    assert {world.speeds(data) for _, data in world.heard[before:]} == {STILL}


@pytest.mark.slow
@pytest.mark.usefixtures("gate")
def test_foreign_active_state_stops(world: World, ros_env: dict[str, str]) -> None:
    """It counts until its publisher is gone, whatever the safety node publishes."""
    with Stranger(ros_env) as stranger:
        stranger.stop(True)
        world.wish_until(0.3, lambda: world.last == STILL)
        world.assert_stands(1.0)
    world.until_driving()


@pytest.mark.slow
@pytest.mark.usefixtures("gate")
def test_second_heartbeat_publisher_counts_as_a_loss(world: World, ros_env: dict[str, str]) -> None:
    """The safety node cannot be identified; when the second is gone, the gate continues."""
    with Stranger(ros_env) as stranger:
        publisher = stranger.heartbeat(1)
        world.wish_until(0.3, publisher.get_subscription_count)
        world.wish_until(0.3, lambda: world.last == STILL)
        world.assert_stands(1.5)
        world.until_fault("publishers where one is expected: /stranger, /test_peer")
    world.until_driving()


@pytest.mark.slow
@pytest.mark.usefixtures("gate")
def test_foreign_heartbeat_does_not_replace_a_dead_safety_node(
    world: World, ros_env: dict[str, str]
) -> None:
    """A second heartbeat next to the safety node's releases nothing when that has died."""
    with Stranger(ros_env) as stranger:
        world.beating.callback = in_turn(world.live, lambda: stranger.heartbeat(1))
        publisher = stranger.heartbeat(1)
        world.wish_until(0.3, publisher.get_subscription_count)
        world.beating.callback = lambda: stranger.heartbeat(1)
        world.wish_for(2 * LOST_HEARTBEAT)
        world.assert_stands(1.0)


@pytest.mark.slow
def test_constant_heartbeat_releases_nothing(
    run_gate: RunGate, ros_env: dict[str, str], world: World
) -> None:
    """The counter must advance; a message alone is not a sign of life."""

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


@pytest.mark.slow
def test_state_of_another_node_than_the_heartbeat_is_ignored(
    run_gate: RunGate, ros_env: dict[str, str], world: World
) -> None:
    """It is the only publisher of the topic and inactive, but nothing passes."""
    world.peer.node.destroy_publisher(world.stop_publisher)
    with Stranger(ros_env) as stranger, run_gate(GATE, ros_env):
        stranger.stop(False)
        world.mode(0)
        world.peer.until(lambda: world.heard and world.status)
        world.beating.callback = in_turn(world.live, lambda: stranger.stop(False))
        world.assert_stands(1.5)
        world.until_fault("/stranger publishes it, not the safety node /test_peer")
    world.beating.callback = world.live


@pytest.mark.slow
@pytest.mark.usefixtures("gate")
def test_second_command_publisher_is_a_fault(world: World, ros_env: dict[str, str]) -> None:
    """It is reported; the gate cannot know which one is right, so both pass."""
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


@pytest.mark.slow
@pytest.mark.usefixtures("gate")
def test_publisher_that_bypasses_the_gate_is_a_fault(world: World, ros_env: dict[str, str]) -> None:
    """The gate cannot block it, but reports it; it does not subscribe to its target."""
    subscriptions = world.peer.node.get_subscriptions_info_by_topic("/cmd_vel")
    assert [each.node_name for each in subscriptions] == ["test_peer"]
    with Stranger(ros_env) as stranger:
        stranger.say("/cmd_vel", twist(math.nan))
        world.until_fault("published past the gate: /stranger")
        assert world.status["refused"] == "0"
    world.wish_until(0.3, lambda: "stranger" not in world.status["message"])


@pytest.mark.slow
@pytest.mark.usefixtures("gate")
def test_second_gate_without_a_shared_lock_ends(
    run_gate: RunGate, world: World, ros_env: dict[str, str], tmp_path: Path
) -> None:
    """It finds the first in the graph, as on another machine, and exits; commands keep passing."""
    (tmp_path / "elsewhere").mkdir()
    with run_gate(GATE, {**ros_env, "TMPDIR": str(tmp_path / "elsewhere")}) as second:
        world.wish_until(0.3, lambda: second.poll() is not None)
        output, _ = second.communicate(timeout=LIMIT)
    assert second.returncode == 1
    assert f"a second gate of the name /{GATE} publishes on it; this one started last" in output
    world.until_driving()


@pytest.mark.slow
@pytest.mark.usefixtures("gate")
def test_second_gate_that_stays_is_a_fault(world: World, ros_env: dict[str, str]) -> None:
    """An older gate may not exit; both report it."""
    from geometry_msgs.msg import Twist

    world.wish_for(5.0)  # the gate is no longer new
    with Stranger(ros_env, GATE) as second:
        second.node.create_publisher(Twist, "/cmd_vel", 10)
        world.until_fault(f"a second gate of the name /{GATE} publishes on it")


@pytest.mark.slow
def test_gate_without_a_heartbeat_obeys_only_a_sole_publisher(
    run_gate: RunGate, ros_env: dict[str, str], world: World
) -> None:
    """It cannot know which of two is the safety node, so it obeys neither."""
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
