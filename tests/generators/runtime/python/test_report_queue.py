"""Queued reports are published later, in chunks."""

from __future__ import annotations

from typing import Any
from unittest.mock import Mock

import pytest

pytest.importorskip("rclpy")

from deros.generators.runtime.python.deros_runtime.report_queue import (
    CHUNK,
    PAUSE,
    ROOM,
    SOON,
    ReportQueue,
)
from tests.support.clockwork import Clockwork


class QueueOnClock(Clockwork):
    """A queue on a simulated clock, and its reports."""

    def __init__(self) -> None:
        """Start at time zero without reports."""
        super().__init__()
        self.reported: list[int] = []
        self.pauses = 0
        self.diagnostics = Mock()
        events: Any = Mock(report_monitor_event=self.note)
        self.reports = ReportQueue(self.clock, events, self.diagnostics, self.pause, int)

    def note(self, event: Any, done: int, states: Any) -> None:
        """Record a report with its data."""
        assert (done, states) == (7, "states")
        self.reported.append(event.number)

    def pause(self) -> None:
        """Count the reported items."""
        self.pauses += 1

    def add(self, *numbers: int) -> None:
        """Add reports."""
        for number in numbers:
            states: list[Any] = ["states"]
            self.reports.add([Mock(action="stop", number=number)], [7], states)

    def pass_time(self, time: int) -> None:
        """Advance the time, and let the executor call the timer."""
        self.pass_to(self.now + time)


@pytest.fixture
def queue() -> QueueOnClock:
    """Return an empty queue."""
    return QueueOnClock()


def test_reports_wait_for_the_readers_of_states(queue: QueueOnClock) -> None:
    """The delay is two milliseconds after the first of them."""
    queue.add(1)
    queue.now += SOON // 2
    queue.add(2)
    assert queue.reported == []
    queue.pass_time(SOON - SOON // 2)
    assert queue.reported == [1, 2]


def test_messages_are_handled_between_chunks(queue: QueueOnClock) -> None:
    """A backlog is reported in order, at most one chunk at a time."""
    everything = list(range(2 * CHUNK + 1))
    queue.add(*everything)
    queue.pass_time(SOON)
    assert queue.reported == everything[:CHUNK]
    assert queue.timer.expires == queue.now + PAUSE
    queue.pass_time(PAUSE)
    assert queue.reported == everything[: 2 * CHUNK]
    queue.pass_time(PAUSE)
    assert queue.reported == everything
    assert queue.pauses == 3
    assert queue.diagnostics.changed.call_count == 3
    assert queue.diagnostics.update.call_count == len(everything)


def test_later_report_waits_again(queue: QueueOnClock) -> None:
    """When the queue is empty, the next report waits as the first one did."""
    queue.add(1)
    queue.pass_time(SOON)
    queue.add(2)
    assert queue.reported == [1]
    assert queue.timer.expires == queue.now + SOON
    queue.pass_time(SOON)
    assert queue.reported == [1, 2]


def test_backlog_is_bounded(queue: QueueOnClock) -> None:
    """If the timer never fires, each new report flushes an old one; none is lost."""
    everything = list(range(3 * ROOM))
    queue.add(*everything)
    assert queue.reported == everything[:-ROOM]
    queue.reports.flush()
    assert queue.reported == everything
