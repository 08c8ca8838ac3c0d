"""A board that knows by its encoders where it is, in the time of the physics."""

from __future__ import annotations

import math

from frobit_drive.differential import Axle, Pose
from wheeled_physics.measures import Measures
from wheeled_physics.regulated_board import RegulatedBoard, Regulation


class ReckoningBoard(RegulatedBoard):
    """Drives as it is told, and sums up what its wheels turn."""

    def __init__(self, regulation: Regulation, measures: Measures, seed: int) -> None:
        """Stand where the odometry begins; the seed is that of the noise."""
        super().__init__(regulation, measures, seed)
        self._axle = Axle(measures.wheel_radius, measures.wheel_distance)
        self.pose = Pose()
        self.motion = 0.0, 0.0
        self._reckoned_at = 0.0
        self._angles = 0.0, 0.0

    def reckon(self) -> bool:
        """Take from the encoders where it is and how it moves; return whether time has passed."""
        duration = self.robot.time - self._reckoned_at
        if duration <= 0.0:
            return False
        self._reckoned_at = self.robot.time
        before = self._angles
        left, right = self._angles = self._turned('left'), self._turned('right')
        speeds = (left - before[0]) / duration, (right - before[1]) / duration
        self.motion = self._axle.motion(*speeds)
        self.pose.advance(*self.motion, duration)
        return True

    def _turned(self, side: str) -> float:
        return self.robot.encoder(side) / self._measures.ticks_per_turn * math.tau
