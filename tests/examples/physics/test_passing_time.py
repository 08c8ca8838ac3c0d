"""Time in physics: as on the machine, or simulated, as other nodes hear of it."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import pytest
from builtin_interfaces.msg import Time

from tests.support.examples import example_module

pytest.importorskip("mujoco", reason="the extra 'physics' is not installed")

passing_time = example_module("physics", "wheeled_physics.passing_time")
RealTime, SimulatedTime = passing_time.RealTime, passing_time.SimulatedTime
PULSE = 0.01


class Machine:
    """A clock that a test lets run, from 100 s on."""

    def __init__(self) -> None:
        """Stand."""
        self.now = 100.0

    def steady(self) -> float:
        """Return the time in s."""
        return self.now

    def stamp(self) -> Time:
        """Return it as a stamp."""
        return Time(sec=int(self.now))


@pytest.mark.parametrize("cycle", [0.0173, 0.02, 0.031])
def test_real_time_is_made_up_for_in_whole_pulses(cycle: float) -> None:
    """Cycles that are no whole number of them lose nothing."""
    machine = Machine()
    time = RealTime(machine.steady, machine.stamp)
    pulses = 0
    for _ in range(500):
        machine.now += cycle
        pulses += time.pass_on()
        assert machine.now - 100.0 - pulses * PULSE == pytest.approx(0.005, abs=0.0051)
    assert time.stamp().sec == int(machine.now)


def test_real_time_does_not_leap() -> None:
    """After five seconds in which the machine held it up, 0.1 s pass, and then as ever."""
    machine = Machine()
    time = RealTime(machine.steady, machine.stamp)
    machine.now += 5.0
    assert time.pass_on() == 10
    assert time.pass_on() == 0
    machine.now += 0.021
    assert time.pass_on() == 2


def nanoseconds(stamp: Any) -> int:
    """Return a stamp in ns."""
    return int(stamp.sec) * 10**9 + int(stamp.nanosec)


def test_simulated_time_is_published_before_what_it_stamps() -> None:
    """Each cycle once, 20 ms after the one before, from 20 ms on: zero is no time to a node."""
    heard: list[Any] = []
    time = SimulatedTime(heard.append)
    for cycle in range(1, 201):
        assert time.pass_on() == 2
        assert len(heard) == cycle
        assert heard[-1].clock == time.stamp()
    times = [nanoseconds(each.clock) for each in heard]
    assert times[0] == 20_000_000
    assert {after - before for before, after in pairwise(times)} == {20_000_000}
    assert (time.stamp().sec, time.stamp().nanosec) == (4, 0)
