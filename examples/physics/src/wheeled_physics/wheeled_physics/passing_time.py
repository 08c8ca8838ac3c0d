"""How time passes in physics: as on the machine, or simulated, as fast as one wants it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from builtin_interfaces.msg import Time
from rosgraph_msgs.msg import Clock as ClockMessage
from wheeled_physics.robot import PULSE

CYCLE = 0.02
"""Time, in s, from one cycle of a node in physics to the next: two pulses."""

LONGEST = 0.1
"""Most seconds that are made up for at once: a simulation that was held up does not leap."""


class PassingTime(Protocol):
    """What tells, at each cycle of a node, how much time passes in physics."""

    def pass_on(self) -> int:
        """Return how many pulses pass in this cycle, and tell other nodes of it if need be."""

    def stamp(self) -> Time:
        """Return the time that this cycle has in messages."""


class RealTime:
    """Time as on the machine: what a cycle comes too late is made up for."""

    def __init__(self, steady: Callable[[], float], stamp: Callable[[], Time]) -> None:
        """Begin now; ``steady`` is a clock that nobody sets, in s, ``stamp`` that of messages."""
        self._steady = steady
        self.stamp = stamp
        self._last = steady()
        self._due = 0.0

    def pass_on(self) -> int:
        """Return how many whole pulses of the time since the last cycle are due."""
        now = self._steady()
        self._due += min(now - self._last, LONGEST)
        self._last = now
        pulses = int(self._due / PULSE)
        self._due -= pulses * PULSE
        return pulses


class SimulatedTime:
    """
    Time that the physics makes: each cycle is as long as the other, and others hear of it.

    Where the machine holds the node up, it passes more slowly, and nothing is made up for.
    """

    def __init__(self, publish: Callable[[ClockMessage], None]) -> None:
        """Begin at zero, which is no time yet; ``publish`` is called with each time."""
        self._publish = publish
        self._cycles = 0

    def pass_on(self) -> int:
        """Let a cycle pass, and publish the time then; return its pulses."""
        self._cycles += 1
        self._publish(ClockMessage(clock=self.stamp()))
        return round(CYCLE / PULSE)

    def stamp(self) -> Time:
        """Return the time that has passed."""
        seconds, nanoseconds = divmod(self._cycles * round(CYCLE * 1e9), 10**9)
        return Time(sec=seconds, nanosec=nanoseconds)
