"""Publishes queued reports in batches, so that no message waits for them."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence

from .diagnostics import Diagnostics
from .event_reporter import EventReporter
from .one_shot_timer import NodeClock, OneShotTimer
from .report_types import Event, Explanation

SOON = 2_000_000  # ns from an action to its report: subscribers that have to act come first
CHUNK = 4  # reports in a batch: more would delay the monitor for too long
PAUSE = 1_000_000  # ns between batches, in which messages are handled
ROOM = 16  # reports that can wait; if there is one more, the oldest is published at once


class ReportQueue:
    """
    Publishes the reports of events in order.

    On a busy machine, events that come faster than they can be reported wait: never more than one
    batch is published between two messages.
    """

    def __init__(
        self,
        steady: NodeClock,
        events: EventReporter,
        diagnostics: Diagnostics,
        prepare: Callable[[], None],
        defer: Callable[[], int],
    ) -> None:
        """
        Set up.

        prepare is called after each batch, for what can come next; defer is that of a timer.
        """
        self._events = events
        self._diagnostics = diagnostics
        self._prepare = prepare
        self._waiting: deque[tuple[Sequence[Event], Sequence[int], Sequence[Explanation]]] = (
            deque()
        )
        self._now = steady.now
        self._timer = OneShotTimer(steady, self._fire, defer)

    def add(
        self, events: Sequence[Event], done: Sequence[int], states: Sequence[Explanation]
    ) -> None:
        """
        Report events of the monitor soon.

        done is when each was acted upon; states are the monitor's explanations after each.
        """
        self._waiting.append((events, done, states))
        if len(self._waiting) > ROOM:
            self._publish_batch(1)
        if not self._timer.is_scheduled:
            self._timer.schedule(self._now() + SOON)

    def flush(self) -> None:
        """Publish all that is left, at the end."""
        self._publish_batch(len(self._waiting))

    def _fire(self) -> None:
        self._publish_batch(min(CHUNK, len(self._waiting)))
        if self._waiting:
            self._timer.schedule(self._now() + PAUSE)

    def _publish_batch(self, count: int) -> None:
        for _ in range(count):
            self._publish(*self._waiting.popleft())
        self._prepare()
        self._diagnostics.changed()

    def _publish(
        self, events: Sequence[Event], done: Sequence[int], states: Sequence[Explanation]
    ) -> None:
        for event, done_at, explained in zip(events, done, states, strict=False):
            self._events.report_monitor_event(event, done_at, explained)
            self._diagnostics.update(event, explained)
