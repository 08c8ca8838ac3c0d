"""A differential drive: commands to wheels, wheels to pose."""

from __future__ import annotations

from dataclasses import dataclass
import math


@dataclass(frozen=True)
class Axle:
    """Two wheels: their radius and their distance, in m."""

    wheel_radius: float
    wheel_distance: float

    def wheels(self, forward: float, turn: float) -> tuple[float, float]:
        """Return the speeds (rad/s) of left and right wheel for a motion in m/s and rad/s."""
        aside = turn * self.wheel_distance / 2
        return (forward - aside) / self.wheel_radius, (forward + aside) / self.wheel_radius

    def motion(self, left: float, right: float) -> tuple[float, float]:
        """Return the motion, in m/s and rad/s, while the wheels turn at these speeds (rad/s)."""
        forward = (left + right) / 2 * self.wheel_radius
        return forward, (right - left) * self.wheel_radius / self.wheel_distance


@dataclass
class Pose:
    """Where the robot is, by its wheels: metres and radians from where it started."""

    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0

    def advance(self, forward: float, turn: float, duration: float) -> None:
        """Move at these speeds for ``duration`` seconds."""
        heading = self.yaw + turn * duration / 2
        self.x += forward * duration * math.cos(heading)
        self.y += forward * duration * math.sin(heading)
        self.yaw = math.remainder(self.yaw + turn * duration, math.tau)


def towards(setpoint: float, wanted: float, most: float) -> float:
    """Return the next setpoint: by ``most`` nearer to what is wanted, to zero at once."""
    if wanted == 0.0:
        return 0.0
    return setpoint + max(-most, min(most, wanted - setpoint))
