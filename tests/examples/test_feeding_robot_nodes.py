"""Decisions of the feeding robot's nodes, without ROS."""

from __future__ import annotations

import math
import random
from typing import Any

import pytest

from tests.support.examples import example_module

logic = example_module("feeding_robot", "feeding_robot_plc.logic")
arbitration = example_module("feeding_robot", "feeding_robot_actuators.arbitration")
mission = example_module("feeding_robot", "feeding_robot_mission.mission")
sweep = example_module("feeding_robot", "feeding_robot_lidar.sweep")
attitude = example_module("feeding_robot", "feeding_robot_imu.attitude")
Contact, Light, Mode = logic.Contact, logic.Light, logic.Mode


def plc(**state: Any) -> Any:
    """Return a PLC with watchdogs fed at time 0 and a timeout of half a second."""
    return logic.PlcLogic(logic.Watchdog(0.5, 0.0), logic.Watchdog(0.5, 0.0), **state)


def driving() -> Any:
    """Return a PLC in automatic mode with the engine on."""
    return plc(mode=Mode.AUTOMATIC, engine_enabled=True)


# The PLC ------------------------------------------------------------------------------------------


def test_key_starts_the_engine_only_in_manual_mode() -> None:
    """The engine of a robot in automatic mode cannot be started with the key."""
    for mode in Mode:
        each = plc(mode=mode, key_turned=True)
        each.supervise(0.1)
        assert each.engine_enabled is (mode is Mode.MANUAL)


@pytest.mark.parametrize("contact", list(Contact))
@pytest.mark.parametrize("mode", list(Mode))
def test_every_contact_shuts_off_the_engine_in_every_mode(contact: Any, mode: Any) -> None:
    """The contacts are wired to the fuel valve; the PLC reports which one opened."""
    each = plc(mode=mode, engine_enabled=True, pressed={contact})
    assert each.supervise(0.1) == [contact.value]
    assert not each.engine_enabled


def test_motor_stop_shuts_off_the_engine_and_keeps_it_off() -> None:
    """While the motor stop of the safety node is active, the key has no effect."""
    each = plc(engine_enabled=True, motor_stop=True, key_turned=True)
    assert each.supervise(0.1) == ["motor stop of the safety node"]
    assert each.supervise(0.2) == []
    assert not each.engine_enabled


@pytest.mark.parametrize("name", ["controller", "safety_node"])
def test_silent_keep_alive_shuts_off_the_engine_after_its_timeout(name: str) -> None:
    """The engine runs until the timeout, and is off just after it."""
    each = driving()
    other = "safety_node" if name == "controller" else "controller"
    getattr(each, other).last = 0.5
    assert each.supervise(0.5) == []
    assert len(each.supervise(0.501)) == 1
    assert not each.engine_enabled


def test_manual_mode_needs_no_keep_alives() -> None:
    """An operator can drive the machine home with its computer dead."""
    each = plc(engine_enabled=True)
    assert each.supervise(100.0) == []
    assert each.engine_enabled


def test_engine_stays_off_when_the_reason_disappears() -> None:
    """Releasing a bumper does not start the engine."""
    each = driving()
    each.pressed = {Contact.FRONT_BUMPER}
    each.supervise(0.1)
    each.pressed = set()
    each.supervise(0.2)
    assert not each.engine_enabled


@pytest.mark.parametrize(
    ("changes", "light"),
    [
        ({}, Light.GREEN),
        ({"slow": True}, Light.AMBER),
        ({"mode": Mode.LEARN}, Light.AMBER),
        ({"stopped": True}, Light.RED),
        ({"engine_enabled": False}, Light.RED),
        ({"slow": True, "stopped": True}, Light.RED),
    ],
)
def test_stack_light_shows_the_state(changes: dict[str, Any], light: Any) -> None:
    """Green is driving, amber is slow or supervised driving, red is standing."""
    each = driving()
    for name, value in changes.items():
        setattr(each, name, value)
    assert each.light is light


# The actuators ------------------------------------------------------------------------------------


def arbiter(**state: Any) -> Any:
    """Return an arbiter in automatic mode with a recent command of 0.6 m/s."""
    limits = arbitration.Limits(top_speed=1.5, command_timeout=0.3)
    tested = arbitration.Arbiter(limits, command_at=0.0, mode=2)
    tested.command(0.6, 0.1, 0.0)
    for name, value in state.items():
        setattr(tested, name, value)
    return tested


