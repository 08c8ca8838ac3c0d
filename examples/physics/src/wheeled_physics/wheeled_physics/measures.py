"""The measures of robots with two driven wheels, and the world that MuJoCo makes of them."""

from __future__ import annotations

from dataclasses import dataclass, replace
import math
import random


@dataclass(frozen=True)
class Bank:
    """Where, in m straight ahead of the start, the floor begins to rise, and its angle in rad."""

    distance: float
    angle: float


@dataclass(frozen=True)
class Measures:
    """
    A robot in SI units: metres, kilograms, seconds, volts, newton metres.

    The casters are that far before the axle, and so is the centre of mass, by ``balance``;
    what is behind it is negative. The stall torque is that of one motor at the nominal voltage,
    the top speed (rad/s) that of a wheel without load; the gear resists with its friction
    (N m). The delay is that of the encoders' counts on their way to the computer. Walls are
    that far from where the robot starts, on four sides; without any, the floor has no end. The
    attitude is what an IMU shows of roll, pitch and yaw, with its noise in rad and its delay.
    """

    wheel_radius: float
    wheel_distance: float
    ticks_per_turn: float
    body_radius: float
    body_height: float
    mass: float
    wheel_mass: float
    casters: tuple[float, ...]
    balance: float
    top_speed: float
    stall_torque: float
    gear_friction: float
    nominal_voltage: float
    empty_voltage: float
    encoder_delay: float
    gyro_noise: float
    attitude_noise: float = 0.0
    attitude_delay: float = 0.0
    floor_friction: float = 0.8
    walls: float | None = None
    bank: Bank | None = None


FROBIT = Measures(
    wheel_radius=0.051,
    wheel_distance=0.215,
    ticks_per_turn=180,
    body_radius=0.12,
    body_height=0.08,
    mass=3.0,  # not public: our assumption, as are motors, casters and noise
    wheel_mass=0.15,
    casters=(0.1, -0.1),
    balance=-0.02,
    top_speed=12.0,
    stall_torque=0.6,
    gear_friction=0.03,
    nominal_voltage=12.8,
    empty_voltage=10.5,
    encoder_delay=0.05,
    gyro_noise=0.005,
)
"""FroboMind's Frobit: wheels, ticks and delay as its software has them."""

KOBUKI = Measures(
    wheel_radius=0.035,
    wheel_distance=0.23,
    ticks_per_turn=2578.33,
    body_radius=0.178,
    body_height=0.109,
    mass=2.2,  # 2.4 with its wheels
    wheel_mass=0.1,
    casters=(0.115, -0.135),
    balance=-0.01,  # our assumption, as are motors, delay, noise and walls
    top_speed=20.0,
    stall_torque=0.6,
    gear_friction=0.03,
    nominal_voltage=16.5,
    empty_voltage=13.2,
    encoder_delay=0.02,
    gyro_noise=0.005,
    walls=2.0,
)
"""The Kobuki: wheels, body, casters, ticks and battery as its software has them."""

INTELLIGENT_ONE = Measures(
    wheel_radius=0.15,
    wheel_distance=0.5,
    ticks_per_turn=10000,
    body_radius=0.35,
    body_height=0.2,
    mass=30.0,
    wheel_mass=1.5,
    casters=(-0.45,),
    balance=-0.08,
    top_speed=6.0,
    stall_torque=20.0,
    gear_friction=1.0,
    nominal_voltage=25.2,
    empty_voltage=21.0,
    encoder_delay=0.02,
    gyro_noise=0.005,
    attitude_noise=math.radians(0.3),
    attitude_delay=0.02,
    bank=Bank(3.0, math.radians(15.0)),
)
"""The Intelligent One on a field with a bank: all our assumption, as nothing is public."""

SPREAD = {
    'mass': 0.1,
    'floor_friction': 0.15,
    'gear_friction': 0.15,
    'stall_torque': 0.1,
    'top_speed': 0.05,
    'nominal_voltage': 0.02,
    'encoder_delay': 0.3,
}
"""By how much, as a share, robots of one kind differ; our assumption."""


