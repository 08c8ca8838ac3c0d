"""The topics that the proxy carries from one domain to the others, with their QoS."""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from functools import cache
from typing import Any

PLANT, SAFETY, GATE = "plant", "safety", "gate"
DOMAINS = (PLANT, SAFETY, GATE)


@dataclass(frozen=True)
class Topic:
    """A topic: where it is published, where it is read, and as what.

    Attributes:
        latched: whether who comes late gets the last message.
        depth: of the publisher, as in the models.
    """

    name: str
    type: str
    source: str
    targets: tuple[str, ...]
    latched: bool = False
    depth: int = 10

    def message_type(self) -> Any:
        """Return the class of its messages."""
        return message_type(self.type)


@dataclass(frozen=True, order=True)
class Link:
    """One topic into one domain: what a fault of the network concerns."""

    topic: str
    target: str

    def __str__(self) -> str:
        """Return it as a reader sees it."""
        return f"{self.topic} to {self.target}"


@cache
def message_type(name: str) -> Any:
    """Return the class of a message type, PACKAGE/TYPE."""
    package, _, kind = name.partition("/")
    return getattr(importlib.import_module(f"{package}.msg"), kind)


_CONTACTS = ("stop_button", "front_bumper", "rear_bumper", "feeding_arm")

SENSED = (
    Topic("/imu", "sensor_msgs/Imu", PLANT, (SAFETY,)),
    Topic("/odometry", "nav_msgs/Odometry", PLANT, (SAFETY,)),
    Topic("/scan", "sensor_msgs/LaserScan", PLANT, (SAFETY,)),
    Topic("/plc/keep_alive", "std_msgs/UInt64", PLANT, (SAFETY,)),
    Topic("/plc/mode", "std_msgs/UInt8", PLANT, (SAFETY,)),
    *(Topic(f"/plc/{name}", "std_msgs/Bool", PLANT, (SAFETY,)) for name in _CONTACTS),
    Topic("/plc/engine_running", "std_msgs/Bool", PLANT, (SAFETY,)),
    Topic("/controller/keep_alive", "std_msgs/UInt64", PLANT, (SAFETY,)),
)
"""What the rules watch."""

COMMAND = Topic("/controller/command", "geometry_msgs/Twist", PLANT, (GATE,))
JOYSTICK = Topic("/panel/joystick", "geometry_msgs/Twist", PLANT, (GATE,))
LET_THROUGH = Topic("/actuators/command", "geometry_msgs/Twist", GATE, (PLANT,))
HEARTBEAT = Topic("/safety/heartbeat", "std_msgs/UInt64", SAFETY, (GATE, PLANT), depth=1)
STOP = Topic("/safety/stop", "std_msgs/Bool", SAFETY, (GATE, PLANT), latched=True, depth=1)
LOW_SPEED = Topic("/safety/low_speed", "std_msgs/Bool", SAFETY, (GATE, PLANT), True, 1)
MOTOR_STOP = Topic("/safety/motor_stop", "std_msgs/Bool", SAFETY, (PLANT,), True, 1)
CONTROLLER_OK = Topic("/safety/controller_ok", "std_msgs/Bool", SAFETY, (GATE, PLANT), True, 1)

CARRIED = (
    *SENSED,
    COMMAND,
    JOYSTICK,
    LET_THROUGH,
    HEARTBEAT,
    STOP,
    LOW_SPEED,
    MOTOR_STOP,
    CONTROLLER_OK,
)
"""Everything that crosses from one domain to another."""

PEDAL = Topic("/actuators/pedal", "std_msgs/Float64", PLANT, ())
"""The actuator: what the hydraulics get."""

LINKS = tuple(Link(topic.name, target) for topic in CARRIED for target in topic.targets)
BY_NAME = {topic.name: topic for topic in (*CARRIED, PEDAL)}
