"""Recordings of an experiment whose delays are known, written without any middleware."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from rosbags.typesys import Stores, get_typestore

from benchmarks.support.experiments.recording import NODE, RECORDER, Recorded, Recording
from benchmarks.support.experiments.robots import ROBOTS, Robot
from benchmarks.support.experiments.session import MEASURED

MS = 1_000_000
INTELLIGENT_ONE: Robot = next(each for each in ROBOTS if each.name == "intelligent_one")
START = 5_000 * MS
TRAVEL = MS // 2
"""From the sending of a message to its receipt, by whichever process."""

PERIOD = 20 * MS
SIMULATED_START = 100_000 * MS
FAULT, FAULT_END = START + 1_000 * MS, START + 1_600 * MS
END = START + 2_500 * MS
RESET = START + 2_000 * MS
DUE = FAULT + TRAVEL + 400 * MS
"""When the rule has been broken for long enough, by the receipt in the safety node."""

_TYPES: Any = get_typestore(Stores.ROS2_JAZZY)
_IMU, _BOOL, _CLOCK = "sensor_msgs/msg/Imu", "std_msgs/msg/Bool", "rosgraph_msgs/msg/Clock"
_ODOMETRY, _STATUS = "nav_msgs/msg/Odometry", "diagnostic_msgs/msg/DiagnosticStatus"


@dataclass(frozen=True)
class Reported:
    """An event as a safety node reports it."""

    at: int
    kind: str
    action: str
    behaviour: str = ""
    arguments: str = ""


EVENTS = (
    Reported(DUE, "trigger", "stop", "tilted"),
    Reported(DUE, "trigger", "log_state", "tilted", "'stop: tilted'"),
    Reported(RESET, "reset", "stop"),
)
"""Those that the rules mean."""


def write_run(
    folder: Path,
    delay: int = 3 * MS,
    events: Sequence[Reported] = EVENTS,
    clock_step: int = 0,
    answers: bool = True,
) -> Path:
    """Write a run of the robot that is tilted once, and return its folder.

    Args:
        folder: a new one.
        delay: from the instant at which the rule is broken for long enough to the receipt of the
            stop, in ns.
        events: what the safety node has reported.
        clock_step: of a simulated clock, which is recorded then; it shows steps from 100 s on.
        answers: whether the stop comes.
    """
    folder.mkdir(parents=True)
    with Recording(folder / RECORDER) as recorder, Recording(folder / NODE) as node:
        node.add_monitor(START, {"start": True, "grace_ns": 0, "latched": []})
        node_is_reset = False
        for sent in range(START, END, PERIOD):
            if sent >= RESET and not node_is_reset:
                node.add_monitor(RESET, {"reset": True})
                node_is_reset = True
            tilt = 20.0 if FAULT <= sent < FAULT_END else 0.0
            for topic, kind, data in (
                ("/imu", _IMU, _imu(tilt)),
                ("/odometry", _ODOMETRY, _odometry()),
            ):
                message = Recorded(topic, kind, sent + TRAVEL, sent, data)
                recorder.add(message)
                node.add(message)
        if clock_step:
            _record_clock(recorder, clock_step)
        _record_states(recorder, DUE + delay if answers else END)
        for each in events:
            at = each.at + 2 * MS
            recorder.add(
                Recorded("/intelligent_one_safety_node/events", _STATUS, at, at, _event(each))
            )
    measured = {
        "processor": [1.0, 2.0],
        "receiver": 1.5,
        "memory": 70.0,
        "memory_share": 0.5,
        "sleeps": [MS, 3 * MS],
    }
    (folder / MEASURED).write_text(json.dumps(measured), encoding="utf-8")
    return folder


def _record_clock(recorder: Recording, step: int) -> None:
    for number, sent in enumerate(range(START, END, step)):
        shown = SIMULATED_START + number * step
        time = _TYPES.types["builtin_interfaces/msg/Time"](*divmod(shown, 1_000 * MS))
        data = _bytes(_CLOCK, clock=time)
        recorder.add(Recorded("/clock", _CLOCK, sent + TRAVEL, sent, data))


def _record_states(recorder: Recording, stop: int) -> None:
    """Record the state as a safety node publishes it: at every change and 10 times a second."""
    states = [(at, stop <= at < RESET) for at in range(START, END, 100 * MS)]
    for at, active in sorted([*states, (stop, True), (RESET, False)]):
        if at < END:
            recorder.add(Recorded("/stop", _BOOL, at, at, _bytes(_BOOL, data=active)))


def _bytes(kind: str, **fields: Any) -> bytes:
    return bytes(_TYPES.serialize_cdr(_TYPES.types[kind](**fields), kind))


def _type(name: str, *values: Any) -> Any:
    return _TYPES.types[name](*values)


def _header() -> Any:
    return _type("std_msgs/msg/Header", _type("builtin_interfaces/msg/Time", 0, 0), "base")


def _vector(x: float = 0.0) -> Any:
    return _type("geometry_msgs/msg/Vector3", x, 0.0, 0.0)


def _quaternion(roll: float = 0.0) -> Any:
    half = math.radians(roll) / 2
    return _type("geometry_msgs/msg/Quaternion", math.sin(half), 0.0, 0.0, math.cos(half))


def _imu(roll: float) -> bytes:
    nine = np.zeros(9)
    values = (_quaternion(roll), nine, _vector(), nine, _vector(), nine)
    return bytes(_TYPES.serialize_cdr(_type(_IMU, _header(), *values), _IMU))


def _odometry() -> bytes:
    covariance = np.zeros(36)
    point = _type("geometry_msgs/msg/Point", 0.0, 0.0, 0.0)
    pose = _type("geometry_msgs/msg/Pose", point, _quaternion())
    twist = _type("geometry_msgs/msg/Twist", _vector(0.4), _vector())
    message = _type(
        _ODOMETRY,
        _header(),
        "base",
        _type("geometry_msgs/msg/PoseWithCovariance", pose, covariance),
        _type("geometry_msgs/msg/TwistWithCovariance", twist, covariance),
    )
    return bytes(_TYPES.serialize_cdr(message, _ODOMETRY))


def _event(event: Reported) -> bytes:
    told = {
        "kind": event.kind,
        "action": event.action,
        "behaviour": event.behaviour,
        "arguments": event.arguments,
        "time_ns": str(event.at),
    }
    pairs = [_type("diagnostic_msgs/msg/KeyValue", key, each) for key, each in told.items()]
    message = _type(_STATUS, 1, "node", "text", "", pairs)
    return bytes(_TYPES.serialize_cdr(message, _STATUS))
