"""Who moves the pedal: the safety node's actions stand above the mission's commands."""

from __future__ import annotations

from dataclasses import dataclass

AUTOMATIC = 2
"""The position of the mode switch in which software moves the pedal."""


@dataclass(frozen=True)
class Limits:
    """Speeds in m/s, times in s."""

    top_speed: float
    low_speed: float
    command_timeout: float
    heartbeat_timeout: float


@dataclass
class Arbiter:
    """
    Keeps what was heard, with the time it was heard at, and decides on the pedal.

    Nothing heard in time means standing still: a lost mission and a lost safety node alike.
    """

    limits: Limits
    heartbeat_at: float
    command_at: float
    speed: float = 0.0
    steering: float = 0.0
    mode: int = 0
    stop: bool = True  # until the safety node has said otherwise
    low_speed: bool = False

    def command(self, speed: float, steering: float, now: float) -> None:
        """Take a command of the mission."""
        self.speed, self.steering, self.command_at = speed, steering, now

    def decide(self, now: float) -> tuple[float, float]:
        """Return pedal position (-1 to 1) and steering angle (rad)."""
        if self.stop or self.mode != AUTOMATIC:
            return 0.0, self.steering
        if now - self.heartbeat_at > self.limits.heartbeat_timeout:
            return 0.0, self.steering
        if now - self.command_at > self.limits.command_timeout:
            return 0.0, self.steering
        most = self.limits.low_speed if self.low_speed else self.limits.top_speed
        speed = max(-most, min(most, self.speed))
        return max(-1.0, min(1.0, speed / self.limits.top_speed)), self.steering
