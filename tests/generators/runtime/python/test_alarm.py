"""Alarms that ring at an instant, once, on one timer for all."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any
from unittest.mock import Mock

import pytest

pytest.importorskip("rclpy")

from deros.generators.runtime.python.alarm import NEARLY, PATIENCE, Alarm
from tests.support.clockwork import Clockwork
from tests.support.ros import LIMIT

MS = 1_000_000


def test_it_rings_once_however_often_the_executor_calls(clockwork: Clockwork) -> None:
    """Further calls for one expiry, which the EventsExecutor may make, do nothing."""
    alarm, rung = alarm_on(clockwork)
    alarm.ring_at(1500)
    clockwork.pass_to(1500, calls=3)
    assert rung == [1500]


def test_a_call_that_comes_too_early_sets_no_timer(clockwork: Clockwork) -> None:
    """It would be called once more for each time that it is set."""
    alarm, rung = alarm_on(clockwork)
    alarm.ring_at(5 * MS)
    clockwork.pass_to(4 * MS, calls=100)
    assert (rung, clockwork.times_set) == ([], 1)
    clockwork.pass_to(5 * MS + 100)
    assert rung == [5 * MS + 100]


def test_a_timer_that_the_clock_has_left_behind_is_set_again(clockwork: Clockwork) -> None:
    """When time has stepped, rcl has its own idea of when the timer expires."""
    alarm, rung = alarm_on(clockwork)
    alarm.ring_at(5 * MS)
    clockwork.timer.expires = 2 * MS
    clockwork.pass_to(2 * MS)
    assert (rung, clockwork.timer.expires) == ([], 5 * MS)
    clockwork.timer.expires = 5 * MS - NEARLY
    clockwork.pass_to(5 * MS)
    assert rung == [5 * MS]


def test_what_is_past_rings_at_once(clockwork: Clockwork) -> None:
    """A timer cannot have a period below one nanosecond."""
    alarm, _ = alarm_on(clockwork)
    alarm.ring_at(0)
    assert clockwork.timer.expires == clockwork.now + 1


@pytest.mark.parametrize(
    ("now", "due"), [(1500, 1600), (1530, 1600), (1600, 1700), (9999, 10099), (700, 800)]
)
def test_repeating_keeps_the_rhythm_but_for_pauses_and_steps(
    now: int, due: int, clockwork: Clockwork
) -> None:
    """Lateness does not add up; after a pause nothing is made up for, nor after a step back."""
    alarm, _ = alarm_on(clockwork)
    alarm.ring_at(1500)
    clockwork.now = now
    alarm.repeat(100)
    assert alarm.due == due


def test_it_is_put_off_while_something_goes_before_it(clockwork: Clockwork) -> None:
    """It asks again when told to; what it was due for stays as it was."""
    pauses = [300, 0]
    alarm, rung = alarm_on(clockwork, lambda: pauses.pop(0))
    alarm.ring_at(1500)
    clockwork.pass_to(1510)
    assert (rung, clockwork.timer.expires, alarm.due) == ([], 1810, 1500)
    clockwork.pass_to(1810)
    assert rung == [1810]


def test_it_is_not_put_off_for_ever(clockwork: Clockwork) -> None:
    """A node that is always busy tells, after a while, all the same."""
    alarm, rung = alarm_on(clockwork, lambda: 300)
    alarm.ring_at(1500)
    clockwork.pass_to(1500 + PATIENCE - 1)
    assert rung == []
    clockwork.pass_to(1500 + PATIENCE - 1 + 300)
    assert rung == [1500 + PATIENCE - 1 + 300]


def test_alarms_of_a_clock_share_its_timer(clockwork: Clockwork) -> None:
    """It is set for the first of them, and not anew for one that comes later."""
    early, rung_early = alarm_on(clockwork)
    late, rung_late = alarm_on(clockwork)
    late.ring_at(3000)
    early.ring_at(2000)
    late.ring_at(2500)
    assert (clockwork.timers, clockwork.times_set, clockwork.timer.expires) == (1, 2, 2000)
    clockwork.pass_to(2000)
    assert (rung_early, rung_late, clockwork.timer.expires) == ([2000], [], 2500)
    clockwork.pass_to(2500)
    assert rung_late == [2500]


def test_messages_have_their_turn_between_alarms(clockwork: Clockwork) -> None:
    """Of those that are due together one rings in a call, the earliest first."""
    alarms = [alarm_on(clockwork) for _ in range(3)]
    for (alarm, _), due in zip(alarms, (1300, 1100, 1200), strict=True):
        alarm.ring_at(due)
    order = []
    for now in (2000, 2010, 2020):
        clockwork.pass_to(now)
        order.append([i for i, (_, rung) in enumerate(alarms) if rung[-1:] == [now]])
    assert order == [[1], [2], [0]]


def test_an_alarm_may_set_others_as_it_rings(clockwork: Clockwork) -> None:
    """The timer is set once for all of them."""
    others = [alarm_on(clockwork) for _ in range(3)]

    def ring() -> None:
        for i, (other, _) in enumerate(others):
            other.ring_at(clockwork.now + 300 - 100 * i)

    Alarm(clockwork.node, clockwork.clock, clockwork.read, ring).ring_at(1500)
    before = clockwork.times_set
    clockwork.pass_to(1500)
    assert (clockwork.times_set, clockwork.timer.expires) == (before + 1, 1600)


def test_a_clock_of_its_own_has_a_timer_of_its_own(clockwork: Clockwork) -> None:
    """Simulated time and steady time pass on their own."""
    alarm_on(clockwork)
    Alarm(clockwork.node, Mock(), clockwork.read, Mock())
    assert clockwork.timers == 2


@pytest.mark.ros
def test_calls_do_not_multiply_on_a_busy_node(ros_env: dict[str, str]) -> None:
    """Alarms that set each other, at once and for long, keep rclpy's executor from nothing else.

    With a timer for each of them it makes thirty calls for each time that one rings.
    """
    import rclpy
    from rclpy.clock import Clock
    from rclpy.clock_type import ClockType
    from rclpy.context import Context
    from rclpy.experimental.events_executor import EventsExecutor

    context = Context()
    rclpy.init(context=context, domain_id=int(ros_env["ROS_DOMAIN_ID"]))
    node = rclpy.create_node("busy", context=context)
    steady = Clock(clock_type=ClockType.STEADY_TIME)
    alarms: list[Alarm] = []
    rung = calls = 0

    def ring() -> None:
        nonlocal rung
        rung += 1
        busy_until = time.monotonic_ns() + 2 * MS
        while time.monotonic_ns() < busy_until:
            pass
        for alarm in alarms:
            alarm.ring_at(time.monotonic_ns() + MS)

    alarms += [Alarm(node, steady, time.monotonic_ns, ring) for _ in range(4)]
    alarms[0].ring_at(0)
    executor = EventsExecutor(context=context)
    executor.add_node(node)
    end = time.monotonic() + 2 * LIMIT
    while rung < 500:
        executor.spin_once(timeout_sec=1.0)
        calls += 1
        assert time.monotonic() < end, f"after {calls} calls only {rung} have rung"
    executor.shutdown()
    node.destroy_node()
    rclpy.shutdown(context=context)
    assert calls < 2 * rung


def alarm_on(
    clockwork: Clockwork, put_off: Callable[[], int] | None = None
) -> tuple[Alarm, list[int]]:
    """Return an alarm, and the moments at which it rings."""
    rung: list[int] = []

    def ring() -> None:
        rung.append(clockwork.now)

    node: Any = clockwork.node
    return Alarm(node, clockwork.clock, clockwork.read, ring, put_off), rung


@pytest.fixture
def clockwork() -> Clockwork:
    """Give a clock that shows 1000 ns."""
    return Clockwork(1000)
