"""One-shot timers that share one timer of rclpy."""

from __future__ import annotations

import time
from collections.abc import Callable
from unittest.mock import Mock

import pytest

pytest.importorskip("rclpy")

from deros.generators.runtime.python.deros_runtime.one_shot_timer import (
    MAX_DEFERRAL,
    TOLERANCE,
    NodeClock,
    OneShotTimer,
    steady_clock,
)
from tests.support.clockwork import Clockwork
from tests.support.ros import LIMIT

MS = 1_000_000


def test_timer_fires_once_despite_repeated_calls(clockwork: Clockwork) -> None:
    """The EventsExecutor may call several times for one expiry."""
    timer, fired = timer_on(clockwork)
    timer.schedule(1500)
    clockwork.pass_to(1500, calls=3)
    assert fired == [1500]


def test_early_call_does_not_reset_the_timer(clockwork: Clockwork) -> None:
    """Each reset would cause another call."""
    timer, fired = timer_on(clockwork)
    timer.schedule(5 * MS)
    clockwork.pass_to(4 * MS, calls=100)
    assert (fired, clockwork.times_set) == ([], 1)
    clockwork.pass_to(5 * MS + 100)
    assert fired == [5 * MS + 100]


def test_timer_is_set_again_after_a_clock_step(clockwork: Clockwork) -> None:
    """After a time jump, rcl may have another expiry time."""
    timer, fired = timer_on(clockwork)
    timer.schedule(5 * MS)
    clockwork.timer.expires = 2 * MS
    clockwork.pass_to(2 * MS)
    assert (fired, clockwork.timer.expires) == ([], 5 * MS)
    clockwork.timer.expires = 5 * MS - TOLERANCE
    clockwork.pass_to(5 * MS)
    assert fired == [5 * MS]


def test_timer_scheduled_in_the_past_fires_at_once(clockwork: Clockwork) -> None:
    """A timer period is at least one nanosecond."""
    timer, _ = timer_on(clockwork)
    timer.schedule(0)
    assert clockwork.timer.expires == clockwork.now + 1


@pytest.mark.parametrize(
    ("now", "due"), [(1500, 1600), (1530, 1600), (1600, 1700), (9999, 10099), (700, 800)]
)
def test_repetition_keeps_the_period_except_after_pauses(
    now: int, due: int, clockwork: Clockwork
) -> None:
    """Lateness does not accumulate; periods missed in a pause or clock step are skipped."""
    timer, _ = timer_on(clockwork)
    timer.schedule(1500)
    clockwork.now = now
    timer.repeat(100)
    assert timer.due == due


def test_timer_is_deferred_while_something_has_priority(clockwork: Clockwork) -> None:
    """It asks again after the given time; its due time is unchanged."""
    pauses = [300, 0]
    timer, fired = timer_on(clockwork, lambda: pauses.pop(0))
    timer.schedule(1500)
    clockwork.pass_to(1510)
    assert (fired, clockwork.timer.expires, timer.due) == ([], 1810, 1500)
    clockwork.pass_to(1810)
    assert fired == [1810]


def test_deferral_is_bounded(clockwork: Clockwork) -> None:
    """A node that is always busy still reports after a while."""
    timer, fired = timer_on(clockwork, lambda: 300)
    timer.schedule(1500)
    clockwork.pass_to(1500 + MAX_DEFERRAL - 1)
    assert fired == []
    clockwork.pass_to(1500 + MAX_DEFERRAL - 1 + 300)
    assert fired == [1500 + MAX_DEFERRAL - 1 + 300]


def test_timers_of_one_clock_share_a_timer(clockwork: Clockwork) -> None:
    """It is set for the earliest of them, and not again for a later one."""
    early, fired_early = timer_on(clockwork)
    late, fired_late = timer_on(clockwork)
    late.schedule(3000)
    early.schedule(2000)
    late.schedule(2500)
    assert (clockwork.timers, clockwork.times_set, clockwork.timer.expires) == (1, 2, 2000)
    clockwork.pass_to(2000)
    assert (fired_early, fired_late, clockwork.timer.expires) == ([2000], [], 2500)
    clockwork.pass_to(2500)
    assert fired_late == [2500]


def test_messages_are_handled_between_timers(clockwork: Clockwork) -> None:
    """Of several due timers one fires per call, the earliest first."""
    timers = [timer_on(clockwork) for _ in range(3)]
    for (timer, _), due in zip(timers, (1300, 1100, 1200), strict=True):
        timer.schedule(due)
    order = []
    for now in (2000, 2010, 2020):
        clockwork.pass_to(now)
        order.append([i for i, (_, fired) in enumerate(timers) if fired[-1:] == [now]])
    assert order == [[1], [2], [0]]


def test_callback_may_schedule_other_timers(clockwork: Clockwork) -> None:
    """The timer is set once for all of them."""
    others = [timer_on(clockwork) for _ in range(3)]

    def fire() -> None:
        for i, (other, _) in enumerate(others):
            other.schedule(clockwork.now + 300 - 100 * i)

    OneShotTimer(clockwork.clock, fire).schedule(1500)
    before = clockwork.times_set
    clockwork.pass_to(1500)
    assert (clockwork.times_set, clockwork.timer.expires) == (before + 1, 1600)


def test_each_clock_has_its_own_shared_timer(clockwork: Clockwork) -> None:
    """Simulated and steady time are independent."""
    timer_on(clockwork)
    NodeClock(clockwork.node, Mock(), clockwork.read)
    assert clockwork.timers == 2


@pytest.mark.ros
def test_timer_calls_do_not_multiply_on_a_busy_node(ros_env: dict[str, str]) -> None:
    """Timers that schedule each other leave rclpy's executor time for everything else.

    With a separate timer for each of them it makes thirty calls for each expiry.
    """
    import rclpy
    from rclpy.context import Context
    from rclpy.experimental.events_executor import EventsExecutor

    context = Context()
    rclpy.init(context=context, domain_id=int(ros_env["ROS_DOMAIN_ID"]))
    node = rclpy.create_node("busy", context=context)
    steady = steady_clock(node)
    timers: list[OneShotTimer] = []
    fired = calls = 0

    def fire() -> None:
        nonlocal fired
        fired += 1
        busy_until = time.monotonic_ns() + 2 * MS
        while time.monotonic_ns() < busy_until:
            pass
        for timer in timers:
            timer.schedule(time.monotonic_ns() + MS)

    timers += [OneShotTimer(steady, fire) for _ in range(4)]
    timers[0].schedule(0)
    executor = EventsExecutor(context=context)
    executor.add_node(node)
    end = time.monotonic() + 2 * LIMIT
    while fired < 500:
        executor.spin_once(timeout_sec=1.0)
        calls += 1
        assert time.monotonic() < end, f"after {calls} calls only {fired} have fired"
    executor.shutdown()
    node.destroy_node()
    rclpy.shutdown(context=context)
    assert calls < 2 * fired


def timer_on(
    clockwork: Clockwork, defer: Callable[[], int] | None = None
) -> tuple[OneShotTimer, list[int]]:
    """Return a timer, and the times at which it fires."""
    fired: list[int] = []

    def fire() -> None:
        fired.append(clockwork.now)

    return OneShotTimer(clockwork.clock, fire, defer), fired


@pytest.fixture
def clockwork() -> Clockwork:
    """Return a clock that shows 1000 ns."""
    return Clockwork(1000)
