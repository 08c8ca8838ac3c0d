"""A board that regulates both wheels by its own counts, in the time of the physics."""

from __future__ import annotations

from dataclasses import dataclass
import math

from wheeled_physics.measures import Measures
from wheeled_physics.robot import PULSE, Robot, SIDES

CONTROL = 2
"""From how many pulses of the physics to how many the board sets its motors: every 20 ms."""


@dataclass(frozen=True)
class Regulation:
    """
    What a board does with commands: speeds in m/s and rad/s, their change per second, times in s.

    Without a command for ``timeout`` the robot is to stand. The top speed (rad/s) is that of a
    wheel at full thrust; the gains are the thrust for each rad/s that a wheel lacks, and for each
    that it lacks for a second. A board that ``holds`` regulates a wheel that is to stand, too,
    so the robot does not roll down a bank; another gives it no thrust.
    """

    fastest: float
    fastest_turn: float
    acceleration: float
    turn_acceleration: float
    timeout: float
    top_speed: float
    gain: float
    integral_gain: float
    holds: bool = False


class RegulatedBoard:
    """Drives as it is told, within its limits."""

    def __init__(self, regulation: Regulation, measures: Measures, seed: int) -> None:
        """Stand; the seed is that of the noise."""
        self._regulation = regulation
        self._measures = measures
        self.robot = Robot(measures, seed)
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
        limits = self._regulation
        self._wanted = limited(forward, limits.fastest), limited(turn, limits.fastest_turn)
        self._told_at = self.robot.time

    def advance(self, duration: float) -> None:
        """Let time pass, in s; without a command for too long the robot is to stand."""
        until = self.robot.time + duration
        while self.robot.time < until - 1e-9:
            if self._pulses % CONTROL == 0:
                self._control(CONTROL * PULSE)
            self.robot.step()
            self._pulses += 1

    def fail(self, fault: str) -> None:
        """Let something of the hardware fail for good."""
        self.robot.fail(fault)

    def moves(self) -> bool:
        """Return whether it drives or turns."""
        speeds = [self.robot.wheel_speed(side) for side in SIDES]
        return max(map(abs, speeds)) * self._measures.wheel_radius > 0.05

    def is_told(self) -> bool:
        """Return whether the last command still holds."""
        return self.robot.time - self._told_at <= self._regulation.timeout

    def _control(self, duration: float) -> None:
        limits = self._regulation
        forward, turn = self._wanted if self.is_told() else (0.0, 0.0)
        self._forward += limited(forward - self._forward, limits.acceleration * duration)
        self._turn += limited(turn - self._turn, limits.turn_acceleration * duration)
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
        if setpoint == 0.0 and not self._regulation.holds:
            self._sums[side] = 0.0
            return 0.0
        lacking = setpoint - turned / duration
        summed = self._sums[side] + self._regulation.integral_gain * lacking * duration
        self._sums[side] = limited(summed, 1.0)
        feed = setpoint / self._regulation.top_speed
        return feed + self._regulation.gain * lacking + self._sums[side]


def limited(number: float, most: float) -> float:
    """Return the number that is nearest to one, within ``most`` of zero."""
    return max(-most, min(most, number))
