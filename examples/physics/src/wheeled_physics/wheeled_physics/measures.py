"""The measures of robots with two driven wheels, and the world that MuJoCo makes of them."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
import math
import random


@dataclass(frozen=True)
class Bank:
    """Where, in m straight ahead of the start, the floor begins to rise, and its angle in rad."""

    distance: float
    angle: float


@dataclass(frozen=True)
class Lidar:
    """
    A laser scanner that looks ahead: m, rad.

    It is that far before the axle and above the ground. Its beams are spread evenly to either
    side, the first to the right; each measures between its ranges, with that much noise.
    """

    ahead: float
    height: float
    beams: int
    half_angle: float
    range_min: float
    range_max: float
    noise: float


@dataclass(frozen=True)
class Thing:
    """
    A box that may get in a robot's way, in m and rad.

    The size is half of its length, width and height; its middle comes to be that far ahead of the
    axle, to the left, and above the ground, with its near end down by the slope. What ``blocks``
    touches the shell; wheels and casters drive onto all else.
    """

    size: tuple[float, float, float]
    place: tuple[float, float, float]
    slope: float = 0.0
    blocks: bool = True


@dataclass(frozen=True)
class Measures:
    """
    A robot in SI units: metres, kilograms, seconds, volts, newton metres.

    The casters are that far before the axle, and so is the centre of mass, by ``balance``;
    what is behind it is negative. The stall torque is that of one motor at the nominal voltage,
    the top speed (rad/s) that of a wheel without load; the gear resists with its friction
    (N m). The delay is that of the encoders' counts on their way to the computer. Walls are
    that far from where the robot starts, on four sides, or of an alley on two; without any, the
    floor has no end. The attitude is what an IMU shows of roll, pitch and yaw, with its noise in
    rad and its delay. The inertia (kg m^2) is that of a motor behind its gear; the brake (N m)
    holds a wheel while the motors have no supply. Things get in the way when they are to.
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
    alley: float | None = None
    motor_inertia: float = 0.001
    brake: float = 0.0
    lidar: Lidar | None = None
    things: dict[str, Thing] = field(default_factory=dict)


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

FEEDING_ROBOT = Measures(
    wheel_radius=0.3,
    wheel_distance=1.1,
    ticks_per_turn=10000,
    body_radius=0.7,
    body_height=0.8,
    mass=500.0,
    wheel_mass=25.0,
    casters=(0.6, -0.6),
    balance=-0.05,
    top_speed=5.5,
    stall_torque=350.0,
    gear_friction=10.0,
    nominal_voltage=200.0,  # the pressure of its hydraulics, in bar; the engine keeps it up
    empty_voltage=200.0,
    encoder_delay=0.02,
    gyro_noise=0.005,
    attitude_noise=math.radians(0.3),
    attitude_delay=0.02,
    alley=3.0,
    motor_inertia=0.5,
    brake=300.0,
    lidar=Lidar(0.75, 0.5, 181, math.pi / 2, 0.05, 25.0, 0.01),
    things={
        'obstacle': Thing((0.4, 0.8, 0.6), (6.15, 0.0, 0.6)),  # a bale, 5 m before the scanner
        'person': Thing((0.15, 0.25, 0.9), (2.1, 0.0, 0.9)),  # 1.2 m before the scanner
        'crate': Thing((0.3, 0.4, 0.2), (2.0, 0.0, 0.2)),  # lower than what the scanner sees
        'ramp': Thing((2.0, 0.25, 0.1), (3.0, 0.55, 0.02), math.radians(8.0), blocks=False),
    },
)
"""The feeding robot in its alley: but for the scanner and the top speed, all our assumption."""

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

FLOOR, WALLS = 1, 2
"""The bits of what wheels and casters touch, and of what only the shell does."""

DEPTH = -100.0
"""Where, in m below the floor, a thing is that is not in the way."""


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
    things = ''.join(_thing(name, thing) for name, thing in measures.things.items())
    return f"""<mujoco>
  <option timestep="{STEP}" integrator="implicitfast"/>
  <worldbody>
    {_floor(measures)}{_walls(measures)}{things}
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
    # MuJoCo takes the larger friction of two that touch: that of the floor is to count. Its joints
    # creep under load, as brakes do not, unless their friction is a firm one.
    firm = ' solimpfriction="0.999 0.9999 0.001"' if measures.brake else ''
    return (
        f'<body name="{name}" pos="0 {y} 0"><joint name="{name}" type="hinge" axis="0 1 0"'
        f' damping="0.001" frictionloss="{measures.gear_friction}"'
        f' armature="{measures.motor_inertia}"{firm}/>'
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
        f'<geom name="{name}" type="plane" size="0 0 0.1" pos="{plane.distance} 0 0"'
        f' zaxis="{-math.sin(plane.angle)} 0 {math.cos(plane.angle)}"'
        f' friction="{measures.floor_friction} 0.005 0.0001"/>'
        for name, plane in planes
    )


def _walls(measures: Measures) -> str:
    """Return planes that only the shell touches: they have no end."""
    sides = dict.fromkeys(((1, 0), (0, 1), (-1, 0), (0, -1)), measures.walls)
    if measures.alley is not None:
        sides = dict.fromkeys(((0, 1), (0, -1)), measures.alley)
    return ''.join(
        f'<geom name="wall{number}" type="plane" size="0 0 0.1" pos="{x * distance}'
        f' {y * distance} 0" zaxis="{-x} {-y} 0" contype="{WALLS}" conaffinity="{WALLS}"/>'
        for number, ((x, y), distance) in enumerate(sides.items())
        if distance is not None
    )


def _thing(name: str, thing: Thing) -> str:
    """Return a thing far below the floor, where it waits; nothing moves it but its mocap body."""
    touches = WALLS if thing.blocks else FLOOR
    return (
        f'<body name="{name}" mocap="true" pos="0 0 {DEPTH}"><geom name="{name}" type="box"'
        f' size="{" ".join(map(str, thing.size))}" euler="0 {-math.degrees(thing.slope)} 0"'
        f' contype="{touches}" conaffinity="{touches}"/></body>'
    )
