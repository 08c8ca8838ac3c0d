"""A monitor in time."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any, NamedTuple
from unittest.mock import Mock

import pytest

pytest.importorskip("rclpy")

from deros.generators.runtime.python.deros_runtime.monitor_runner import (
    AFTER,
    NEAR,
    ActionError,
    MonitorRunner,
)


class Event(NamedTuple):
    """What the monitor orders."""

    action: str


BAD: dict[str, BaseException] = {
    "throws": OSError("no horn"),
    "exits": SystemExit(0),
    "interrupts": KeyboardInterrupt(),
    "closes": GeneratorExit(),
}


class Monitor:
    """A monitor that orders some actions at its deadline, or fails then."""

    def __init__(self, actions: list[str], emit: Callable[[Event], None], failing: bool) -> None:
        """Begin; the deadline is at once."""
        self.actions = actions
        self.emit = emit
        self.failing = failing
        self.next_deadline: int | None = 0

    def advance(self, _now: int) -> None:
        """Order the actions, once."""
        if self.next_deadline is None:
            return
        self.next_deadline = None
        for action in self.actions:
            self.emit(Event(action))
        if self.failing:
            raise ArithmeticError("in the monitor")

    def explain(self) -> str:
        """Explain nothing."""
        return ""


class Owner:
    """What a runner calls, in the order called."""

    def __init__(self, *actions: str, failing: bool = False) -> None:
        """Start a runner off simulated time."""
        self.calls: list[str] = []
        self.steady = Mock()
        node = Mock()
        node.get_parameter.return_value.value = False
        self.runner = MonitorRunner(
            node,
            self.steady,
            lambda _start, emit: Monitor(list(actions), emit, failing),
            self.show,
            self.run,
            self.after,
            lambda: self.calls.append("tell"),
            lambda: self.calls.append("stepped"),
        )
        self.runner.start()

    def show(self, event: Event) -> bool:
        """Show a stop at once; what cannot be shown fails once, and the rest is code."""
        if event.action == "unshowable" and "no unshowable" not in self.calls:
            self.calls.append("no unshowable")
            raise OSError("no publisher")
        if event.action in ("stop", "unshowable"):
            self.calls.append(f"show {event.action}")
            return True
        return False

    def run(self, event: Event) -> None:
        """Run code, unless it is bad."""
        self.calls.append(f"run {event.action}")
        if event.action in BAD:
            raise BAD[event.action]

    def after(self, events: list[Any], done: list[int], states: list[Any]) -> None:
        """Take what has been done."""
        assert len(events) == len(done) == len(states)
        assert all(done)
        self.calls.append(f"after {' '.join(event.action for event in events)}")


def test_all_is_done_before_anything_is_told() -> None:
    """The actions come first."""
    owner = Owner("stop", "beep")
    owner.runner.advance()
    assert owner.calls == ["show stop", "run beep", "after stop beep"]


def test_what_is_published_waits_for_no_code() -> None:
    """A stop that is ordered after code is out before that; it is told of in its place."""
    owner = Owner("beep", "stop")
    owner.runner.advance()
    assert owner.calls == ["show stop", "run beep", "after beep stop"]


def test_what_could_not_be_published_is_tried_again_before_code_runs() -> None:
    """A failure in the middle of an evaluation is no failure of the monitor."""
    owner = Owner("beep", "unshowable", "stop")
    owner.runner.advance()
    assert owner.calls == [
        "no unshowable",
        "show stop",
        "show unshowable",
        "run beep",
        "after beep unshowable stop",
    ]


@pytest.mark.parametrize("bad", BAD)
def test_failing_code_keeps_nothing_else_from_being_done(bad: str) -> None:
    """Whatever it raises, the rest is done and told, and then an ordinary error ends the node."""
    owner = Owner(bad, "beep", "stop")
    with pytest.raises(ActionError) as raised:
        owner.runner.advance()
    assert raised.value.__cause__ is BAD[bad]
    assert owner.calls == [
        "show stop",
        f"run {bad}",
        "run beep",
        f"after {bad} beep stop",
        "tell",
    ]


def test_code_of_before_the_start_is_run_whatever_fails() -> None:
    """One that fails keeps no other from being run again."""
    owner = Owner()
    with pytest.raises(ActionError):
        owner.runner.run_again([Event("throws"), Event("beep")])
    assert owner.calls == ["run throws", "run beep", "tell"]


def test_code_that_comes_back_finds_nothing_to_be_done() -> None:
    """An action that spins its node does not run itself again."""
    owner = Owner("beep", "stop")

    def come_back(event: Event) -> None:
        owner.run(event)
        owner.runner.settle()

    owner.runner._run = come_back
    owner.runner.advance()
    assert owner.calls == ["show stop", "run beep", "after beep stop"]


def test_what_a_failing_monitor_has_ordered_is_done() -> None:
    """An error in the rules ends the node, but not before the stop is out."""
    owner = Owner("stop", "beep", failing=True)
    with pytest.raises(ArithmeticError):
        owner.runner.advance()
    assert owner.calls == ["show stop", "run beep", "after stop beep"]


def test_what_is_done_is_done_once() -> None:
    """A second look finds nothing ordered."""
    owner = Owner("stop", "beep")
    owner.runner.advance()
    owner.runner.settle()
    assert owner.calls == ["show stop", "run beep", "after stop beep"]


def test_what_can_wait_waits_while_a_deadline_is_near() -> None:
    """From shortly before it until shortly after it, and not on account of one that is far."""
    owner = Owner()
    runner = owner.runner
    assert runner.defer() <= AFTER
    now = time.monotonic_ns()
    runner.now = lambda: now
    for left, pause in ((NEAR + 10**9, 0), (NEAR - 10**6, NEAR - 10**6 + AFTER), (-(10**9), 0)):
        runner.monitor.next_deadline = now + left
        assert max(runner.defer(), 0) == pause
    runner.monitor.next_deadline = None
    assert runner.defer() == 0


class Counter:
    """A monitor with a deadline each second, which explains what it has ordered by its count."""

    def __init__(self, emit: Callable[[Event], None]) -> None:
        """Begin; the first deadline is after a second."""
        self.emit = emit
        self.count = 0
        self.next_deadline = 1

    def advance(self, now: int) -> None:
        """Order an action at each second."""
        while self.next_deadline <= now:
            self.count += 1
            self.emit(Event(f"stop {self.count}"))
            self.next_deadline += 1

    def explain(self) -> int:
        """Return how many actions it has ordered."""
        return self.count


def test_each_of_several_late_events_is_explained_by_what_was_known_then() -> None:
    """A call that comes late settles one instant after the other; it publishes all at once."""
    told: list[tuple[str, int]] = []
    owner = Owner()
    runner = owner.runner
    runner.monitor = Counter(runner._take)
    runner._show = lambda _event: True
    runner._after = lambda events, _, states: told.extend(
        (event.action, state) for event, state in zip(events, states, strict=True)
    )
    runner.catch_up(3)
    assert told == []
    runner.settle()
    assert told == [("stop 1", 1), ("stop 2", 2), ("stop 3", 3)]
