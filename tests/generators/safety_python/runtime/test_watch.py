"""A monitor in time."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any, NamedTuple
from unittest.mock import Mock

import pytest

pytest.importorskip("rclpy")

from deros.generators.safety_python.runtime.watch import AFTER, NEAR, Watch


class Event(NamedTuple):
    """What the monitor orders."""

    action: str


class Monitor:
    """A monitor that orders some actions at its deadline, or fails then."""

    def __init__(self, actions: list[str], emit: Callable[[Event], None], failing: bool) -> None:
        """Begin; the deadline is at once."""
        self.actions = actions
        self.emit = emit
        self.failing = failing
        self.next_deadline: int | None = 0

    def advance(self, _now: int) -> None:
        """Order the actions."""
        self.next_deadline = None
        for action in self.actions:
            self.emit(Event(action))
        if self.failing:
            raise ArithmeticError("in the monitor")


class Owner:
    """What a watch calls, in the order called."""

    def __init__(self, *actions: str, failing: bool = False) -> None:
        """Start a watch off simulated time."""
        self.calls: list[str] = []
        self.steady = Mock()
        node = Mock()
        node.get_parameter.return_value.value = False
        self.watch = Watch(
            node,
            self.steady,
            lambda _start, emit: Monitor(list(actions), emit, failing),
            self.show,
            self.do,
            self.after,
            lambda: self.calls.append("tell"),
            lambda: self.calls.append("stepped"),
        )
        self.watch.start()

    def show(self, event: Event) -> bool:
        """Show a stop at once; whatever else is ordered is code, to be done later."""
        if event.action == "unshowable":
            raise OSError("no publisher")
        if event.action == "stop":
            self.calls.append("show stop")
        return event.action == "stop"

    def do(self, event: Event) -> None:
        """Do what is ordered, unless it is bad."""
        self.calls.append(f"do {event.action}")
        if event.action == "bad":
            raise OSError("no horn")

    def after(self, events: list[Any], done: list[int]) -> None:
        """Take what has been done."""
        assert len(events) == len(done)
        self.calls.append(f"after {len(events)}")


def test_all_is_done_before_anything_is_told() -> None:
    """The actions come first, in their order."""
    owner = Owner("stop", "beep")
    owner.watch.advance()
    assert owner.calls == ["show stop", "do beep", "after 2"]


def test_nothing_overtakes_what_was_ordered_before() -> None:
    """What could be shown at once waits for code that is to run before it."""
    owner = Owner("beep", "stop")
    owner.watch.advance()
    assert owner.calls == ["do beep", "do stop", "after 2"]


def test_what_cannot_be_shown_is_done_later_and_stops_nothing() -> None:
    """A failure in the middle of an evaluation is no failure of the monitor."""
    owner = Owner("unshowable", "stop")
    owner.watch.advance()
    assert owner.calls == ["do unshowable", "do stop", "after 2"]


def test_a_failing_action_keeps_no_other_from_being_done() -> None:
    """The rest is done and told, and then the failure ends the node."""
    owner = Owner("bad", "stop")
    with pytest.raises(OSError, match="no horn"):
        owner.watch.advance()
    assert owner.calls == ["do bad", "do stop", "after 2", "tell"]


def test_what_a_failing_monitor_has_ordered_is_done() -> None:
    """An error in the rules ends the node, but not before the stop is out."""
    owner = Owner("stop", "beep", failing=True)
    with pytest.raises(ArithmeticError):
        owner.watch.advance()
    assert owner.calls == ["show stop", "do beep", "after 2"]


def test_what_is_done_is_done_once() -> None:
    """A second look finds nothing ordered."""
    owner = Owner("stop", "beep")
    owner.watch.advance()
    owner.watch.settle()
    assert owner.calls == ["show stop", "do beep", "after 2"]


def test_what_can_wait_waits_while_a_deadline_is_near() -> None:
    """From shortly before it until shortly after it, and not on account of one that is far."""
    owner = Owner()
    watch = owner.watch
    assert watch.put_off() <= AFTER
    now = time.monotonic_ns()
    watch.now = lambda: now
    for left, pause in ((NEAR + 10**9, 0), (NEAR - 10**6, NEAR - 10**6 + AFTER), (-(10**9), 0)):
        watch.monitor.next_deadline = now + left
        assert max(watch.put_off(), 0) == pause
    watch.monitor.next_deadline = None
    assert watch.put_off() == 0
