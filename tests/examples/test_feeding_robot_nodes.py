"""What the feeding robot's nodes decide, without ROS."""

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
    """Return a PLC whose watchdogs were fed at time 0 and bark after half a second."""
    return logic.PlcLogic(logic.Watchdog(0.5, 0.0), logic.Watchdog(0.5, 0.0), **state)


def driving() -> Any:
    """Return a PLC in automatic mode with the engine on."""
    return plc(mode=Mode.AUTOMATIC, engine_enabled=True)


# The PLC ------------------------------------------------------------------------------------------


def test_the_key_starts_the_engine_in_manual_mode_only() -> None:
    """Nobody can start the engine from the driver's seat of a robot that drives itself."""
    for mode in Mode:
        each = plc(mode=mode, key_turned=True)
        each.supervise(0.1)
        assert each.engine_enabled is (mode is Mode.MANUAL)


@pytest.mark.parametrize("contact", list(Contact))
@pytest.mark.parametrize("mode", list(Mode))
def test_every_contact_shuts_the_engine_off_in_every_mode(contact: Any, mode: Any) -> None:
    """The contacts are wired to the fuel valve, whoever drives; and it says which one."""
    each = plc(mode=mode, engine_enabled=True, pressed={contact})
    assert each.supervise(0.1) == [contact.value]
    assert not each.engine_enabled


def test_the_motor_stop_shuts_the_engine_off_and_keeps_it_off() -> None:
    """While the safety node's motor stop is active, the key does nothing."""
    each = plc(engine_enabled=True, motor_stop=True, key_turned=True)
    assert each.supervise(0.1) == ["motor stop of the safety node"]
    assert each.supervise(0.2) == []
    assert not each.engine_enabled


@pytest.mark.parametrize("name", ["controller", "safety_node"])
def test_a_silent_keep_alive_shuts_the_engine_off_after_its_timeout(name: str) -> None:
    """Up to the timeout the engine runs on; just beyond it, it does not."""
    each = driving()
    other = "safety_node" if name == "controller" else "controller"
    getattr(each, other).last = 0.5
    assert each.supervise(0.5) == []
    assert len(each.supervise(0.501)) == 1
    assert not each.engine_enabled


def test_in_manual_mode_nobody_waits_for_keep_alives() -> None:
    """An operator can drive the machine home with its computer dead."""
    each = plc(engine_enabled=True)
    assert each.supervise(100.0) == []
    assert each.engine_enabled


def test_what_was_shut_off_stays_off_when_the_reason_goes() -> None:
    """A released bumper does not start an engine."""
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
def test_the_stack_light_tells_the_state(changes: dict[str, Any], light: Any) -> None:
    """Green drives, amber drives slowly or under an operator's eyes, red does not drive."""
    each = driving()
    for name, value in changes.items():
        setattr(each, name, value)
    assert each.light is light


# The actuators ------------------------------------------------------------------------------------


def arbiter(**state: Any) -> Any:
    """Return an arbiter in automatic mode that was just told to drive at 0.6 m/s."""
    limits = arbitration.Limits(top_speed=1.5, command_timeout=0.3)
    made = arbitration.Arbiter(limits, command_at=0.0, mode=2)
    made.command(0.6, 0.1, 0.0)
    for name, value in state.items():
        setattr(made, name, value)
    return made


def test_the_pedal_follows_the_command_when_nothing_is_wrong() -> None:
    """The pedal is the wanted share of the top speed, the steering the wanted angle."""
    assert arbiter().decide(0.1) == (pytest.approx(0.4), 0.1)


@pytest.mark.parametrize("mode", [0, 1])
def test_the_pedal_is_neutral_outside_automatic_mode(mode: int) -> None:
    """The operator stands above all software."""
    assert arbiter(mode=mode).decide(0.1)[0] == 0.0


