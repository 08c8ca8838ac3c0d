"""How the feeding robot moves: single-track Ackermann kinematics behind a hydraulic drive."""

from __future__ import annotations

from dataclasses import dataclass, replace
import math

DRIVE_LAG = 0.25
"""Time constant, in s, with which the speed follows the pedal."""

BRAKE_LAG = 0.12
"""Time constant, in s, with which the robot halts once the hydraulics have no pressure."""

CREEP = 1e-3
"""Speed, in m/s, below which the valves are shut and the robot stands."""

IDLE_SPEED = 94.2
"""Crankshaft speed, in rad/s, of the engine at 900 revolutions a minute."""

LARGEST_STEP = 0.02
"""Longest time, in s, that one step of integration covers."""


@dataclass(frozen=True)
class Motion:
    """Pose and speed at one instant, in the frame of the yard (metres, radians, seconds)."""

    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0
    speed: float = 0.0
    yaw_rate: float = 0.0


@dataclass(frozen=True)
class Controls:
    """
    What acts on the machine.

    The pedal goes from -1 (full backward) to 1 (full forward), 0 holds the robot. The steering is
    the angle of the front wheels in rad, positive to the left. The engine gives the hydraulics
    their pressure.
    """

    pedal: float = 0.0
    steering: float = 0.0
    engine_on: bool = False


@dataclass(frozen=True)
class Vehicle:
    """The machine's dimensions: full speed in m/s, distance of the axles in m."""

    top_speed: float = 1.5
    wheel_base: float = 1.6

    def advance(self, motion: Motion, controls: Controls, duration: float) -> Motion:
        """Return the motion ``duration`` seconds later under constant controls."""
        steps = max(1, math.ceil(duration / LARGEST_STEP))
        for _ in range(steps):
            motion = self._step(motion, controls, duration / steps)
        return motion

    def _step(self, motion: Motion, controls: Controls, duration: float) -> Motion:
        pedal = max(-1.0, min(1.0, controls.pedal))
        target = pedal * self.top_speed if controls.engine_on else 0.0
        lag = DRIVE_LAG if controls.engine_on else BRAKE_LAG
        speed = target + (motion.speed - target) * math.exp(-duration / lag)
        if target == 0.0 and abs(speed) < CREEP:
            speed = 0.0
        yaw_rate = speed * math.tan(controls.steering) / self.wheel_base
        yaw = math.remainder(motion.yaw + yaw_rate * duration, math.tau)
        return replace(
            motion,
            x=motion.x + speed * math.cos(yaw) * duration,
            y=motion.y + speed * math.sin(yaw) * duration,
            yaw=yaw,
            speed=speed,
            yaw_rate=yaw_rate,
        )


@dataclass(frozen=True)
class Obstacle:
    """Something ahead of the robot; ``distance`` (m) is infinite while there is nothing."""

    distance: float = math.inf

    def approached(self, travelled: float) -> Obstacle:
        """Return the obstacle after the robot has driven ``travelled`` metres towards it."""
        return Obstacle(max(0.0, self.distance - travelled))


def unevenness(x: float) -> tuple[float, float]:
    """Return roll and pitch (rad) of the uneven ground at ``x``; at most 1.5 degrees."""
    return math.radians(1.5) * math.sin(1.9 * x), math.radians(1.1) * math.sin(1.3 * x + 1.0)


def quaternion(roll: float, pitch: float, yaw: float) -> tuple[float, float, float, float]:
    """Return ``(x, y, z, w)`` of the rotation by roll, pitch and yaw, in rad (REP 103)."""
    cr, sr = math.cos(roll / 2), math.sin(roll / 2)
    cp, sp = math.cos(pitch / 2), math.sin(pitch / 2)
    cy, sy = math.cos(yaw / 2), math.sin(yaw / 2)
    return (
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    )
