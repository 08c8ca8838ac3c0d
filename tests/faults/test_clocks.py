"""Faults of time: a wall clock that is set, a simulated clock that pauses, races or restarts."""

from __future__ import annotations

import math
import time
from pathlib import Path

import pytest

from tests.support.faults import PROMPT, Robot
from tests.support.needs import needs
from tests.support.played import TOPICS, imu, load, speed, ticks
from tests.support.preload import WallClock
from tests.support.profiles import slow

pytestmark = pytest.mark.ros

TILTED = math.radians(20.0)
DAY = 86400


@needs("gcc")
@pytest.mark.parametrize("seconds", [slow(400 * DAY), -3600])
def test_wall_clock_step_has_no_effect(robot: Robot, tmp_path: Path, seconds: int) -> None:
    """Setting the system clock neither stops the robot nor prevents a stop."""
    wall_clock = WallClock(tmp_path)
    with robot.safety_node(**wall_clock.env), robot.sensors(TOPICS, **wall_clock.env) as sensors:
        sensors.drive()
        robot.until_free()
        halts = len(robot.states["/halt"])
        wall_clock.step(seconds)
        robot.until_beats()
        assert not any(state.value for state in robot.states["/halt"][halts:]), (
            "stopped without a cause"
        )
        sensors.play("/imu", imu(TILTED))
        robot.until_stopped("/halt", limit=0.4 + 1.0)
        sensors.play("/imu", imu())
        robot.until_free()
        wall_clock.step(0)
        sensors.quiet("/speed")
        robot.until_stopped("/halt", limit=0.5 + 1.0)


@needs("gcc")
@pytest.mark.slow
def test_timers_survive_a_wall_clock_step(robot: Robot, tmp_path: Path) -> None:
    """Set back by a year, without messages, the node keeps its heartbeat and its deadlines."""
    wall_clock = WallClock(tmp_path)
    with robot.safety_node(**wall_clock.env), robot.sensors(TOPICS, **wall_clock.env) as sensors:
        for seconds in (400 * DAY, 0, -400 * DAY):
            wall_clock.step(seconds)
            robot.until_beats()
        sensors.drive()
        robot.until_free()
        sensors.freeze()
        wall_clock.step(-800 * DAY)
        robot.until_stopped("/halt", limit=0.5 + 1.0)


SIMULATED = "use_sim_time:=true"
WITH_CLOCK = {**TOPICS, "/clock": "rosgraph_msgs/msg/Clock"}


@pytest.mark.slow
def test_paused_simulation_misses_timeouts_but_not_immediate_stops(robot: Robot) -> None:
    """Paused time pauses timeouts and the heartbeat, but immediate rules still act."""
    with robot.sensors(WITH_CLOCK) as sensors:
        sensors.play("/clock", *ticks())
        with robot.safety_node(SIMULATED):
            sensors.drive()
            robot.until_free()
            sensors.quiet("/clock")
            robot.until_silent()
            sensors.quiet("/speed")
            beats = len(robot.beats)
            robot.spin(1.0)
            assert len(robot.beats) == beats, "the heartbeat continues in a paused simulation"
            assert not robot.is_active("/halt"), "a timeout expired while time was paused"
            sensors.play("/speed", speed(2.0))
            robot.until_stopped(limit=PROMPT)
            sensors.play("/clock", *ticks(2000.0))


@pytest.mark.slow
def test_restarted_simulation_is_reported_and_monitored(robot: Robot) -> None:
    """After the step back everything is unknown, and every rule works as from the start."""
    with robot.sensors(WITH_CLOCK) as sensors:
        sensors.play("/clock", *ticks())
        with robot.safety_node(SIMULATED) as node:
            sensors.drive()
            robot.until_free()
            sensors.play("/clock", *ticks(10.0))
            robot.until_alive()
            assert "the clock stepped back" in node.output()
            sensors.play("/imu", imu(TILTED))
            robot.until_stopped("/halt", limit=0.4 + 1.0)
            sensors.play("/imu", imu())
            robot.until_free()
            sensors.quiet("/speed")
            robot.until_stopped("/halt", limit=0.5 + 1.0)


@pytest.mark.slow
def test_fast_simulation_counts_simulated_time(robot: Robot) -> None:
    """At twenty times the speed, 20 s pass in one: neither earlier nor 20 s later."""
    with robot.sensors(WITH_CLOCK) as sensors:
        sensors.play("/clock", *ticks(step=0.1), rate=200.0)
        with robot.safety_node(SIMULATED):
            sensors.match("/load")
            sensors.send("/load", load(0.0))
            robot.until_alive()
            begun = time.monotonic()
            sensors.send("/load", load(45.0))
            robot.until_stopped("/slow", limit=5.0)
            # The player of the clock may be a few ticks ahead, to catch up.
            assert time.monotonic() - begun >= (20.0 - 6 * 0.1) / 20