@pytest.mark.parametrize(("wanted", "pedal"), [(9.0, 1.0), (-9.0, -1.0), (0.0, 0.0)])
def test_the_pedal_has_two_ends(wanted: float, pedal: float) -> None:
    """No command moves it further than it goes."""
    made = arbiter()
    made.command(wanted, 0.0, 0.0)
    assert made.decide(0.1)[0] == pedal


def test_an_old_command_is_void() -> None:
    """A gate that has died does not drive on."""
    made = arbiter()
    assert made.decide(0.3)[0] > 0
    assert made.decide(0.31)[0] == 0.0


def test_nothing_moves_before_a_command_and_a_mode() -> None:
    """A fresh arbiter holds the robot."""
    made = arbitration.Arbiter(arbitration.Limits(1.5, 0.3), command_at=0.0)
    assert made.decide(0.0)[0] == 0.0
    made.mode = 2
    assert made.decide(0.0)[0] == 0.0


# The mission --------------------------------------------------------------------------------------


def test_the_mission_ramps_up_to_cruising_speed_and_no_further() -> None:
    """The speed grows by the acceleration and ends at the cruising speed."""
    made = mission.Mission(cruise_speed=0.4, acceleration=0.5)
    speeds = [made.plan(True, 0.0, 0.0, 0.2).speed for _ in range(8)]
    assert speeds == pytest.approx([0.1, 0.2, 0.3, 0.4, 0.4, 0.4, 0.4, 0.4])


def test_after_a_stop_the_mission_begins_from_standstill() -> None:
    """It does not try to catch up."""
    made = mission.Mission(0.4, 0.5, speed=0.4)
    assert made.plan(False, 0.0, 0.0, 0.2) == mission.Command()
    assert made.plan(True, 0.0, 0.0, 0.2).speed == pytest.approx(0.1)


def test_the_mission_steers_back_into_the_lane_within_its_limits() -> None:
    """Left of the lane it steers right, and never further than the wheels turn."""
    made = mission.Mission(0.4, 0.5)
    assert made.plan(True, 0.3, 0.0, 0.1).steering < 0 < made.plan(True, 0.0, -0.2, 0.1).steering
    assert made.plan(True, 50.0, 0.0, 0.1).steering == -mission.LARGEST_STEERING


# The sensors --------------------------------------------------------------------------------------


def test_the_scan_sees_an_obstacle_at_its_distance_straight_ahead() -> None:
    """The shortest range is the clearance, in the middle beam, and the flanks look past it."""
    ranges = sweep.ranges(2.0, 181, 25.0)
    assert min(ranges) == ranges[90] == pytest.approx(2.0)
    assert ranges[0] == ranges[180] == math.inf
    assert ranges == pytest.approx(ranges[::-1])


@pytest.mark.parametrize("clearance", [math.inf, 30.0])
def test_nothing_within_reach_gives_infinities(clearance: float) -> None:
    """No obstacle, or one beyond the scanner's range: every beam is free."""
    assert set(sweep.ranges(clearance, 181, 25.0)) == {math.inf}


def test_the_noise_of_the_imu_has_the_deviation_asked_for() -> None:
    """Over many measurements roll scatters around the truth with the given deviation."""
    noise = random.Random(5)
    rolls = [2 * attitude.disturbed((0.0, 0.0, 0.0, 1.0), 0.01, noise)[0] for _ in range(4000)]
    deviation = math.sqrt(sum(roll * roll for roll in rolls) / len(rolls))
    assert deviation == pytest.approx(0.01, rel=0.05)
    assert abs(sum(rolls) / len(rolls)) < 0.001


def test_without_noise_the_attitude_is_the_truth_and_it_stays_a_rotation_with_noise() -> None:
    """No deviation changes nothing; any keeps the quaternion's length."""
    truth = (0.1, -0.2, 0.3, math.sqrt(1 - 0.14))
    noise = random.Random(6)
    assert attitude.disturbed(truth, 0.0, noise) == pytest.approx(truth)
    shown = attitude.disturbed(truth, 0.1, noise)
    assert math.hypot(*shown) == pytest.approx(1.0)
    assert shown != pytest.approx(truth)
