"""A clock that a test moves, and timers on it, called as rclpy's EventsExecutor calls them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any
from unittest.mock import Mock


class Timer:
    """What rcl keeps of a timer.

    Attributes:
        expires: at what time, in nanoseconds; none if it is cancelled.
        timer_period_ns: what it will wait once it is set; a change does not move what it waits for.
    """

    def __init__(self, clockwork: Clockwork, callback: Callable[[], None]) -> None:
        """Begin cancelled."""
        self.expires: int | None = None
        self.timer_period_ns = 0
        self._clockwork = clockwork
        self._callback = callback

    def cancel(self) -> None:
        """Do not expire."""
        self.expires = None

    def reset(self) -> None:
        """Expire a period from now."""
        self.expires = self._clockwork.now + self.timer_period_ns
        self._clockwork.times_set += 1

    def time_until_next_call(self) -> int | None:
        """Return how long it still waits."""
        return None if self.expires is None else self.expires - self._clockwork.now

    def call(self) -> None:
        """Be called by the executor, at the right time or not; the next time is a period later."""
        if self.expires is not None:
            self.expires = max(self.expires, self._clockwork.now) + self.timer_period_ns
            self._callback()


class Clockwork:
    """A node whose timers run on a clock that the test moves.

    Attributes:
        now: what the clock shows, in nanoseconds.
        timer: the timer that was made first.
        timers: how many there are.
        times_set: how often a timer was set.
    """

    def __init__(self, now: int = 0) -> None:
        """Begin at a time, without timers."""
        self.now = now
        self.timers = 0
        self.times_set = 0
        self.clock: Any = Mock()
        self.node: Any = Mock(create_timer=self._create_timer)

    def read(self) -> int:
        """Return what the clock shows."""
        return self.now

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
