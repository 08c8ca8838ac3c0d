"""The way from waypoint to waypoint."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
import math

REACHED = 0.1
"""Distance, in m, at which a waypoint is reached."""

TURN_GAIN, MOST_TURN = 2.0, 1.0
"""Turn rate for each radian that the heading is off, in 1/s, and its limit in rad/s."""


@dataclass
class Route:
    """Points in m, which are driven to one after the other, round and round."""

    points: Sequence[tuple[float, float]]
    cruise_speed: float
    _next: int = 0

    def command(self, x: float, y: float, yaw: float) -> tuple[float, float]:
        """Return speed (m/s) and turn rate (rad/s) from this pose (m, rad)."""
        goal = self.points[self._next]
        if math.dist((x, y), goal) < REACHED:
            self._next = (self._next + 1) % len(self.points)
            goal = self.points[self._next]
        off = math.remainder(math.atan2(goal[1] - y, goal[0] - x) - yaw, math.tau)
        turn = max(-MOST_TURN, min(MOST_TURN, TURN_GAIN * off))
        return self.cruise_speed * max(0.0, math.cos(off)), turn


def pairs(numbers: Sequence[float]) -> list[tuple[float, float]]:
    """
    Return the points that a list ``x, y, x, y …`` holds.

    A list that holds no point, half a point, or a number that is not finite is a ``ValueError``.
    """
    if not numbers or len(numbers) % 2 or not all(map(math.isfinite, numbers)):
        raise ValueError('waypoints has to hold x and y of each point, all of them finite')
    return list(zip(numbers[::2], numbers[1::2], strict=True))