def individual(kind: Measures, seed: int) -> Measures:
    """Return one robot of a kind: no two are the same. A seed stands for the same one always."""
    chance = random.Random(seed)
    drawn = {
        name: getattr(kind, name) * (1.0 + chance.uniform(-share, share))
        for name, share in SPREAD.items()
    }
    return replace(kind, **drawn)


STEP = 0.002
"""Time, in s, of one step of the physics."""

CASTER_RADIUS, CASTER_GAP = 0.015, 0.002
"""Radius, in m, of a caster, and how far it is off the floor while the others carry the robot."""

FREE, BLOCKED = 0.02, 1.2
"""Friction of a caster that rolls, and of one that is blocked and scrapes."""

WALLS = 2
"""The bit of what only the shell touches: all else touches the floor."""


def world(measures: Measures) -> str:
    """Return the robot on its floor, as MJCF; wheels are ``left`` and ``right``."""
    radius, half = measures.wheel_radius, measures.wheel_distance / 2
    wheels = ''.join(_wheel(measures, *each) for each in (('left', half), ('right', -half)))
    casters = ''.join(
        f'<geom name="caster{number}" type="sphere" size="{CASTER_RADIUS}" mass="0.02"'
        f' pos="{x} 0 {CASTER_RADIUS + CASTER_GAP - radius}" friction="{FREE} 0 0" priority="1"/>'
        for number, x in enumerate(measures.casters)
    )
    motors = ''.join(_motor(measures, name) for name in ('left', 'right'))
    return f"""<mujoco>
  <option timestep="{STEP}" integrator="implicitfast"/>
  <worldbody>
    {_floor(measures)}{_walls(measures.walls)}
    <body name="body" pos="0 0 {radius}">
      <freejoint name="free"/>
      <geom name="shell" type="cylinder" size="{measures.body_radius} {measures.body_height / 2}"
        pos="{measures.balance} 0 {measures.body_height / 2}" mass="{measures.mass}"
        contype="{WALLS}" conaffinity="{WALLS}"/>
      {casters}{wheels}
    </body>
  </worldbody>
  <actuator>{motors}</actuator>
</mujoco>
"""


def _wheel(measures: Measures, name: str, y: float) -> str:
    # MuJoCo takes the larger friction of two that touch: that of the floor is to count.
    return (
        f'<body name="{name}" pos="0 {y} 0"><joint name="{name}" type="hinge" axis="0 1 0"'
        f' damping="0.001" frictionloss="{measures.gear_friction}" armature="0.001"/>'
        f'<geom name="{name}" type="cylinder" size="{measures.wheel_radius} 0.01"'
        f' euler="90 0 0" mass="{measures.wheel_mass}"'
        f' friction="{measures.floor_friction} 0.005 0.0001"/></body>'
    )


def _motor(measures: Measures, name: str) -> str:
    """Return a motor whose control is the share of the nominal voltage: it gets slower by load."""
    torque = measures.stall_torque
    return (
        f'<general name="{name}" joint="{name}" gainprm="{torque}" biastype="affine"'
        f' biasprm="0 0 {-torque / measures.top_speed}" forcelimited="true"'
        f' forcerange="{-torque} {torque}"/>'
    )


def _floor(measures: Measures) -> str:
    """Return the level floor and, if there is one, the plane that rises out of it."""
    planes = [('floor', Bank(0.0, 0.0))]
    if measures.bank is not None:
        planes.append(('bank', measures.bank))
    return ''.join(
        f'<geom name="{name}" type="plane" size="50 50 0.1" pos="{plane.distance} 0 0"'
        f' zaxis="{-math.sin(plane.angle)} 0 {math.cos(plane.angle)}"'
        f' friction="{measures.floor_friction} 0.005 0.0001"/>'
        for name, plane in planes
    )


def _walls(distance: float | None) -> str:
    if distance is None:
        return ''
    return ''.join(
        f'<geom name="wall{number}" type="plane" size="5 5 0.1" pos="{x * distance}'
        f' {y * distance} 0" zaxis="{-x} {-y} 0" contype="{WALLS}" conaffinity="{WALLS}"/>'
        for number, (x, y) in enumerate(((1, 0), (0, 1), (-1, 0), (0, -1)))
    )
