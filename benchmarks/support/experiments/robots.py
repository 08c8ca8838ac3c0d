"""The robots of the experiments: what their sensors send, what breaks, and what the paper found."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

REAL, SIMULATED = "R", "S"
"""By which clock a run is played: that of the machine, or a simulator's."""

PYTHON, CPP = "Python", "C++"
"""The targets for which a safety node is generated."""

GRACE_NS = 10_000_000_000
"""For how long inputs may be late at the start, in ns, as in the systems of the examples."""

Fields = Mapping[str, Any]
"""The fields of a message that are not their defaults, by dotted names."""


@dataclass(frozen=True, slots=True)
class Sensor:
    """A topic of a robot: how often it is published, in Hz, and what it says while all is well."""

    topic: str
    type: str
    hertz: float
    fields: Fields = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Times:
    """A row of the paper's Table 1, in seconds."""

    average: float
    deviation: float
    least: float
    greatest: float


@dataclass(frozen=True, slots=True)
class Experiment:
    """What is broken, and what the safety node has to do about it.

    Attributes:
        key: the letter, or word, that stands for it in the table: R_S is S by the machine's clock.
        name: in words.
        ideal: the seconds for which the rule lets it be.
        faults: by topic, what its messages say instead of what they say while all is well.
        topic: that of the messages that fulfil the condition of the rule.
        is_fulfilled: whether such a message does.
        action: the topic of the action's state.
        paper: what the paper found, by clock.
    """

    key: str
    name: str
    ideal: float
    faults: Mapping[str, Fields]
    topic: str
    is_fulfilled: Callable[[Any], bool]
    action: str
    paper: Mapping[str, Times] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Robot:
    """An example of deros, with its experiments.

    Attributes:
        name: of its folder and its rules in ``examples``.
        title: as the paper calls it.
        clocks: by which its experiments are played.
        sensors: all topics that its rules read.
        experiments: each breaks one thing.
        recovery: what the topics say after a fault, until the actions are reset.
        others: the topics of further actions that have to be reset.
        earlier: by how many percent an earlier version exceeded the ideal on this robot: the range
            of its averages, as the paper has it.
    """

    name: str
    title: str
    clocks: tuple[str, ...]
    sensors: tuple[Sensor, ...]
    experiments: tuple[Experiment, ...]
    recovery: Mapping[str, Fields] = field(default_factory=dict)
    others: tuple[str, ...] = ()
    earlier: str = ""

    @property
    def node(self) -> str:
        """The name of its safety node."""
        return f"{self.name}_safety_node"

    @property
    def actions(self) -> tuple[str, ...]:
        """The topics of all its actions."""
        awaited = [each.action for each in self.experiments]
        return tuple(dict.fromkeys([*awaited, *self.others]))


_ODOMETRY, _IMU = "nav_msgs/msg/Odometry", "sensor_msgs/msg/Imu"
_FLOAT, _BOOL = "std_msgs/msg/Float64", "std_msgs/msg/Bool"
_SPEED = "twist.twist.linear.x"
_UPRIGHT = {"orientation.w": 1.0}


def _rolled(degrees: float) -> Fields:
    half = math.radians(degrees) / 2
    return {"orientation.x": math.sin(half), "orientation.w": math.cos(half)}


def _speed(message: Any) -> float:
    return float(message.twist.twist.linear.x)


def _roll(message: Any) -> float:
    x, w = float(message.orientation.x), float(message.orientation.w)
    return math.degrees(2 * math.atan2(x, w))  # no other angle is ever turned


_INTELLIGENT_ONE = Robot(
    name="intelligent_one",
    title="Intelligent One",
    clocks=(REAL, SIMULATED),
    sensors=(
        Sensor("/odometry", _ODOMETRY, 50.0, {_SPEED: 0.4, "pose.pose.orientation.w": 1.0}),
        Sensor("/imu", _IMU, 50.0, _UPRIGHT),
    ),
    experiments=(
        Experiment(
            "S",
            "faster than 0.5 m/s",
            2.0,
            {"/odometry": {_SPEED: 0.7}},
            "/odometry",
            lambda message: _speed(message) > 0.5,
            "/stop",
            {
                REAL: Times(2.00271, 0.00461, 2.00006, 2.01374),
                SIMULATED: Times(2.01150, 0.00741, 2.00200, 2.02500),
            },
        ),
        Experiment(
            "T",
            "tilted by more than 10 degrees",
            0.4,
            {"/imu": _rolled(15.0)},
            "/imu",
            lambda message: abs(_roll(message)) > 10.0,
            "/stop",
            {
                REAL: Times(0.40635, 0.00916, 0.40002, 0.42600),
                SIMULATED: Times(0.40825, 0.00526, 0.40000, 0.42300),
            },
        ),
    ),
)

_BEAMS = 181
_PLC = ("stop_button", "front_bumper", "rear_bumper", "feeding_arm")
_MANUAL, _AUTOMATIC = {"data": 0}, {"data": 2}

