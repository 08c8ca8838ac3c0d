"""A running gate with two sources: which one passes, what it reports, and what a refusal does."""

from __future__ import annotations

from typing import Any

import pytest

from tests.support.gate_nodes import STILL, World
from tests.support.gate_runners import RunGate
from tests.support.ros import Peer

pytestmark = pytest.mark.ros
BOAT = "boat_command_gate"
FAST, SLOW = (0.75, 0.0, 0.0), (0.25, 0.0, 0.0)


class Boat(World):
    """The surroundings of the gate of a boat: the world's wishes are those of the planner."""

    def __init__(self, peer: Peer) -> None:
        """Add the joystick."""
        from geometry_msgs.msg import Twist

        super().__init__(peer, "/boat/plan", "/boat/command")
        self._twist = Twist
        self._joystick = peer.node.create_publisher(Twist, "/boat/joy", 10)

    def steer(self, x: float) -> None:
        """Command a speed with the joystick."""
        message = self._twist()
        message.linear.x = x
        self._joystick.publish(message)

    def meet(self) -> None:
        """Wait until all ends know each other, and nothing is active."""
        ends = (self._wish, self._joystick, self.stop_publisher, self.heartbeat)
        self.peer.until(lambda: self.heard and all(e.get_subscription_count() for e in ends))
        self.stop(False)

    @property
    def source(self) -> str:
        """The source that the gate reports."""
        return self.status.get("source", "")


@pytest.fixture
def boat(ros_peer: Peer) -> Boat:
    """Return what is around the gate of the boat."""
    return Boat(ros_peer)


def plan_until(boat: Boat, x: float, condition: Any) -> None:
    """Plan a speed until something holds, after a zero that lets the planner begin."""
    boat.wish_until(0.0, lambda: boat.status.get("message") == "commands of /boat/plan pass")
    boat.wish_until(x, condition)


def test_joystick_beats_the_planner_until_it_is_let_go(
    run_gate: RunGate, ros_env: dict[str, str], boat: Boat
) -> None:
    """Then the planner, which still commands full speed, has to command zero once."""
    with run_gate(BOAT, ros_env):
        boat.meet()
        plan_until(boat, FAST[0], lambda: boat.last == FAST)

        def is_steered() -> bool:
            boat.steer(SLOW[0])
            return boat.source == "/boat/joy" and boat.last == SLOW

        boat.wish_until(FAST[0], is_steered)
        assert boat.status["message"] == "commands of /boat/joy pass"
        begun = len(boat.heard)
        boat.wish_until(FAST[0], lambda: boat.source == "/boat/plan" and boat.last == STILL)
        speeds = [boat.speeds(data) for _, data in boat.heard[begun:]]
        assert set(speeds) <= {SLOW, STILL}
        boat.assert_stands(0.5)
        assert "waits for a zero command" in boat.status["message"]
        plan_until(boat, FAST[0], lambda: boat.last == FAST)
        boat.peer.until(lambda: boat.source == "none")
        boat.peer.until(lambda: boat.last == STILL)


def test_refused_command_of_the_joystick_does_not_hand_over(
    run_gate: RunGate, ros_env: dict[str, str], boat: Boat
) -> None:
    """NaN from a joystick stops the boat, whatever the planner commands meanwhile."""
    with run_gate(BOAT, ros_env):
        boat.meet()
        plan_until(boat, FAST[0], lambda: boat.last == FAST)

        def is_refused() -> bool:
            boat.steer(float("nan"))
            return boat.source == "none" and boat.last == STILL

        boat.wish_until(FAST[0], is_refused)
        begun = len(boat.heard)

        def is_refused_again() -> bool:
            boat.steer(float("nan"))
            return len(boat.heard) > begun + 10

        boat.wish_until(FAST[0], is_refused_again)
        assert {boat.speeds(data) for _, data in boat.heard[begun:]} == {STILL}
        assert "on /boat/joy" in boat.status["refused_last"]
