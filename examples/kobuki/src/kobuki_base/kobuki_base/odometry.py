"""Where the robot is, by what its encoders have counted since it was switched on."""

from __future__ import annotations

from dataclasses import dataclass
import math

from kobuki_base.base import COUNTER, TICKS_PER_TURN, WHEEL_DISTANCE, WHEEL_RADIUS

WAY = math.tau * WHEEL_RADIUS / TICKS_PER_TURN
"""Way of a wheel, in m, for each tick."""


def step(before: int, after: int) -> int:
    """Return the steps between two states of a counter of 16 bits, which may have begun anew."""
    return (after - before + COUNTER // 2) % COUNTER - COUNTER // 2


@dataclass
class DeadReckoning:
    """Pose in m and rad, speeds in m/s and rad/s."""

    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0
    forward: float = 0.0
    turn: float = 0.0
    _before: tuple[int, int, int] | None = None

    def count(self, left: int, right: int, stamp: int) -> bool:
        """
        Take the encoders' states at a time stamp in ms; return whether time has passed.

        After more than a minute, the stamps have begun anew unseen.
        """
        before, now = self._before, (left, right, stamp)
        if before is None:
            self._before = now
            return False
        duration = (stamp - before[2]) % COUNTER / 1000.0
        if duration == 0.0:
            return False
        self._before = now
        lefts, rights = WAY * step(before[0], left), WAY * step(before[1], right)
        way, turned = (lefts + rights) / 2, (rights - lefts) / WHEEL_DISTANCE
        heading = self.yaw + turned / 2
        self.x += way * math.cos(heading)
        self.y += way * math.sin(heading)
        self.yaw = math.remainder(self.yaw + turned, math.tau)
        self.forward, self.turn = way / duration, turned / duration
        return True
