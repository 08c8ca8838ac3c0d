"""One wheel: its speed from the ticks of its encoder, and the thrust that keeps its setpoint."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
import math

WINDOW = 0.1
"""Time, in s, over which ticks are counted: a tick in 20 ms alone is 1.7 rad/s."""


def step(before: int, after: int) -> int:
    """Return the ticks between two states of a 32-bit counter, which may have wrapped."""
    return (after - before + 2**31) % 2**32 - 2**31


@dataclass
class Tachometer:
    """Speed of a wheel, by its encoder."""

    ticks_per_turn: int
    _counts: deque[tuple[float, int]] = field(default_factory=deque)

    def count(self, ticks: int, now: float) -> None:
        """Take a state of the counter, read at ``now`` seconds."""
        self._counts.append((now, ticks))
        while len(self._counts) > 2 and now - self._counts[1][0] >= WINDOW:
            self._counts.popleft()

    def age(self, now: float) -> float:
        """Return for how many seconds the encoder has been silent; infinity before its first."""
        return now - self._counts[-1][0] if self._counts else math.inf

    def speed(self) -> float:
        """Return the speed in rad/s; zero while there are not two states of the counter."""
        if len(self._counts) < 2:
            return 0.0
        (begin, first), (end, last) = self._counts[0], self._counts[-1]
        if end <= begin:
            return 0.0
        return step(first, last) * math.tau / self.ticks_per_turn / (end - begin)


@dataclass
class Regulator:
    """
    Proportional and integral control on top of the thrust that the setpoint asks for by itself.

    A setpoint of zero ends what has been summed up: a wheel whose encoder says nothing would else
    go on with the thrust by which the regulator tried to make it turn.
    """

    top_speed: float
    gain: float
    integral_gain: float
    _sum: float = 0.0

    def thrust(self, setpoint: float, speed: float, duration: float) -> float:
        """Return the thrust, from -1 to 1, for the next ``duration`` seconds."""
        if setpoint == 0.0 or not math.isfinite(setpoint):
            self._sum = 0.0
            return 0.0
        lacking = setpoint - speed
        wanted = setpoint / self.top_speed + self.gain * lacking + self._sum
        if abs(wanted) < 1.0 or wanted * lacking < 0.0:  # else more would only wind it up
            self._sum += self.integral_gain * lacking * duration
        return max(-1.0, min(1.0, wanted))
