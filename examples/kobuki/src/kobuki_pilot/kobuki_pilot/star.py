"""The way along the points of a star, round and round, with a pause by turns."""

from __future__ import annotations

from dataclasses import dataclass
import math

RADIUS, POINTS = 0.8, 5
"""Distance, in m, of the star's points from its middle, and how many there are."""

REACHED = 0.1
"""Distance, in m, at which a point is reached."""

TURN_GAIN, MOST_TURN = 2.0, 1.0
"""Turn rate for each radian that the heading is off, in 1/s, and its limit in rad/s."""

AHEAD = 0.5
"""Difference of heading, in rad, above which it turns on the spot."""

PAUSE, DRIVE = 2.0, 8.0
"""Times, in s, for which it stands and for which it drives, by turns."""


def stands(since_start: float) -> bool:
    """Return whether it pauses, at first: what is between it and the wheels waits for that."""
    return since_start % (PAUSE + DRIVE) < PAUSE


@dataclass
class Star:
    """A star of five points around where the robot started, drawn in one stroke."""

    cruise_speed: float
    _next: int = 0

    def command(self, x: float, y: float, yaw: float) -> tuple[float, float]:
        """Return speed (m/s) and turn rate (rad/s) from this pose (m, rad)."""
        goal = self._point()
        if math.dist((x, y), goal) < REACHED:
            self._next = (self._next + 1) % POINTS
            goal = self._point()
        off = math.remainder(math.atan2(goal[1] - y, goal[0] - x) - yaw, math.tau)
        turn = max(-MOST_TURN, min(MOST_TURN, TURN_GAIN * off))
        return self.cruise_speed if abs(off) < AHEAD else 0.0, turn

    def _point(self) -> tuple[float, float]:
        angle = 2 * self._next * math.tau / POINTS
        return RADIUS * math.cos(angle), RADIUS * math.sin(angle)
