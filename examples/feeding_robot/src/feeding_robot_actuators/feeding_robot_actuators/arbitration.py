"""Who moves the pedal: the gate's commands, where the mode switch says that software does."""

from __future__ import annotations

from dataclasses import dataclass

AUTOMATIC = 2
"""The position of the mode switch in which software moves the pedal."""


@dataclass(frozen=True)
class Limits:
    """Speeds in m/s, times in s."""

    top_speed: float
    command_timeout: float


@dataclass
class Arbiter:
    """
    Keeps what was commanded, with the time of it, and decides on the pedal.

    What safety demands is in the command already. No command in time means standing still: the
    gate itself may be gone.
    """

    limits: Limits
    command_at: float
    speed: float = 0.0
    steering: float = 0.0
    mode: int = 0

    def command(self, speed: float, steering: float, now: float) -> None:
        """Take a command of the gate."""
        self.speed, self.steering, self.command_at = speed, steering, now

    def decide(self, now: float) -> tuple[float, float]:
        """Return pedal position (-1 to 1) and steering angle (rad)."""
        if self.mode != AUTOMATIC or now - self.command_at > self.limits.command_timeout:
            return 0.0, self.steering
        return max(-1.0, min(1.0, self.speed / self.limits.top_speed)), self.steering
