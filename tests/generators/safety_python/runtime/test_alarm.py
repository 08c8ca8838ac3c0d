"""One-shot timers that ring at an instant, once."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any
from unittest.mock import Mock

import pytest

pytest.importorskip("rclpy")

from deros.generators.safety_python.runtime.alarm import PATIENCE, Alarm


class Clockwork:
    """A node with one timer, on a clock that the test moves."""

    def __init__(self) -> None:
        """Begin at 1000 ns with an alarm that is not set."""
        self.now = 1000
        self.rung: list[int] = []
        self.timer = Mock()
        self.expire: Callable[[], None] = lambda: None
        self.busy = 0
        node: Any = self
        self.alarm = Alarm(node, Mock(), lambda: self.now, self.ring, lambda: self.busy)

    def create_timer(
        self, _period: float, callback: Callable[[], None], *, clock: Any, autostart: bool
    ) -> Mock:
        """Stand in for rclpy's node."""
        assert clock is not None
        assert not autostart
        self.expire = callback
        return self.timer

    def ring(self) -> None:
        """Note when the alarm rang."""
        self.rung.append(self.now)

    def expire_at(self, now: int) -> None:
        """Have the executor run the timer's callback."""
        self.now = now
        self.expire()


def test_it_rings_once_even_if_the_executor_calls_twice() -> None:
    """A second call for the same expiry, which the EventsExecutor may make, does nothing."""
    it = Clockwork()
    it.alarm.ring_at(1500)
    assert it.timer.timer_period_ns == 500
    it.expire_at(1500)
    it.expire_at(1501)
    assert it.rung == [1500]


def test_it_never_rings_early() -> None:
    """A call that comes too early sets the timer again, to what is left."""
    it = Clockwork()
    it.alarm.ring_at(1500)
    it.expire_at(1499)
    assert it.rung == []
    assert it.timer.timer_period_ns == 1
    it.expire_at(1500)
    assert it.rung == [1500]


def test_what_is_past_rings_at_once() -> None:
    """A timer cannot have a period below one nanosecond."""
    it = Clockwork()
    it.alarm.ring_at(0)
    assert it.timer.timer_period_ns == 1


@pytest.mark.parametrize(
    ("now", "due"), [(1500, 1600), (1530, 1600), (1600, 1700), (9999, 10099), (700, 800)]
)
def test_repeating_keeps_the_rhythm_but_for_pauses_and_steps(now: int, due: int) -> None:
    """Lateness does not add up; after a pause nothing is made up for, nor after a step back."""
    it = Clockwork()
    it.alarm.ring_at(1500)
    it.now = now
    it.alarm.repeat(100)
    assert it.alarm.due == due


def test_it_is_put_off_while_something_goes_before_it() -> None:
    """It asks again when told to; what it was due for stays as it was."""
    it = Clockwork()
    it.alarm.ring_at(1500)
    it.busy = 300
    it.expire_at(1510)
    assert (it.rung, it.timer.timer_period_ns, it.alarm.due) == ([], 300, 1500)
    it.busy = 0
    it.expire_at(1810)
    assert it.rung == [1810]


def test_it_is_not_put_off_for_ever() -> None:
    """A node that is always busy tells, after a while, all the same."""
    it = Clockwork()
    it.alarm.ring_at(1500)
    it.busy = 300
    it.expire_at(1500 + PATIENCE - 1)
    assert it.rung == []
    it.expire_at(1500 + PATIENCE)
    assert it.rung == [1500 + PATIENCE]