def test_pedal_follows_the_command() -> None:
    """The pedal is the commanded share of the top speed, the steering the commanded angle."""
    assert arbiter().decide(0.1) == (pytest.approx(0.4), 0.1)


@pytest.mark.parametrize("mode", [0, 1])
def test_pedal_is_neutral_outside_automatic_mode(mode: int) -> None:
    """The operator has precedence over all software."""
    assert arbiter(mode=mode).decide(0.1)[0] == 0.0


@pytest.mark.parametrize(("wanted", "pedal"), [(9.0, 1.0), (-9.0, -1.0), (0.0, 0.0)])
def test_pedal_is_limited_to_its_range(wanted: float, pedal: float) -> None:
    """No command moves it further than it goes."""
    tested = arbiter()
    tested.command(wanted, 0.0, 0.0)
    assert tested.decide(0.1)[0] == pedal


def test_old_command_expires() -> None:
    """After the death of a gate the robot does not drive on."""
    tested = arbiter()
    assert tested.decide(0.3)[0] > 0
    assert tested.decide(0.31)[0] == 0.0


def test_nothing_moves_before_a_command_and_a_mode() -> None:
    """A new arbiter keeps the robot stopped."""
    tested = arbitration.Arbiter(arbitration.Limits(1.5, 0.3), command_at=0.0)
    assert tested.decide(0.0)[0] == 0.0
    tested.mode = 2
    assert tested.decide(0.0)[0] == 0.0


# The mission --------------------------------------------------------------------------------------


def test_mission_accelerates_to_cruising_speed() -> None:
    """The speed grows with the acceleration up to the cruising speed."""
    tested = mission.Mission(cruise_speed=0.4, acceleration=0.5)
    speeds = [tested.plan(True, 0.0, 0.0, 0.2).speed for _ in range(8)]
    assert speeds == pytest.approx([0.1, 0.2, 0.3, 0.4, 0.4, 0.4, 0.4, 0.4])


def test_mission_restarts_from_standstill_after_a_stop() -> None:
    """It does not try to catch up."""
    tested = mission.Mission(0.4, 0.5, speed=0.4)
    assert tested.plan(False, 0.0, 0.0, 0.2) == mission.Command()
    assert tested.plan(True, 0.0, 0.0, 0.2).speed == pytest.approx(0.1)


def test_mission_steers_back_into_the_lane() -> None:
    """Left of the lane it steers right, within the steering range."""
    tested = mission.Mission(0.4, 0.5)
    assert (
        tested.plan(True, 0.3, 0.0, 0.1).steering < 0 < tested.plan(True, 0.0, -0.2, 0.1).steering
    )
    assert tested.plan(True, 50.0, 0.0, 0.1).steering == -mission.LARGEST_STEERING


# The sensors --------------------------------------------------------------------------------------


def test_scan_sees_an_obstacle_straight_ahead_at_its_distance() -> None:
    """The shortest range is the clearance, in the middle beam, and the outer beams miss it."""
    ranges = sweep.ranges(2.0, 181, 25.0)
    assert min(ranges) == ranges[90] == pytest.approx(2.0)
    assert ranges[0] == ranges[180] == math.inf
    assert ranges == pytest.approx(ranges[::-1])


@pytest.mark.parametrize("clearance", [math.inf, 30.0])
def test_free_beams_are_infinite(clearance: float) -> None:
    """Without an obstacle, or with one out of range, every beam is free."""
    assert set(sweep.ranges(clearance, 181, 25.0)) == {math.inf}


def test_imu_noise_has_the_given_deviation() -> None:
    """Over many measurements roll varies around the truth with the given deviation."""
    noise = random.Random(5)
    rolls = [2 * attitude.disturbed((0.0, 0.0, 0.0, 1.0), 0.01, noise)[0] for _ in range(4000)]
    deviation = math.sqrt(sum(roll * roll for roll in rolls) / len(rolls))
    assert deviation == pytest.approx(0.01, rel=0.05)
    assert abs(sum(rolls) / len(rolls)) < 0.001


def test_noisy_attitude_is_still_a_rotation() -> None:
    """Without noise the attitude is the truth; with noise the quaternion keeps its length."""
    truth = (0.1, -0.2, 0.3, math.sqrt(1 - 0.14))
    noise = random.Random(6)
    assert attitude.disturbed(truth, 0.0, noise) == pytest.approx(truth)
    shown = attitude.disturbed(truth, 0.1, noise)
    assert math.hypot(*shown) == pytest.approx(1.0)
    assert shown != pytest.approx(truth)
