"""What was done is told afterwards, a little at a time, so that no message waits for it."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
import time

from rclpy.clock import Clock
from rclpy.node import Node

from .diagnostics import Diagnostics
from .event_reporter import EventReporter
from .one_shot_timer import OneShotTimer
from .report_types import Event, Explanation

SOON = 2_000_000  # ns after an action, when it is told of: those who have to act come first
CHUNK = 4  # reports at once: more of them would keep the monitor waiting for too long
PAUSE = 1_000_000  # ns from one chunk to the next, in which messages are judged
ROOM = 16  # reports that can wait; of one more, the oldest is told of at once


class ReportQueue:
    """
    Tells of what was done, in order.

    What happens faster than it can be told, on a busy machine, waits; what is told of is never
    more than a chunk between two messages.
    """

    def __init__(
        self,
        node: Node,
        steady: Clock,
        events: EventReporter,
        diagnostics: Diagnostics,
        prepare: Callable[[], None],
        defer: Callable[[], int],
    ) -> None:
        """
        Prepare.

        prepare is called after some have been told, for what can come next; defer is that of an
        timer.
        """
        self._events = events
        self._diagnostics = diagnostics
        self._prepare = prepare
        self._waiting: deque[tuple[Sequence[Event], Sequence[int], Sequence[Explanation]]] = (
            deque()
        )
        self._timer = OneShotTimer(node, steady, time.monotonic_ns, self._fire, defer)

    def add(
        self, events: Sequence[Event], done: Sequence[int], states: Sequence[Explanation]
    ) -> None:
        """
        Tell soon of events of the monitor.

        done is when each was acted upon; states are what the monitor explained after each.
        """
        self._waiting.append((events, done, states))
        if len(self._waiting) > ROOM:
            self._tell_of(1)
        if not self._timer.is_scheduled:
            self._timer.schedule(time.monotonic_ns() + SOON)

    def flush(self) -> None:
        """Tell of all that is left, at the end."""
        self._tell_of(len(self._waiting))

    def _fire(self) -> None:
        self._tell_of(min(CHUNK, len(self._waiting)))
        if self._waiting:
            self._timer.schedule(time.monotonic_ns() + PAUSE)

    def _tell_of(self, count: int) -> None:
        for _ in range(count):
            self._tell(*self._waiting.popleft())
        self._prepare()
        self._diagnostics.changed()

    def _tell(
        self, events: Sequence[Event], done: Sequence[int], states: Sequence[Explanation]
    ) -> None:
        for event, done_at, explained in zip(events, done, states, strict=False):
            self._events.report_monitor_event(event, done_at, explained)
            self._diagnostics.update(event, explained)
