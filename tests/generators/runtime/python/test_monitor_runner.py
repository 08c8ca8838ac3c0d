"""Running a monitor by a clock."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import pytest

pytest.importorskip("rclpy")

from deros.generators.runtime.python.deros_runtime.monitor_runner import (
    AFTER,
    NEAR,
    ActionError,
    MonitorRunner,
)
from tests.support.clockwork import Clockwork


class Event(NamedTuple):
    """An action requested by the monitor."""

    action: str
    arguments: tuple[Any, ...] = ()


BAD: dict[str, BaseException] = {
    "throws": OSError("no horn"),
    "exits": SystemExit(0),
    "interrupts": KeyboardInterrupt(),
    "closes": GeneratorExit(),
}


class Monitor:
    """A monitor that requests some actions at its deadline, or then fails."""

    def __init__(self, actions: list[str], emit: Callable[[Event], None], failing: bool) -> None:
        """Start with a deadline that is due."""
        self.actions = actions
        self.emit = emit
        self.failing = failing
        self.next_deadline: int | None = 0

    def advance(self, _now: int) -> None:
        """Request the actions, once."""
        if self.next_deadline is None:
            return
        self.next_deadline = None
        for action in self.actions:
            self.emit(Event(action))
        if self.failing:
            raise ArithmeticError("in the monitor")

    def explain(self) -> str:
        """Return an empty explanation."""
        return ""


class Owner:
    """Records the calls of a runner in order."""

    def __init__(self, *actions: str, failing: bool = False) -> None:
        """Start a runner without simulated time."""
        self.calls: list[str] = []
        self.clockwork = Clockwork(1_000)
        node = self.clockwork.node
        node.get_parameter.return_value.value = False
        self.actions = list(actions)
        self.failing = failing
        host: Any = self
        self.runner = MonitorRunner(node, self.clockwork.clock, host)
        self.runner.start()

    def begin(self, _start: int, emit: Callable[[Event], None]) -> Monitor:
        """Return the monitor."""
        return Monitor(self.actions, emit, self.failing)

    def flush_reports(self) -> None:
        """Record that the node ends."""
        self.calls.append("flush")

    def show(self, event: Event) -> bool:
        """Show a stop at once; 'unshowable' fails once, and other actions are user code."""
        if event.action == "unshowable" and "no unshowable" not in self.calls:
            self.calls.append("no unshowable")
            raise OSError("no publisher")
        if event.action in ("stop", "unshowable"):
            self.calls.append(f"show {event.action}")
            return True
        return False

    def run(self, event: Event) -> None:
        """Run user code, which may fail."""
        self.calls.append(f"run {event.action}")
        if event.action in BAD:
            raise BAD[event.action]

    def after(self, events: list[Any], done: list[int], states: list[Any]) -> None:
        """Record the executed actions."""
        assert len(events) == len(done) == len(states)
        assert all(done)
        self.calls.append(f"after {' '.join(event.action for event in events)}")


def test_actions_are_executed_before_reports() -> None:
    """All actions come first."""
    owner = Owner("stop", "beep")
    owner.runner.advance()
    assert owner.calls == ["show stop", "run beep", "after stop beep"]


def test_publishing_does_not_wait_for_user_code() -> None:
    """A stop requested after user code is published before it, and reported in order."""
    owner = Owner("beep", "stop")
    owner.runner.advance()
    assert owner.calls == ["show stop", "run beep", "after beep stop"]


def test_failed_publication_is_retried_before_user_code() -> None:
    """A failure during an evaluation is not a failure of the monitor."""
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
def test_failing_user_code_does_not_prevent_other_actions(bad: str) -> None:
    """Everything else is executed and reported, and then an ordinary error ends the node."""
    owner = Owner(bad, "beep", "stop")
    with pytest.raises(ActionError) as raised:
        owner.runner.advance()
    assert raised.value.__cause__ is BAD[bad]
    assert owner.calls == [
        "show stop",
        f"run {bad}",
        "run beep",
        f"after {bad} beep stop",
        "flush",
    ]


def test_repeated_user_code_runs_despite_failures() -> None:
    """A failing action does not prevent the others from running again."""
    owner = Owner()
    with pytest.raises(ActionError):
        owner.runner.run_again([Event("throws"), Event("beep")])
    assert owner.calls == ["run throws", "run beep", "flush"]


def test_reentrant_user_code_executes_nothing_twice() -> None:
    """An action that spins its node does not run itself again."""
    owner = Owner("beep", "stop")

    def come_back(call: Any) -> None:
        owner.run(call)
        owner.runner.settle()

    owner.runner._run = come_back
    owner.runner.advance()
    assert owner.calls == ["show stop", "run beep", "after beep stop"]


def test_actions_of_a_failing_monitor_are_executed() -> None:
    """An error in the rules ends the node, but only after the stop is published."""
    owner = Owner("stop", "beep", failing=True)
    with pytest.raises(ArithmeticError):
        owner.runner.advance()
    assert owner.calls == ["show stop", "run beep", "after stop beep"]


def test_actions_are_executed_once() -> None:
    """A second call finds nothing to do."""
    owner = Owner("stop", "beep")
    owner.runner.advance()
    owner.runner.settle()
    assert owner.calls == ["show stop", "run beep", "after stop beep"]


def test_reports_are_deferred_near_a_deadline() -> None:
    """From shortly before to shortly after it, and not because of a distant one."""
    owner = Owner()
    runner = owner.runner
    assert runner.defer() <= AFTER
    now = owner.clockwork.now
    for left, pause in ((NEAR + 10**9, 0), (NEAR - 10**6, NEAR - 10**6 + AFTER), (-(10**9), 0)):
        runner.monitor.next_deadline = now + left
        assert max(runner.defer(), 0) == pause
    runner.monitor.next_deadline = None
    assert runner.defer() == 0


class Counter:
    """A monitor with a deadline each second, whose explanation is the number of its actions."""

    def __init__(self, emit: Callable[[Event], None]) -> None:
        """Start with a deadline in one second."""
        self.emit = emit
        self.count = 0
        self.next_deadline = 1

    def advance(self, now: int) -> None:
        """Request an action at each second."""
        while self.next_deadline <= now:
            self.count += 1
            self.emit(Event(f"stop {self.count}"))
            self.next_deadline += 1

    def explain(self) -> int:
        """Return the number of requested actions."""
        return self.count


def test_late_events_have_the_explanations_of_their_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """A late call handles one deadline after the other, and publishes everything at once."""
    explained: list[tuple[str, int]] = []
    owner = Owner()
    runner = owner.runner
    take: Any = runner._take
    runner.monitor = Counter(take)
    monkeypatch.setattr(runner, "_show", lambda _event: True)

    def after(events: list[Event], _: list[int], states: list[int]) -> None:
        explained.extend((event.action, state) for event, state in zip(events, states, strict=True))

    monkeypatch.setattr(owner, "after", after)
    runner.catch_up(3)
    assert explained == []
    runner.settle()
    assert explained == [("stop 1", 1), ("stop 2", 2), ("stop 3", 3)]
