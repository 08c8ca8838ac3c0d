"""The Kobuki's board on its wheels in physics: what it does with commands, and what it reports."""

from __future__ import annotations

import math

from kobuki_base.base import (
    ACCELERATION,
    COMMAND_TIMEOUT,
    COUNTER,
    FASTEST,
    FASTEST_TURN,
    limited,
    part_touched,
    TURN_ACCELERATION,
)
from wheeled_physics.measures import individual, KOBUKI, Measures
from wheeled_physics.robot import PULSE, Robot, SIDES

CONTROL = 2
"""From how many pulses of the physics to how many the board sets its motors: every 20 ms."""

GAIN, INTEGRAL_GAIN = 0.03, 0.3
"""Thrust for each rad/s that a wheel lacks, and for each that it lacks for a second."""


class KobukiBoard:
    """Regulates the wheels by its own counts, in the time of the physics."""

    def __init__(self, seed: int = 0, measures: Measures | None = None) -> None:
        """Stand in the middle of the room; without measures, each seed is another Kobuki."""
        self._measures = measures or individual(KOBUKI, seed)
        self.robot = Robot(self._measures, seed)
        self._wanted = (0.0, 0.0)
        self._told_at = -math.inf
        self._forward = self._turn = 0.0
        self._before = dict.fromkeys(SIDES, 0)
        self._sums = dict.fromkeys(SIDES, 0.0)
        self._pulses = 0

    def command(self, forward: float, turn: float) -> None:
        """
        Take a motion in m/s and rad/s; what is no number is one to stand.

        Nothing is heard if the line to the computer is cut.
        """
        if not self.robot.heard:
            return
        if not (math.isfinite(forward) and math.isfinite(turn)):
            forward = turn = 0.0
        self._wanted = limited(forward, FASTEST), limited(turn, FASTEST_TURN)
        self._told_at = self.robot.time

    def advance(self, duration: float) -> None:
        """Let time pass, in s; without a command for too long the robot is to stand."""
        until = self.robot.time + duration
        while self.robot.time < until - 1e-9:
            if self._pulses % CONTROL == 0:
                self._control(CONTROL * PULSE)
            self.robot.step()
            self._pulses += 1

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

    def moves(self) -> bool:
        """Return whether it drives or turns."""
        speeds = [self.robot.wheel_speed(side) for side in SIDES]
        return max(map(abs, speeds)) * self._measures.wheel_radius > 0.05

    def _control(self, duration: float) -> None:
        fresh = self.robot.time - self._told_at <= COMMAND_TIMEOUT
        forward, turn = self._wanted if fresh else (0.0, 0.0)
        self._forward += limited(forward - self._forward, ACCELERATION * duration)
        self._turn += limited(turn - self._turn, TURN_ACCELERATION * duration)
        aside = self._turn * self._measures.wheel_distance / 2
        left = self._thrust('left', self._forward - aside, duration)
        right = self._thrust('right', self._forward + aside, duration)
        self.robot.thrust(left, right)

    def _thrust(self, side: str, rim: float, duration: float) -> float:
        """Return the thrust that takes a wheel's rim to a speed in m/s."""
        counted = self.robot.counted(side)
        turned = (counted - self._before[side]) / self._measures.ticks_per_turn * math.tau
        self._before[side] = counted
        setpoint = rim / self._measures.wheel_radius
        if setpoint == 0.0:
            self._sums[side] = 0.0
            return 0.0
        lacking = setpoint - turned / duration
        summed = self._sums[side] + INTEGRAL_GAIN * lacking * duration
        self._sums[side] = limited(summed, 1.0)
        return setpoint / KOBUKI.top_speed + GAIN * lacking + self._sums[side]
