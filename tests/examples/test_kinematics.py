"""Kinematics of the simulated feeding robot."""

from __future__ import annotations

import math

import pytest

from tests.support.examples import example_module

kinematics = example_module("feeding_robot", "feeding_robot_simulator.kinematics")
Controls, Motion, Vehicle = kinematics.Controls, kinematics.Motion, kinematics.Vehicle
VEHICLE = Vehicle(top_speed=1.5, wheel_base=1.6)


@pytest.mark.parametrize("pedal", [-1.0, -0.3, 0.2, 1.0])
def test_speed_converges_to_the_pedal(pedal: float) -> None:
    """After many time constants the speed is the pedal's share of the top speed."""
    motion = VEHICLE.advance(Motion(), Controls(pedal, engine_on=True), 5.0)
    assert motion.speed == pytest.approx(1.5 * pedal, rel=1e-6)


def test_speed_follows_with_the_lag_of_the_hydraulics() -> None:
    """One time constant after a full pedal the speed has reached 63 % of its final value."""
    motion = VEHICLE.advance(Motion(), Controls(1.0, engine_on=True), kinematics.DRIVE_LAG)
    assert motion.speed == pytest.approx(1.5 * (1 - math.exp(-1)), rel=1e-3)


def test_pedal_beyond_its_range_counts_as_full() -> None:
    """The pedal is limited to its range."""
    far, full = (VEHICLE.advance(Motion(), Controls(p, engine_on=True), 1.0) for p in (7.0, 1.0))
    assert far == full


def test_robot_halts_without_the_engine() -> None:
    """Without pressure the robot stands exactly still within a second, whatever the pedal."""
    motion = VEHICLE.advance(Motion(speed=1.5), Controls(1.0, engine_on=False), 1.0)
    assert motion.speed == 0.0


def test_released_pedal_halts_the_robot_exactly() -> None:
    """The valves close below a creeping speed, so that encoders read zero."""
    assert VEHICLE.advance(Motion(speed=0.4), Controls(0.0, engine_on=True), 3.0).speed == 0.0


def test_straight_distance_is_the_integral_of_the_speed() -> None:
    """At constant speed the robot covers speed times time on a straight line."""
    motion = VEHICLE.advance(Motion(speed=0.6), Controls(0.4, engine_on=True), 10.0)
    assert (motion.x, motion.y, motion.yaw) == (pytest.approx(6.0, rel=1e-6), 0.0, 0.0)


def test_steered_robot_drives_a_circle() -> None:
    """Its radius is the wheel base over the tangent of the steering angle."""
    steering = 0.4
    radius = 1.6 / math.tan(steering)
    lap = math.tau * radius / 0.6
    motion = Motion(speed=0.6)
    half = VEHICLE.advance(motion, Controls(0.4, steering, engine_on=True), lap / 2)
    assert math.hypot(half.x, half.y) == pytest.approx(2 * radius, rel=1e-3)
    assert abs(half.yaw) == pytest.approx(math.pi, rel=1e-3)
    whole = VEHICLE.advance(motion, Controls(0.4, steering, engine_on=True), lap)
    assert (whole.x, whole.y) == (pytest.approx(0.0, abs=0.02), pytest.approx(0.0, abs=0.05))


def test_step_of_zero_duration_changes_nothing() -> None:
    """A repeated step causes no motion."""
    motion = Motion(1.0, 2.0, 0.3, 0.5)
    assert VEHICLE.advance(motion, Controls(1.0, engine_on=True), 0.0) == motion


def test_result_hardly_depends_on_the_step_size() -> None:
    """One second at once or in forty steps gives the same place within a centimetre."""
    controls = Controls(0.5, 0.2, engine_on=True)
    once = VEHICLE.advance(Motion(), controls, 1.0)
    motion = Motion()
    for _ in range(40):
        motion = VEHICLE.advance(motion, controls, 0.025)
    assert math.hypot(once.x - motion.x, once.y - motion.y) < 0.01


def test_obstacle_approaches_by_the_distance_driven() -> None:
    """The clearance ends at zero; no obstacle stays no obstacle."""
    assert kinematics.Obstacle(3.0).approached(0.5).distance == 2.5
    assert kinematics.Obstacle(0.2).approached(0.5).distance == 0.0
    assert kinematics.Obstacle().approached(0.5).distance == math.inf


@pytest.mark.parametrize("angles", [(0.3, 0.0, 0.0), (0.0, -0.2, 0.0), (0.1, 0.2, 2.5)])
def test_quaternion_round_trips_roll_pitch_yaw(angles: tuple[float, ...]) -> None:
    """Converted there and back, the angles are the same."""
    x, y, z, w = kinematics.quaternion(*angles)
    roll = math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    pitch = math.asin(2 * (w * y - z * x))
    yaw = math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    assert (roll, pitch, yaw) == pytest.approx(angles)


def test_uneven_ground_stays_below_the_tilt_limit() -> None:
    """Driving over the yard never comes near the limit of 8 degrees."""
    tilts = [abs(a) for k in range(2000) for a in kinematics.unevenness(k * 0.05)]
    assert math.radians(1.0) < max(tilts) < math.radians(2.0)
