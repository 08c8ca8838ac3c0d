"""Rules of any number, in the manner of the paper's feeding robot, and the messages they watch.

Fourteen rules make a robot: four entities and thirteen behaviours, as section 7 of the paper counts
them. More rules are more such robots, with other bounds, on the same topics, and what is left over
are bounds of the speed, as the one rule is. The scanner's nearest obstacle comes as a number
(``sensor_msgs.Range``): the cost of arrays does not depend on rules.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.rules import Rules
from deros.rules.compiler.build import build
from deros.rules.program.ir import Program

RULES_OF_A_ROBOT = 14

_NODE = """\
node robot : robot
publishes
  topic /imu : sensor_msgs.Imu
  topic /odometry : nav_msgs.Odometry
  topic /front : sensor_msgs.Range
  topic /plc/mode : std_msgs.UInt8
  topic /plc/stop_button : std_msgs.Bool
  topic /plc/bumper : std_msgs.Bool
  topic /plc/arm : std_msgs.Bool
"""
_TOPICS = ("imu", "odometry", "front", "plc/mode", "plc/stop_button", "plc/bumper", "plc/arm")
_WIRINGS = "".join(f"    connect /{topic} to /{topic}\n" for topic in _TOPICS)
_SYSTEM = f"""\
system Robot
imports
  import "robot.rnd"
topics
{"".join(f"  topic /{topic}" + chr(10) for topic in _TOPICS)}
subsystem Base {{
  node robot : robot
  wirings
{_WIRINGS}}}
"""
_HEAD = """\
use "robot.system" import Robot
action low_speed reset_by controllerOk;
action stop reset_by controllerOk;
action motor_stop publishes true on /motor_stop : std_msgs.Bool latched;
action controllerOk;
"""
_INPUT = """\
input speed = topic /odometry.twist.twist.linear.x timeout 0.5 sec
"""
_INPUTS = """\
input orientation = topic /imu.orientation timeout 0.5 sec
input speed = topic /odometry.twist.twist.linear.x timeout 0.5 sec
input front = topic /front.range timeout 0.5 sec
input mode = topic /plc/mode.data timeout 0.5 sec
input stop_button = topic /plc/stop_button.data timeout 0.5 sec
input bumper = topic /plc/bumper.data timeout 0.5 sec
input arm = topic /plc/arm.data timeout 0.5 sec
"""
_ROBOT = """\
entity imu_{k} {{
  tilt_not_ok: (orientation.roll() not in [-{tilt}, {tilt}] or
                orientation.pitch() not in [-{tilt}, {tilt}]) for 4 sec;
  rollover_imminent: orientation.roll() not in [-{roll}, {roll}] or
                     orientation.pitch() not in [-{roll}, {roll}];
}}
entity collision_{k} {{
  far_obstacle: front in [{stop_zone}, {warning_zone});
  close_obstacle: front in [{danger_zone}, {stop_zone});
  danger: front < {danger_zone};
}}
entity plc_{k} {{
  stop_button_activated: stop_button;
  bumper_activated: bumper;
  arm_activated: arm;
  manual: mode = 0;
  auto: mode = 2;
}}
entity drive_{k} {{
  moving: speed not in [-0.05, 0.05];
  max_speed_exceeded: (speed > {nominal} for 4 sec) or (speed < -{backward} for 2 sec);
  dangerous_speed: speed > {limit} or speed < -{backward_limit};
  silent: speed.missing();
}}
behaviour too_fast_{k}: if drive_{k}.max_speed_exceeded and plc_{k}.auto then {{ low_speed; }};
behaviour much_too_fast_{k}: if drive_{k}.dangerous_speed and plc_{k}.auto
then {{ motor_stop; stop; }};
behaviour fast_by_hand_{k}: if drive_{k}.dangerous_speed and plc_{k}.manual then {{ low_speed; }};
behaviour tilted_{k}: if (imu_{k}.tilt_not_ok and drive_{k}.moving and plc_{k}.auto)
                         or imu_{k}.rollover_imminent
