"""What was done is told afterwards, a little at a time."""

from __future__ import annotations

from typing import Any
from unittest.mock import Mock

import pytest

pytest.importorskip("rclpy")

from deros.generators.runtime.python.deros_runtime import report_queue
from deros.generators.runtime.python.deros_runtime.report_queue import (
    CHUNK,
    PAUSE,
    ROOM,
    SOON,
    ReportQueue,
)
from tests.support.clockwork import Clockwork


class Telling(Clockwork):
    """A queue on a clock that the test moves, and what they have told."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Begin at zero, with nothing to tell."""
        super().__init__()
        self.told: list[int] = []
        self.pauses = 0
        monkeypatch.setattr(report_queue, "time", Mock(monotonic_ns=self.read))
        self.diagnostics = Mock()
        events: Any = Mock(report_monitor_event=self.note)
        self.reports = ReportQueue(self.node, self.clock, events, self.diagnostics, self.pause, int)

    def note(self, event: Any, done: int, states: Any) -> None:
        """Note what is told, with all that belongs to it."""
        assert (done, states) == (7, "states")
        self.told.append(event.number)

    def pause(self) -> None:
        """Count how often some have been told."""
        self.pauses += 1

    def add(self, *numbers: int) -> None:
        """Add reports."""
        for number in numbers:
            self.reports.add([Mock(action="stop", number=number)], [7], ["states"])

    def pass_time(self, time: int) -> None:
        """Let time pass, and have the executor call the timer."""
        self.pass_to(self.now + time)


@pytest.fixture
def telling(monkeypatch: pytest.MonkeyPatch) -> Telling:
    """Give reports that have nothing to tell yet."""
    return Telling(monkeypatch)


def test_nothing_is_told_until_those_who_act_have_had_the_processor(telling: Telling) -> None:
    """Two milliseconds after the first of them."""
    telling.add(1)
    telling.now += SOON // 2
    telling.add(2)
    assert telling.told == []
    telling.pass_time(SOON - SOON // 2)
    assert telling.told == [1, 2]


def test_messages_come_between_chunks(telling: Telling) -> None:
    """A backlog is told of in order, and never more than a chunk of it at once."""
    everything = list(range(2 * CHUNK + 1))
    telling.add(*everything)
    telling.pass_time(SOON)
    assert telling.told == everything[:CHUNK]
    assert telling.timer.expires == telling.now + PAUSE
    telling.pass_time(PAUSE)
    assert telling.told == everything[: 2 * CHUNK]
    telling.pass_time(PAUSE)
    assert telling.told == everything
    assert telling.pauses == 3
    assert telling.diagnostics.changed.call_count == 3
    assert telling.diagnostics.update.call_count == len(everything)


def test_what_comes_later_is_told_later(telling: Telling) -> None:
    """Once all is told, the next report waits as the first one did."""
    telling.add(1)
    telling.pass_time(SOON)
    telling.add(2)
    assert telling.told == [1]
    assert telling.timer.expires == telling.now + SOON
    telling.pass_time(SOON)
    assert telling.told == [1, 2]


def test_a_backlog_does_not_grow_for_ever(telling: Telling) -> None:
    """Where the timer never gets its turn, each new report tells of an old one; none is lost."""
    everything = list(range(3 * ROOM))
    telling.add(*everything)
    assert telling.told == everything[:-ROOM]
    telling.reports.flush()
    assert telling.told == everything
