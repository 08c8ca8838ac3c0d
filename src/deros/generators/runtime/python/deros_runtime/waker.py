"""What wakes a waiting node beside its messages and timers: signals, and a wall clock set back."""

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
    SIGINT and SIGTERM as a flag, so that none of them breaks a callback in the middle.

    It takes the place of rclpy's own handling, which shuts the context down at once: a message
    that is being judged then could not be acted upon any more.
    """

    def __init__(self) -> None:
        """Take the signals over, for good: whoever is told twice ends once."""
        self.came = False
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, self._take)

    def _take(self, _number: int, _frame: FrameType | None) -> None:
        self.came = True


class Waker:
    """
    Has the EventsExecutor of a node look around when a signal comes or the wall clock goes back.

    Builds of rclpy for glibc before 2.30, as those of the package index are, cannot wait on a
    steady clock: their waits end at a time of the wall clock. Set it back by an hour, and no timer
    of the executor expires for an hour. A thread of its own sees that, and starts the waits anew.
    """

    def __init__(self, node: Node) -> None:
        """Prepare to wake the timers that the node has now; works while it is entered."""
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
                self._forget()
            if readable or ahead < before - STEP:
                for timer in self._timers:
                    timer.reset()  # has the executor compute how long to wait

    def _forget(self) -> None:
        """Take out of the pipe what the signals have written."""
        with contextlib.suppress(BlockingIOError):
            while os.read(self._signalled, 1024):
                pass

    def _expire(self) -> None:
        for timer in self._timers:
            timer.cancel()


def wall_clock_ahead() -> int:
    """Return by how many nanoseconds the wall clock is ahead of the steady one."""
    return time.time_ns() - time.monotonic_ns()
