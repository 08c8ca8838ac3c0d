"""The feeding robot in physics: its engine, its hydraulic drive, and its bumpers."""

from __future__ import annotations

import math

from wheeled_physics.measures import FEEDING_ROBOT, individual, Measures
from wheeled_physics.reckoning_board import ReckoningBoard
from wheeled_physics.regulated_board import Regulation

TOP_SPEED, WHEEL_BASE = 1.5, 1.6
"""Speed (m/s) with the pedal fully down, and distance (m) of the axles, as software takes them."""

IDLE_SPEED = 94.2
"""Crankshaft speed, in rad/s, of the engine at 900 revolutions a minute."""

LARGEST_STEERING = 0.5
"""Mechanical limit of the steering, in rad."""

REGULATION = Regulation(
    fastest=TOP_SPEED,
    fastest_turn=1.0,
    acceleration=1.5,
    turn_acceleration=3.0,
    timeout=0.35,
    top_speed=FEEDING_ROBOT.top_speed,
    gain=0.2,
    integral_gain=1.0,
    holds=True,
)
"""Our assumption: valves that regulate the wheels, and are shut when no pedal is heard."""


class FeedingRobotBoard(ReckoningBoard):
    """Drives by pedal and steering while its engine runs, and stands on its brakes else."""

    def __init__(self, seed: int = 0, measures: Measures | None = None) -> None:
        """Stand in the alley with the engine off; without measures, each seed is another robot."""
        super().__init__(REGULATION, measures or individual(FEEDING_ROBOT, seed), seed)
        self._steering = 0.0
        self.engine(False)

    def engine(self, on: bool) -> None:
        """Open or shut the fuel valve: without the engine there is no pressure to drive with."""
        self.engine_speed = IDLE_SPEED if on else 0.0
        self.robot.relay(not on)

    def pedal(self, position: float) -> None:
        """Take the position of the pedal, from -1 to 1: 0 holds the robot."""
        forward = position * TOP_SPEED
        self.command(forward, forward * math.tan(self._steering) / WHEEL_BASE)

    def steer(self, angle: float) -> None:
        """Take the angle (rad, to the left) of front wheels that would turn the robot so."""
        if math.isfinite(angle):
            self._steering = max(-LARGEST_STEERING, min(LARGEST_STEERING, angle))

    def bumpers(self) -> tuple[bool, bool]:
        """Return whether the front bumper touches something, and the rear one."""
        bearings = self.robot.touched()
        front = any(abs(each) <= math.pi / 2 for each in bearings)
        return front, any(abs(each) > math.pi / 2 for each in bearings)
