"""A running gate with a ramp, a standing limit, and lines that hold, send and fall silent."""

from __future__ import annotations

from typing import Any

import pytest

from tests.support.gate_nodes import STILL, World
from tests.support.gate_runners import RunGate
from tests.support.ros import Peer

pytestmark = pytest.mark.ros
CRANE = "crane_command_gate"


@pytest.fixture
def crane(ros_peer: Peer) -> World:
    """Return what is around the gate of the crane."""
    return World(ros_peer, "/crane/goal", "/crane/command")


def drive(world: World) -> None:
    """Reset the gate, as nothing calls for a stop any more, and command zero, then a speed."""
    from std_srvs.srv import Trigger

    client: Any = world.peer.node.create_client(Trigger, f"/{CRANE}/reset")
    world.meet()
    world.stop(False)
    world.mode(0)
    world.peer.until(client.service_is_ready)
    call = client.call_async(Trigger.Request())

    def is_reset() -> bool:
        nonlocal call
        world.wish(0.0)
        if not call.done():
            return False
        if not call.result().success:
            call = client.call_async(Trigger.Request())
            return False
        return True

    world.peer.until(is_reset)
    world.wish_until(0.0, lambda: world.last == STILL)
    world.wish_until(3.0, lambda: world.last == (1.0, 0.0, 0.25), turn=0.25)


def until_silent(world: World, line: str) -> None:
    """Command a speed until a line applies and the gate has published nothing for two reports."""
    told: list[tuple[int, int]] = []  # the reports so far, and what was heard by then

    def is_silent() -> bool:
        if line in world.status.get("message", "") and (not told or told[-1][0] < world.reports):
            told.append((world.reports, len(world.heard)))
        return len(told) > 2 and len({heard for _, heard in told[-3:]}) == 1

    world.wish_until(0.5, is_silent)


def test_ramp_begins_at_the_limit_and_ends_at_zero(
    run_gate: RunGate, ros_env: dict[str, str], crane: World
) -> None:
    """The standing limit holds first; then the speed only falls, though the wish goes on."""
    with run_gate(CRANE, ros_env):
        drive(crane)
        before = len(crane.heard)
        crane.stop(True)
        crane.wish_until(3.0, lambda: crane.last == STILL, turn=0.25)
        speeds = [crane.speeds(data) for _, data in crane.heard[before:]]
    falling = [x for x, _, _ in speeds]
    assert falling == sorted(falling, reverse=True)
    assert any(0.0 < x < 1.0 for x in falling)
    turning = [turn for _, _, turn in speeds]
    assert turning == sorted(turning, reverse=True)


def test_command_is_held_and_silence_is_silent(
    run_gate: RunGate, ros_env: dict[str, str], crane: World
) -> None:
    """A held command comes again and again; after a silence there is none to hold."""
    with run_gate(CRANE, ros_env):
        drive(crane)
        crane.mode(1)
        crane.peer.until(lambda: "slow: hold" in crane.status.get("message", ""))
        before = len(crane.heard)
        crane.wish_until(0.5, lambda: len(crane.heard) > before + 5)
        assert {crane.speeds(data) for _, data in crane.heard[before:]} == {(1.0, 0.0, 0.25)}
        crane.mode(2)
        until_silent(crane, "slower: silence")
        crane.mode(1)
        until_silent(crane, "slow: hold")


def test_silence_of_the_controller_sends_what_the_line_says(
    run_gate: RunGate, ros_env: dict[str, str], crane: World
) -> None:
    """The load is let down; a command of just that, like zero, lets others pass again."""
    from geometry_msgs.msg import Twist
    from rclpy.serialization import deserialize_message, serialize_message

    def lowering() -> float:
        message: Any = deserialize_message(crane.heard[-1][1], Twist)
        return float(message.linear.z)

    with run_gate(CRANE, ros_env):
        drive(crane)
        crane.peer.until(lambda: lowering() == -0.1)
        assert crane.last == STILL
        command = Twist()
        command.linear.z = -0.1
        data = serialize_message(command)

        def is_driving() -> bool:
            crane.wish_bytes(data)
            crane.wish(0.5)
            return crane.last == (0.5, 0.0, 0.0)

        crane.peer.until(is_driving)
