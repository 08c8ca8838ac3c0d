"""The feeding mission: follow the lane at cruising speed, and bear with being stopped."""

from __future__ import annotations

from dataclasses import dataclass

LANE_GAIN = 0.4
"""Steering angle, in rad, for each metre beside the lane."""

HEADING_GAIN = 0.9
"""Steering angle, in rad, for each rad away from the lane's direction."""

LARGEST_STEERING = 0.5
"""Mechanical limit of the steering, in rad."""


@dataclass(frozen=True)
class Command:
    """Speed (m/s) and steering angle (rad) that the mission wants."""

    speed: float = 0.0
    steering: float = 0.0


@dataclass
class Mission:
    """
    Plans the next command; the lane is the x axis.

    The cruising speed is in m/s, the acceleration towards it in m/s^2.
    """

    cruise_speed: float
    acceleration: float
    speed: float = 0.0

    def plan(self, allowed: bool, offset: float, heading: float, duration: float) -> Command:
        """
        Return what to do now.

        After a stop the ramp begins anew from standstill: the mission never tries to catch up.

        Driving is allowed when the order, the mode and the safety node let the robot drive. The
        offset (m) is to the left of the lane, the heading (rad) is against the lane's, and the
        duration (s) is the time since the last call.
        """
        if not allowed:
            self.speed = 0.0
            return Command()
        self.speed = min(self.cruise_speed, self.speed + self.acceleration * duration)
        wanted = -LANE_GAIN * offset - HEADING_GAIN * heading
        return Command(self.speed, max(-LARGEST_STEERING, min(LARGEST_STEERING, wanted)))
