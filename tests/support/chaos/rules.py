"""The referee's own reading of the feeding robot's rules, from what has arrived at the safety node.

This is the risk list at the head of ``feeding_robot.deros``, written down once more, by hand, for
the rules that stop the drive. Nothing here is taken from the rules' file, the parser, the
reference engine or generated code, so that a mistake in one of them does not hide itself. The rule
of ten minutes is left out: no round lasts as long.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from tests.support.chaos.links import BY_NAME, SAFETY, SENSED
from tests.support.chaos.record import Message

TIMEOUT = 0.5
"""Seconds without a message after which an input is missing."""

AUTOMATIC, LEARN, MANUAL = 2, 1, 0


@dataclass(frozen=True)
class Broken:
    """A rule is broken from ``begin`` (s) until ``end``, the time that it allows included."""

    rule: str
    begin: float
    end: float


Values = dict[str, Any]


def read(topic: str, data: bytes) -> Values:
    """Return the fields of a serialized message by short names; an unknown one is ``None``."""
    from rclpy.serialization import deserialize_message

    message = deserialize_message(data, BY_NAME[topic].message_type())
    if topic == "/imu":
        q = message.orientation
        if not q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w > 0.0:
            return {"tilt": None}
        sine = max(-1.0, min(1.0, 2 * (q.w * q.y - q.z * q.x)))
        roll = math.atan2(2 * (q.w * q.x + q.y * q.z), 1 - 2 * (q.x * q.x + q.y * q.y))
        return {"tilt": math.degrees(max(abs(roll), abs(math.asin(sine))))}
    if topic == "/odometry":
        return {"speed": message.twist.twist.linear.x}
    if topic == "/scan":
        ahead = [
            distance
            for beam, distance in enumerate(message.ranges)
            if abs(message.angle_min + beam * message.angle_increment) <= math.radians(30.0)
        ]
        return {"nearest": _nearest(ahead, math.degrees(abs(message.angle_increment)))}
    return {topic.rpartition("/")[2]: message.data}


def _nearest(ahead: Sequence[float], step: float) -> float | None:
    """Return the least range, or nothing where most beams are blind, or some in a wide gap."""
    seen = [max(each, 0.0) for each in ahead if each > 0.0 or each == -math.inf]
    widest = run = 0
    for each in ahead:
        run = 0 if each > 0.0 or each == -math.inf else run + 1
        widest = max(widest, run)
    if not seen or 2 * len(seen) < len(ahead) or widest * step > 5.0:
        return None
    return min(seen)


NAMES: Mapping[str, str] = {
    "/imu": "tilt",
    "/odometry": "speed",
    "/scan": "nearest",
    **{topic.name: topic.name.rpartition("/")[2] for topic in SENSED[3:-1]},
    SENSED[-1].name: "controller",
}
"""What each watched topic is called here."""


def _supervised(v: Values) -> bool:
    return v["mode"] in (AUTOMATIC, LEARN)


# Each: what it is called, what must be known, when it is broken.
_STATES: Sequence[tuple[str, tuple[str, ...], Callable[[Values], bool]]] = (
    ("forward limit", ("speed", "mode"), lambda v: _supervised(v) and v["speed"] > 1.0),
    ("backward limit", ("speed", "mode"), lambda v: _supervised(v) and v["speed"] < -0.4),
    ("rollover", ("tilt",), lambda v: v["tilt"] > 10.0),
    (
        "stop zone",
        ("nearest", "mode"),
        lambda v: v["mode"] == AUTOMATIC and 0.8 <= v["nearest"] < 2.0,
    ),
    ("collision zone", ("nearest", "mode"), lambda v: _supervised(v) and v["nearest"] < 0.8),
    *(
        (name, (name, "mode"), lambda v, name=name: _supervised(v) and v[name])
        for name in ("stop_button", "front_bumper", "rear_bumper", "feeding_arm")
    ),
)

SHUTS_OFF = frozenset(
    {
        *("forward limit", "backward limit", "nominal speed", "nominal backward speed", "rollover"),
        *("stop_button", "front_bumper", "rear_bumper", "feeding_arm"),
    }
)
"""The rules that stop the engine, too, until an operator resets it."""

# Each: what it is called, what is measured, what is too much, for how many seconds it is allowed.
_LASTING: Sequence[tuple[str, str, Callable[[Any], bool], float]] = (
    ("nominal speed", "speed", lambda speed: speed > 0.5, 4.0),
    ("nominal backward speed", "speed", lambda speed: speed < -0.25, 2.0),
)


@dataclass
class _Switch:
    """Turns a truth that comes and goes into intervals."""

    rule: str
    allowed: float = 0.0
    since: float | None = None
    found: list[Broken] = field(default_factory=list)

    def set(self, truth: bool, now: float) -> None:
        """Note whether it is so from now on."""
        if truth and self.since is None:
            self.since = now
        elif not truth and self.since is not None:
            if now > self.since + self.allowed:
                self.found.append(Broken(self.rule, self.since + self.allowed, now))
            self.since = None


def broken_rules(messages: Sequence[Message], end: float) -> list[Broken]:
    """Return which rules were broken, and when, by what the safety node received before ``end``.

    Args:
        messages: of any places, in order of time.
        end: of the round, in s.
    """
    values: Values = {}
    switches = {name: _Switch(name) for name, _, _ in _STATES}
    lasting = {name: _Switch(name, allowed) for name, _, _, allowed in _LASTING}
    silent = {name: _Switch(f"{name} is silent") for name in NAMES.values()}
    blind = {name: _Switch(f"{name} cannot be told") for name in NAMES.values()}
    for now, topic, data in _events(messages, end):
        name = NAMES[topic]
        if data is None:
            values.pop(name, None)
        elif name == "controller":
            values[name] = True
        else:
            values |= read(topic, data)
        silent[name].set(data is None, now)
        blind[name].set(name in values and values[name] is None, now)
        for rule, needed, is_broken in _STATES:
            known = all(values.get(each) is not None for each in needed)
            switches[rule].set(known and bool(is_broken(values)), now)
        for rule, measured, is_broken, _ in _LASTING:
            supervised = values.get("mode") in (AUTOMATIC, LEARN)
            switch = lasting[rule]
            switch.set(supervised and measured in values and bool(is_broken(values[measured])), now)
    every = [*switches.values(), *lasting.values(), *silent.values(), *blind.values()]
    for switch in every:
        switch.set(False, end)
    return sorted((each for s in every for each in s.found), key=lambda each: each.begin)


def _events(messages: Sequence[Message], end: float) -> Iterator[tuple[float, str, bytes | None]]:
    """Give the messages that have arrived, and in between, without data, each timeout."""
    last: dict[str, float] = {}
    for message in messages:
        if message.place != "arrived" or message.domain != SAFETY or message.topic not in NAMES:
            continue
        yield from _timeouts(last, message.time)
        last[message.topic] = message.time
        yield message.time, message.topic, message.data
    yield from _timeouts(last, end)


def _timeouts(last: dict[str, float], now: float) -> Iterator[tuple[float, str, None]]:
    due = sorted((came + TIMEOUT, topic) for topic, came in last.items() if came + TIMEOUT <= now)
    for moment, topic in due:
        del last[topic]
        yield moment, topic, None
