"""A board in physics that keeps pace with real time, and fails when it is to."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from builtin_interfaces.msg import Time
from geometry_msgs.msg import Quaternion
from nav_msgs.msg import Odometry
from wheeled_physics.robot import PULSE, Robot

LONGEST = 0.1
"""Most seconds that are made up for at once: a simulation that was held up does not leap."""


class Board(Protocol):
    """What drives a robot in physics."""

    robot: Robot

    def advance(self, duration: float) -> None:
        """Let time pass, in s."""

    def fail(self, fault: str) -> None:
        """Let something fail for good."""

    def moves(self) -> bool:
        """Return whether the robot moves."""


class Experiment:
    """One board and one fault, some time after the robot has first moved."""

    def __init__(
        self, board: Board, fault: str, fault_after: float, now: float, say: Callable[[str], None]
    ) -> None:
        """
        Begin at a time of a clock that nobody sets, in s; ``none`` is no fault.

        What happens is said: that the robot moves, and the fault.
        """
        self._board = board
        self._fault = fault
        self._fault_after = fault_after
        self._say = say
        self._last = now
        self._due = 0.0
        self._moving_since: float | None = None
        self._failed = fault == 'none'

    def advance(self, now: float) -> None:
        """Let the physics catch up with the clock, in whole pulses."""
        self._due += min(now - self._last, LONGEST)
        self._last = now
        pulses = int(self._due / PULSE)
        if pulses > 0:
            self._due -= pulses * PULSE
            self._board.advance(pulses * PULSE)
        self._fail_in_time()

    def _fail_in_time(self) -> None:
        time = self._board.robot.time
        if self._moving_since is None and self._board.moves():
            self._moving_since = time
            self._say('the robot moves')
        since = self._moving_since
        if self._failed or since is None or time - since < self._fault_after:
            return
        self._failed = True
        self._board.fail(self._fault)
        self._say(f'fault: {self._fault}')


def truth(robot: Robot, stamp: Time) -> Odometry:
    """Return where a robot really is, how it stands, and how fast it is over the ground."""
    msg = Odometry()
    msg.header.stamp = stamp
    msg.header.frame_id, msg.child_frame_id = 'world', 'base_link'
    pose, twist = msg.pose.pose, msg.twist.twist
    pose.position.x, pose.position.y = robot.position()
    pose.position.z = robot.height()
    x, y, z, w = robot.orientation()
    pose.orientation = Quaternion(x=x, y=y, z=z, w=w)
    twist.linear.x, twist.angular.z = robot.speed(), robot.turn_rate()
    return msg
