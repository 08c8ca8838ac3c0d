"""Wakes a waiting executor: on signals, and when the wall clock is set back."""

from __future__ import annotations

import contextlib
import os
import select
import signal
import threading
import time
from types import FrameType, TracebackType

from rclpy.node import Node

PERIOD = 0.05  # seconds between looks at the wall clock
STEP = 1_000_000  # nanoseconds; the clock is being set, not merely slowed


class StopSignals:
    """
    Records SIGINT and SIGTERM in a flag, so that they interrupt no callback.

    This replaces the handling of rclpy, which shuts the context down at once: a message that is
    being evaluated then could no longer be acted upon.
    """

    def __init__(self) -> None:
        """Install the handlers, for good; repeated signals are ignored."""
        self.received = False
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, self._take)

    def _take(self, _number: int, _frame: FrameType | None) -> None:
        self.received = True


class Waker:
    """
    Wakes the EventsExecutor of a node when a signal arrives or the wall clock goes back.

    Builds of rclpy for glibc before 2.30, as those of the package index are, cannot wait on a
    steady clock: their waits end at a time of the wall clock. Set it back by an hour, and no timer
    of the executor expires for an hour. A separate thread detects that, and restarts the waits.
    """

    def __init__(self, node: Node) -> None:
        """Set up for the timers that the node has now; works while it is entered."""
        # The executor waits for the timers of each clock on their own.
        clocks = {id(timer.clock): timer.clock for timer in node.timers}
        self._timers = [
            node.create_timer(1e-6, self._expire, clock=clock, autostart=False)
            for clock in clocks.values()
        ]
        self._ends = False
        self._thread = threading.Thread(target=self._watch, name='waker', daemon=True)

    def __enter__(self) -> None:
        """Start the thread."""
        self._signalled, self._signals = os.pipe()
        for end in (self._signalled, self._signals):
            os.set_blocking(end, False)
        signal.set_wakeup_fd(self._signals, warn_on_full_buffer=False)
        self._thread.start()

    def __exit__(
        self,
        _type: type[BaseException] | None,
        _error: BaseException | None,
        _trace: TracebackType | None,
    ) -> None:
        """End the thread."""
        self._ends = True
        signal.set_wakeup_fd(-1)
        os.close(self._signals)
        self._thread.join()
        os.close(self._signalled)

    def _watch(self) -> None:
        ahead = wall_clock_ahead()
        while not self._ends:
            readable, _, _ = select.select([self._signalled], [], [], PERIOD)
            before, ahead = ahead, wall_clock_ahead()
            if readable:
                self._drain()
            if readable or ahead < before - STEP:
                for timer in self._timers:
                    timer.reset()  # makes the executor compute anew how long to wait

    def _drain(self) -> None:
        """Empty the pipe that the signals write to."""
        with contextlib.suppress(BlockingIOError):
            while os.read(self._signalled, 1024):
                pass

    def _expire(self) -> None:
        for timer in self._timers:
            timer.cancel()


def wall_clock_ahead() -> int:
    """Return by how many nanoseconds the wall clock is ahead of the steady one."""
    return time.time_ns() - time.monotonic_ns()