then {{ motor_stop; stop; }};
behaviour warn_{k}: if collision_{k}.far_obstacle and drive_{k}.moving and plc_{k}.auto
then {{ low_speed; }};
behaviour hold_{k}: if collision_{k}.close_obstacle and plc_{k}.auto then {{ stop; }};
behaviour avoid_{k}: if collision_{k}.danger then {{ stop; }};
behaviour button_{k}: if plc_{k}.stop_button_activated then {{ motor_stop; stop; }};
behaviour bumped_{k}: if plc_{k}.bumper_activated and plc_{k}.auto then {{ motor_stop; stop; }};
behaviour arm_hit_{k}: if plc_{k}.arm_activated and plc_{k}.auto then {{ motor_stop; stop; }};
behaviour left_running_{k}: if (not drive_{k}.moving and plc_{k}.auto) for 10 min
then {{ motor_stop; }};
behaviour lost_{k}: if drive_{k}.silent then {{ stop; }};
behaviour manual_{k}: if plc_{k}.manual then {{ controllerOk; }};
"""


@dataclass(frozen=True, slots=True)
class Bounds:
    """The bounds of one robot: radians, metres, metres per second."""

    tilt: float
    roll: float
    warning_zone: float
    stop_zone: float
    danger_zone: float
    nominal: float
    limit: float
    backward: float
    backward_limit: float

    @classmethod
    def of(cls, number: int) -> Bounds:
        """Return the bounds of one robot of many; the first has those of the paper."""
        more = 1.0 + number / 1000.0
        paper = (math.radians(8), math.radians(10), 4.0, 2.0, 0.8, 0.5, 1.0, 0.25, 0.4)
        return cls(*(round(bound * more, 6) for bound in paper))


def program(rules: int, folder: Path) -> Program:
    """Build a program of so many rules.

    Raises:
        ValueError: the rules are faulty.
    """
    robots, rest = divmod(rules, RULES_OF_A_ROBOT)
    text = _HEAD + (_INPUTS if robots else _INPUT)
    text += "".join(_ROBOT.format(k=k, **_named(Bounds.of(k))) for k in range(robots))
    if rest:
        text += _rest(rest)
    (folder / "robot.rnd").write_text(_NODE, encoding="utf-8")
    (folder / "robot.system").write_text(_SYSTEM, encoding="utf-8")
    repository = Repository()
    model = repository.load_text(folder / f"rules_{rules}.deros", text).model
    if not isinstance(model, Rules):
        raise ValueError(f"the rules are faulty: {repository.diagnostics}")
    result = build(model, InterfaceStore())
    if result.program is None:
        raise ValueError(f"the rules are faulty: {result.diagnostics}")
    return result.program


def _rest(count: int) -> str:
    """Return bounds of the speed; the first is 0.5 m/s."""
    bounds = (f"  fast_{n}: speed > {0.5 + n / 100} for 2 sec;\n" for n in range(count))
    acts = (f"behaviour rushes_{n}: if drive.fast_{n} then {{ stop; }};\n" for n in range(count))
    return f"entity drive {{\n{''.join(bounds)}}}\n{''.join(acts)}"


def _named(bounds: Bounds) -> dict[str, float]:
    return {name: getattr(bounds, name) for name in Bounds.__slots__}


# Messages -----------------------------------------------------------------------------------------

Message = tuple[int, str, tuple[float, ...]]
"""The time in ns, the topic, and the fields that the rules read."""


def messages(seconds: float) -> list[Message]:
    """Return a drive of so many seconds: noisy sensors, a violation now and then.

    The rates are those of the paper's robot: the IMU at 100 Hz, odometry at 50 Hz, the scanner at
    20 Hz, each part of the PLC at 10 Hz.
    """
    noise = random.Random(1)  # the same drive for all
    sources = (
        (100.0, "/imu", _orientation),
        (50.0, "/odometry", _speed),
        (20.0, "/front", _front),
        (10.0, "/plc/mode", _mode),
        (10.0, "/plc/stop_button", _pressed(31.0)),
        (10.0, "/plc/bumper", _pressed(47.0)),
        (10.0, "/plc/arm", _pressed(59.0)),
    )
    made: list[Message] = []
    for number, (rate, topic, read) in enumerate(sources):
        for count in range(int(seconds * rate)):
            at = count / rate + number * 1e-4
            made.append((round(at * 1e9), topic, read(at, noise)))
    return sorted(made)


def _orientation(at: float, noise: random.Random) -> tuple[float, ...]:
    roll = 0.05 * math.sin(at) + noise.gauss(0.0, 0.005)
    pitch = 0.16 * math.sin(at / 7.0) ** 3 + noise.gauss(0.0, 0.005)
    x, y, z = math.sin(roll / 2.0), math.sin(pitch / 2.0), 0.3
    return x, y, z, math.sqrt(1.0 - x * x - y * y - z * z)


def _speed(at: float, noise: random.Random) -> tuple[float, ...]:
    return (0.3 + 0.35 * math.sin(at / 3.0) + noise.gauss(0.0, 0.002),)


def _front(at: float, noise: random.Random) -> tuple[float, ...]:
    return (max(0.1, 5.0 + 4.5 * math.cos(at / 5.0) + noise.gauss(0.0, 0.01)),)


def _mode(at: float, _: random.Random) -> tuple[float, ...]:
    return (0 if at % 40.0 > 37.0 else 2,)


def _pressed(period: float) -> Callable[[float, random.Random], tuple[float, ...]]:
    """Return the reading of a button that is pressed for a second, once in a period."""

    def read(at: float, _: random.Random) -> tuple[float, ...]:
        return (at % period > period - 1.0,)

    return read


def disturbed(drive: Sequence[Message]) -> list[Message]:
    """Return a drive with everything that a monitor has to bear.

    Each topic falls silent for seconds, is not a number now and then (where it is no integer), is
    turned upside down; once the clock steps back.
    """
    noise = random.Random(2)
    made: list[Message] = []
    for number, (t, topic, values) in enumerate(drive):
        seconds = t / 1e9
        if (seconds + len(topic)) % 11.0 < 2.0:
            continue
        if topic in _FLOATS and noise.random() < 0.02:
            choices = (math.nan, math.inf, -math.inf, 0.0, 1e200, -1.5)
            values = tuple(noise.choice((value, *choices)) for value in values)
        step = 3_000_000_000 if number > len(drive) // 2 else 0
        made.append((max(0, t - step), topic, values))
    return made


_FLOATS = ("/imu", "/odometry", "/front")


def angles(x: float, y: float, z: float, w: float) -> tuple[float, float]:
    """Return roll and pitch of a quaternion in radians."""
    roll = math.atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y))
    return roll, math.asin(max(-1.0, min(1.0, 2.0 * (w * y - z * x))))
