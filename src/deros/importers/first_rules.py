"""The rules to start with for a system that exists: an input for each topic that matters.

A system does not say how long a topic may be silent, how fast the robot may move, or what has to
happen then. So the text has values to be looked at, each in one place.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from typing import NamedTuple

from deros.interfaces.durations import LATEST_NS, NS_PER_S, duration_text
from deros.interfaces.types import InterfaceType
from deros.models.node import PortKind
from deros.systems.flat import FlatSystem

_SENSED = {
    "sensor_msgs": (
        *("BatteryState", "CompressedImage", "FluidPressure", "Illuminance", "Image", "Imu"),
        *("JointState", "Joy", "LaserEcho", "LaserScan", "MagneticField", "MultiDOFJointState"),
        *("MultiEchoLaserScan", "NavSatFix", "PointCloud", "PointCloud2", "Range"),
        *("RelativeHumidity", "Temperature", "TimeReference"),
    ),
    "nav_msgs": ("Odometry",),
    "geometry_msgs": (
        *("AccelStamped", "AccelWithCovarianceStamped", "PoseStamped"),
        *("PoseWithCovarianceStamped", "TwistWithCovarianceStamped", "WrenchStamped"),
    ),
}
"""Messages of what a robot senses, by package."""

_SPEEDS = {
    ("nav_msgs", "Odometry"): "twist.twist.linear.x",
    ("geometry_msgs", "TwistWithCovarianceStamped"): "twist.twist.linear.x",
    ("geometry_msgs", "Twist"): "linear.x",
    ("geometry_msgs", "TwistStamped"): "twist.linear.x",
    ("ackermann_msgs", "AckermannDrive"): "speed",
    ("ackermann_msgs", "AckermannDriveStamped"): "drive.speed",
}
"""The field with the speed ahead, in m/s, of what is sensed or commanded."""

_STOPS = {
    ("geometry_msgs", "Twist"): "zero",
    ("geometry_msgs", "TwistStamped"): "zero",
    ("ackermann_msgs", "AckermannDrive"): "send { speed = 0 }",
    ("ackermann_msgs", "AckermannDriveStamped"): "send { drive.speed = 0 }",
    ("trajectory_msgs", "JointTrajectory"): "send { points = [] }",
}
"""Commands that move a robot, and the effect of a gate that stops it."""

_SILENCE_NS = 1_000_000_000
"""How long a topic may be silent of which neither deadline nor rate says it, in ns."""

_PERIODS = 3
"""After how many average times between two messages a topic counts as silent."""


class NoGateError(ValueError):
    """A gate cannot be written for a topic; the text says why."""


@dataclass(frozen=True, slots=True)
class FirstRules:
    """Rules to start with.

    Attributes:
        text: of the file.
        left: topics that have no input, with their types.
    """

    text: str
    left: tuple[tuple[str, InterfaceType], ...]


@dataclass(frozen=True, slots=True)
class _Topic:
    name: str
    type: InterfaceType
    deadline_ns: int | None = None
    rate_hz: float | None = None

    @property
    def silence(self) -> str:
        """How long it may be silent, with a comment that says where a measured time is from."""
        if self.deadline_ns is not None or self.rate_hz is None:
            return duration_text(self.deadline_ns or _SILENCE_NS)
        time = duration_text(_rounded(_PERIODS / self.rate_hz))
        return f"{time}  // {_PERIODS} periods at {self.rate_hz:g} Hz, its rate in the system"

    @property
    def key(self) -> tuple[str, str]:
        return self.type.package, self.type.name

    @property
    def is_sensed(self) -> bool:
        return self.type.name in _SENSED.get(self.type.package, ())

    @property
    def moves(self) -> bool:
        return self.key in _STOPS


def first_rules(
    flat: FlatSystem,
    used: str,
    name: str,
    taken: Collection[str],
    gate: tuple[str, str] | None = None,
) -> FirstRules:
    """Return rules for a system, which check clean.

    Args:
        flat: the system.
        used: its file, as ``use`` names it.
        name: of the rules.
        taken: words that name nothing in rules.
        gate: the topics that a gate is to read and to publish, if there is to be one.

    Raises:
        NoGateError: if what stops the robot is not known from the type of the gate's topics.
    """
    topics = list(_topics(flat))
    gated = () if gate is None else gate
    names = _names([each.name for each in topics], taken)
    inputs = [each for each in topics if (each.is_sensed or each.moves) and each.name not in gated]
    fast = [each for each in inputs if each.key in _SPEEDS]
    sensed = [each for each in inputs if each.is_sensed]
    stop = "" if gate is None else "stop; "
    blocks = [f'use "{used}" import {flat.system.name}']
    if gate is not None:
        blocks.append(_ACTION.format(name))
    if fast:
        blocks.append(_LIMIT)
    if inputs:
        lines = (_input(each, names[each.name]) for each in inputs)
        blocks.append("\n".join([_ON_SILENCE, *lines]))
    blocks += _watched("senses", _silences(sensed, names, stop))
    # Whoever commands a robot may be silent, and mostly is.
    commands = [each for each in inputs if not each.is_sensed]
    blocks += _watched("motion", _silences(commands, names, "") + _speeds(fast, names, stop))
    if gate is not None:
        blocks.append(_gate_lines(gate, {each.name: each for each in topics}))
    left = ((each.name, each.type) for each in topics if each not in inputs)
    return FirstRules(
        "\n\n".join(blocks) + "\n", tuple(each for each in left if each[0] not in gated)
    )


_ACTION = """\
// While it is active, the gate below stops the robot.
action stop publishes true on /{}/stop : std_msgs.Bool latched;"""
_LIMIT = """\
// How fast the robot may drive: write what holds for yours.
const max_speed = 1 m/s"""
_ON_SILENCE = (
    "// How long each topic may be silent: 1 sec is a guess wherever no deadline or rate says it.\n"
    "// Write what holds for yours: longer than any pause that is meant to be."
)


def _rounded(seconds: float) -> int:
    """Return a time in ns that is not shorter: of two digits, in whole microseconds."""
    exact = max(round(min(seconds, LATEST_NS / NS_PER_S) * NS_PER_S), 1)
    step: int = 10 ** max(len(str(exact)) - 2, 3)
    return min(-(-exact // step) * step, LATEST_NS // step * step)


def _topics(flat: FlatSystem) -> Iterator[_Topic]:
    """Yield the topics that messages come on, with their types, sorted by name."""
    types: dict[str, InterfaceType] = {}
    deadlines: dict[str, int] = {}
    rates: dict[str, float] = {}
    for node in flat.nodes:
        for each in node.ports:
            if each.port.kind is not PortKind.PUBLISHER or node.statement is not None:
                continue
            types.setdefault(each.topic, each.port.type)
            qos = each.port.qos
            if qos is not None and qos.deadline_ns is not None:
                deadlines[each.topic] = max(qos.deadline_ns, deadlines.get(each.topic, 0))
    for topic in flat.topics:
        declared = topic.declaration
        if declared.rate_hz is not None:
            rates[topic.name] = min(declared.rate_hz, rates.get(topic.name, math.inf))
        if declared.external and declared.type is not None and declared.type.kind == "msg":
            types.setdefault(topic.name, declared.type)
    for name in sorted(types):
        yield _Topic(name, types[name], deadlines.get(name), rates.get(name))


def _names(topics: list[str], taken: Collection[str]) -> Mapping[str, str]:
    """Return a name for each topic, which is none of the words ``taken`` or of another one."""
    found: dict[str, str] = {}
    for topic in topics:
        name = "_".join(topic.strip("/").split("/"))
        while name in {*taken, "max_speed", *found.values()}:
            name += "_"
        found[topic] = name
    return found


def _input(topic: _Topic, name: str) -> str:
    field = f".{_SPEEDS[topic.key]}" if topic.key in _SPEEDS else ""
    unit = " [m/s]" if topic.key in _SPEEDS else ""
    return f"input {name} = topic {topic.name}{field}{unit} timeout {topic.silence}"


class _Rule(NamedTuple):
    name: str
    condition: str
    effects: str


def _silences(topics: list[_Topic], names: Mapping[str, str], stop: str) -> list[_Rule]:
    return [
        _Rule(
            f"{names[each.name]}_silent",
            f"{names[each.name]}.missing()",
            f'{stop}log_state("{each.name} is silent")',
        )
        for each in topics
    ]


def _speeds(topics: list[_Topic], names: Mapping[str, str], stop: str) -> list[_Rule]:
    return [
        _Rule(
            f"{names[each.name]}_fast",
            f"{names[each.name]}.abs() > max_speed",
            f'{stop}log_state("{each.name} is too fast")',
        )
        for each in topics
    ]


def _watched(entity: str, rules: list[_Rule]) -> Iterator[str]:
    """Yield an entity with its rules, and what happens when one of them holds."""
    if not rules:
        return
    lines = [f"  {each.name}: {each.condition};" for each in rules]
    yield "\n".join([f"entity {entity} {{", *lines, "}"])
    yield "\n".join(f"if {entity}.{each.name} then {{ {each.effects}; }};" for each in rules)


def _gate_lines(gate: tuple[str, str], topics: Mapping[str, _Topic]) -> str:
    wish, command = gate
    known = topics.get(wish) or topics.get(command)
    if known is None:
        raise NoGateError(f"the system has neither '{wish}' nor '{command}', or not their type")
    effect = _STOPS.get(known.key)
    if effect is None:
        what = ", ".join(f"{package}.{name}" for package, name in _STOPS)
        raise NoGateError(
            f"'{known.name}' is a {known.type.short}, of which it is not known what stops the "
            f"robot (known are {what}): write the gate by hand"
        )
    return "\n".join(
        (
            f"gate {wish} -> {command} : {known.type.short} rate 20 Hz {{",
            f"  stop: {effect} until reset;",
            f"  lost heartbeat for 0.3 sec: {effect} until reset;",
            f"  lost input for 0.5 sec: {effect};",
            "  resume on zero command;",
            "}",
        )
    )
