"""The Intelligent One in physics: its driver, which marks lines, and the board that obeys."""

from __future__ import annotations

from frobit_route.route import Route
from wheeled_physics.measures import individual, INTELLIGENT_ONE, Measures
from wheeled_physics.reckoning_board import ReckoningBoard
from wheeled_physics.regulated_board import Regulation

CRUISING = 0.4
"""Speed, in m/s, at which lines are marked."""

LINES = ((2.2, 0.0), (2.2, 1.5), (0.0, 1.5), (0.0, 0.0))
"""Corners, in m from the start, of the field whose lines are marked; the bank is farther off."""

TOO_FAR = 6.0
"""How far ahead of the start, in m, the plan of the field leads with the fault ``bank``."""

PAUSE = 1.0
"""Time in s for which it stands before each attempt to set off, and for which it tries."""

REGULATION = Regulation(
    fastest=0.7,
    fastest_turn=1.0,
    acceleration=0.8,
    turn_acceleration=2.0,
    timeout=0.45,
    top_speed=INTELLIGENT_ONE.top_speed,
    gain=0.2,
    integral_gain=1.0,
    holds=True,
)
"""Our assumption, but for the timeout, which is that of the simple robot."""


class IntelligentOneBoard(ReckoningBoard):
    """Wishes to drive along its lines, drives as it is told, and knows how it moves."""

    def __init__(self, seed: int = 0, measures: Measures | None = None) -> None:
        """Stand at the first corner; without measures, each seed is another robot."""
        super().__init__(REGULATION, measures or individual(INTELLIGENT_ONE, seed), seed)
        self._way = Route(LINES, CRUISING)
        self._has_set_off = self._stopped = False

    def command(self, forward: float, turn: float) -> None:
        """Take a motion in m/s and rad/s; one to stand ends the way for good."""
        super().command(forward, turn)
        drives = (forward, turn) != (0.0, 0.0)
        self._stopped = self._stopped or (self._has_set_off and not drives)
        self._has_set_off = self._has_set_off or drives

    def fail(self, fault: str) -> None:
        """Let something of the hardware fail for good, or lead the way onto the bank."""
        if fault == 'bank':
            self._way = Route([(TOO_FAR, self.pose.y)], CRUISING)
        else:
            super().fail(fault)

    def wish(self) -> tuple[float, float]:
        """
        Return the motion along the lines, in m/s and rad/s.

        It is zero after a stop and before each attempt to set off: the gate waits for it.
        """
        self._stopped = self._stopped or (self._has_set_off and not self.is_told())
        waits = not self._has_set_off and self.robot.time % (2 * PAUSE) < PAUSE
        if self._stopped or waits:
            return 0.0, 0.0
        return self._way.command(self.pose.x, self.pose.y, self.pose.yaw)
