"""The Frobit's board on its wheels in physics: two motor drivers, two encoders, a battery."""

from __future__ import annotations

import math

from frobit_base.board import SUPPLY_TIMEOUT
from wheeled_physics.measures import FROBIT, individual, Measures
from wheeled_physics.robot import Robot, SIDES


class FrobitBoard:
    """Drives the motors as it is told, in the time of the physics, and counts."""

    def __init__(self, seed: int = 0, measures: Measures | None = None) -> None:
        """Stand, with a full battery; without measures each seed is another Frobit."""
        self.robot = Robot(measures or individual(FROBIT, seed), seed)
        self._thrusts = dict.fromkeys(SIDES, 0.0)
        self._told_at = dict.fromkeys(SIDES, -math.inf)

    def command(self, side: str, thrust: float) -> None:
        """Take the thrust of a wheel, from -1 to 1, unless the line to the computer is cut."""
        if self.robot.heard:
            self._thrusts[side] = thrust
            self._told_at[side] = self.robot.time

    def advance(self, duration: float) -> None:
        """Let time pass, in s; a driver whose thrust is too old does not drive."""
        until = self.robot.time + duration
        while self.robot.time < until - 1e-9:
            given = [
                self._thrusts[side]
                if self.robot.time - self._told_at[side] <= SUPPLY_TIMEOUT
                else 0.0
                for side in SIDES
            ]
            self.robot.thrust(*given)
            self.robot.step()

    def fail(self, fault: str) -> None:
        """Let something of the hardware fail for good."""
        self.robot.fail(fault)

    def ticks(self, side: str) -> int:
        """Return the counter of an encoder, signed, of 32 bits."""
        return (self.robot.encoder(side) + 2**31) % 2**32 - 2**31

    def moves(self) -> bool:
        """Return whether a wheel turns."""
        return max(abs(self.robot.wheel_speed(side)) for side in SIDES) > 1.0