_FEEDING_ROBOT = Robot(
    name="feeding_robot",
    title="FIX-Robo",
    clocks=(REAL, SIMULATED),
    sensors=(
        Sensor("/odometry", _ODOMETRY, 40.0, {_SPEED: 0.4}),
        Sensor("/imu", _IMU, 40.0, _UPRIGHT),
        Sensor(
            "/scan",
            "sensor_msgs/msg/LaserScan",
            40.0,
            {
                "angle_min": -math.pi / 2,
                "angle_max": math.pi / 2,
                "angle_increment": math.pi / (_BEAMS - 1),
                "range_min": 0.1,
                "range_max": 25.0,
                "ranges": [20.0] * _BEAMS,
            },
        ),
        Sensor("/plc/keep_alive", "std_msgs/msg/UInt64", 50.0),
        Sensor("/plc/mode", "std_msgs/msg/UInt8", 50.0, _AUTOMATIC),
        *(Sensor(f"/plc/{each}", _BOOL, 50.0) for each in _PLC),
        Sensor("/plc/engine_running", _BOOL, 50.0, {"data": True}),
        Sensor("/controller/keep_alive", "std_msgs/msg/UInt64", 40.0),
    ),
    experiments=(
        Experiment(
            "S",
            "faster than 0.5 m/s",
            4.0,
            {"/odometry": {_SPEED: 0.6}},
            "/odometry",
            lambda message: _speed(message) > 0.5,
            "/safety/stop",
            {
                REAL: Times(4.00509, 0.00400, 4.00127, 4.01705),
                SIMULATED: Times(4.00462, 0.00747, 4.00000, 4.02000),
            },
        ),
    ),
    recovery={"/plc/mode": _MANUAL},
    others=("/safety/motor_stop",),
)

_WHEELS = ("left", "right")

_FROBIT = Robot(
    name="frobit",
    title="Frobit",
    clocks=(REAL,),
    sensors=(
        Sensor("/odometry", _ODOMETRY, 50.0, {_SPEED: 0.2}),
        *(Sensor(f"/{wheel}/speed", _FLOAT, 50.0, {"data": 4.0}) for wheel in _WHEELS),
        *(Sensor(f"/{wheel}/setpoint", _FLOAT, 50.0, {"data": 4.0}) for wheel in _WHEELS),
        *(Sensor(f"/{wheel}/thrust", _FLOAT, 50.0, {"data": 0.5}) for wheel in _WHEELS),
    ),
    experiments=(
        Experiment(
            "E",
            "the line of an encoder is cut",
            0.3,
            {"/left/speed": {"data": 0.0}},
            "/left/speed",
            lambda message: abs(message.data) < 0.2,
            "/safety/stop",
        ),
        Experiment(
            "M",
            "the line of a motor is cut",
            0.5,
            {"/right/speed": {"data": 1.0}},  # it rolls out
            "/right/speed",
            lambda message: abs(message.data - 4.0) > 2.0,
            "/safety/stop",
        ),
        Experiment(
            "S",
            "faster than 0.5 m/s",
            0.2,
            {"/odometry": {_SPEED: 0.6}},
            "/odometry",
            lambda message: abs(_speed(message)) > 0.5,
            "/safety/stop",
        ),
    ),
    earlier="50 to 240",
)

_KOBUKI = Robot(
    name="kobuki",
    title="Kobuki",
    clocks=(SIMULATED,),
    sensors=(
        Sensor("/odometry", _ODOMETRY, 50.0, {_SPEED: 0.2}),
        Sensor("/imu", _IMU, 50.0, _UPRIGHT),
        Sensor("/pilot/load", _FLOAT, 2.0, {"data": 5.0}),
    ),
    experiments=(
        Experiment(
            "S",
            "faster than 0.4 m/s",
            0.3,
            {"/odometry": {_SPEED: 0.6}},
            "/odometry",
            lambda message: abs(_speed(message)) > 0.4,
            "/safety/stop",
        ),
        Experiment(
            "Spin",
            "spins faster than 1.5 rad/s",
            0.3,
            {"/imu": {**_UPRIGHT, "angular_velocity.z": 2.5}},
            "/imu",
            lambda message: abs(message.angular_velocity.z) > 1.5,
            "/safety/stop",
        ),
        Experiment(
            "Load",
            "the pilot needs more than 30 % of the processor",
            2.0,
            {"/pilot/load": {"data": 60.0}},
            "/pilot/load",
            lambda message: message.data > 30.0,
            "/safety/stop",
        ),
        Experiment(
            "Area",
            "outside the yard",
            0.0,
            {"/odometry": {_SPEED: 0.2, "pose.pose.position.x": 1.5}},
            "/odometry",
            lambda message: abs(message.pose.pose.position.x) > 1.2,
            "/safety/stop",
        ),
    ),
    earlier="-15 to 23",
)

ROBOTS = (_INTELLIGENT_ONE, _FEEDING_ROBOT, _FROBIT, _KOBUKI)
"""All robots, in the order of the table."""
