"""The Kobuki's board on its wheels in physics: what it does with commands, and what it reports."""

from __future__ import annotations

from kobuki_base.base import (
    ACCELERATION,
    COMMAND_TIMEOUT,
    COUNTER,
    FASTEST,
    FASTEST_TURN,
    part_touched,
    TURN_ACCELERATION,
)
from wheeled_physics.measures import individual, KOBUKI, Measures
from wheeled_physics.regulated_board import RegulatedBoard, Regulation
from wheeled_physics.robot import SIDES

REGULATION = Regulation(
    fastest=FASTEST,
    fastest_turn=FASTEST_TURN,
    acceleration=ACCELERATION,
    turn_acceleration=TURN_ACCELERATION,
    timeout=COMMAND_TIMEOUT,
    top_speed=KOBUKI.top_speed,
    gain=0.03,
    integral_gain=0.3,
)


class KobukiBoard(RegulatedBoard):
    """Reports what encoders and bumper show, as the Kobuki does."""

    def __init__(self, seed: int = 0, measures: Measures | None = None) -> None:
        """Stand in the middle of the room; without measures, each seed is another Kobuki."""
        super().__init__(REGULATION, measures or individual(KOBUKI, seed), seed)

    def counters(self) -> tuple[int, int]:
        """Return the states of the encoders, left and right, of 16 bits."""
        left, right = (self.robot.encoder(side) % COUNTER for side in SIDES)
        return left, right

    def stamp(self) -> int:
        """Return the time stamp of the counters, in ms, of 16 bits."""
        return round(self.robot.time * 1000) % COUNTER

    def bumper(self) -> int:
        """Return the bits of the parts of the bumper that touch a wall."""
        bits = 0
        for bearing in self.robot.touched():
            bits |= part_touched(bearing)
        return bits
