"""The measures of robots with two driven wheels, and the world that MuJoCo makes of them."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Measures:
    """
    A robot in SI units: metres, kilograms, seconds, volts, newton metres.

    The casters are that far before the axle, and so is the centre of mass, by ``balance``;
    what is behind it is negative. The stall torque is that of one motor at the nominal voltage,
    the top speed (rad/s) that of a wheel without load. The delay is that
    of the encoders' counts on their way to the computer.
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
    nominal_voltage: float
    empty_voltage: float
    encoder_delay: float
    gyro_noise: float


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
    nominal_voltage=12.8,
    empty_voltage=10.5,
    encoder_delay=0.05,
    gyro_noise=0.005,
)
"""FroboMind's Frobit: wheels, ticks and delay as its software has them."""

STEP = 0.002
"""Time, in s, of one step of the physics."""

CASTER_RADIUS, CASTER_GAP = 0.015, 0.002
"""Radius, in m, of a caster, and how far it is off the floor while the others carry the robot."""

GEAR_FRICTION = 0.03
"""Torque, in N m, that a wheel without voltage resists with; our assumption, too."""

FREE, BLOCKED = 0.02, 1.2
"""Friction of a caster that rolls, and of one that is blocked and scrapes."""


def world(measures: Measures) -> str:
    """Return the robot on a level floor, as MJCF; wheels are ``left`` and ``right``."""
    radius, half = measures.wheel_radius, measures.wheel_distance / 2
    wheels = ''.join(_wheel(measures, *each) for each in (('left', half), ('right', -half)))
    casters = ''.join(
        f'<geom name="caster{number}" type="sphere" size="{CASTER_RADIUS}" mass="0.02"'
        f' pos="{x} 0 {CASTER_RADIUS + CASTER_GAP - radius}" friction="{FREE} 0 0" priority="1"/>'
        for number, x in enumerate(measures.casters)
    )
    return f"""<mujoco>
  <option timestep="{STEP}" integrator="implicitfast"/>
  <worldbody>
    <geom name="floor" type="plane" size="50 50 0.1" friction="0.8 0.005 0.0001"/>
    <body name="body" pos="0 0 {radius}">
      <freejoint name="free"/>
      <geom name="shell" type="cylinder" size="{measures.body_radius} {measures.body_height / 2}"
        pos="{measures.balance} 0 {measures.body_height / 2}" mass="{measures.mass}"
        contype="0" conaffinity="0"/>
      {casters}{wheels}
    </body>
  </worldbody>
  <actuator>
    <motor name="left" joint="left"/>
    <motor name="right" joint="right"/>
  </actuator>
</mujoco>
"""


def _wheel(measures: Measures, name: str, y: float) -> str:
    return (
        f'<body name="{name}" pos="0 {y} 0"><joint name="{name}" type="hinge" axis="0 1 0"'
        f' damping="0.001" frictionloss="{GEAR_FRICTION}" armature="0.001"/>'
        f'<geom name="{name}" type="cylinder" size="{measures.wheel_radius} 0.01"'
        f' euler="90 0 0" mass="{measures.wheel_mass}" friction="0.9 0.005 0.0001"/></body>'
    )
