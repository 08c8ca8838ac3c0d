"""A clock that a test moves, and timers on it, called as rclpy's EventsExecutor calls them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any
from unittest.mock import Mock


class VirtualClock:
    """A clock that shows what a test sets.

    Attributes:
        now: what it shows, in nanoseconds.
        times_set: how often a timer on it was set.
    """

    def __init__(self, now: int = 0) -> None:
        """Begin at a time."""
        self.now = now
        self.times_set = 0

    def read(self) -> int:
        """Return what the clock shows."""
        return self.now


class Timer:
    """What rcl keeps of a timer.

    Attributes:
        clock: the clock that it expires by.
        expires: at what time, in nanoseconds; none if it is cancelled.
        timer_period_ns: what it will wait once it is set; a change does not move what it waits for.
    """

    def __init__(self, clock: VirtualClock, callback: Callable[[], None], period: int = 0) -> None:
        """Begin cancelled."""
        self.clock = clock
        self.expires: int | None = None
        self.timer_period_ns = period
        self._callback = callback

    def cancel(self) -> None:
        """Do not expire."""
        self.expires = None

    def reset(self) -> None:
        """Expire a period from now."""
        self.expires = self.clock.now + self.timer_period_ns
        self.clock.times_set += 1

    def time_until_next_call(self) -> int | None:
        """Return how long it still waits."""
        return None if self.expires is None else self.expires - self.clock.now

    def call(self) -> None:
        """Be called by the executor, at the right time or not; the next time is a period later."""
        if self.expires is not None:
            self.expires = max(self.expires, self.clock.now) + self.timer_period_ns
            self._callback()


class Clockwork(VirtualClock):
    """A node whose timers run on a clock that the test moves.

    Attributes:
        clock: the clock, as the runtime takes it.
        timer: the timer that was made first.
        timers: how many there are.
    """

    def __init__(self, now: int = 0) -> None:
        """Begin at a time, with the timer of the clock."""
        from deros.generators.runtime.python.deros_runtime.one_shot_timer import NodeClock

        super().__init__(now)
        self.timers = 0
        self.node: Any = Mock(create_timer=self._create_timer)
        self.clock = NodeClock(self.node, Mock(), self.read)

    def pass_to(self, now: int, calls: int = 1) -> None:
        """Let time pass, and have the executor call the first timer, perhaps more than once."""
        self.now = now
        for _ in range(calls):
            self.timer.call()

    def _create_timer(
        self, _period: float, callback: Callable[[], None], *, clock: Any, autostart: bool
    ) -> Timer:
        assert clock is not None
        assert not autostart
        timer = Timer(self, callback)
        if self.timers == 0:
            self.timer = timer
        self.timers += 1
        return timer
