"""What is played to the robot of the fault tests: topics and messages."""

from __future__ import annotations

import array
import math
from typing import Any

SENSES = {
    "/speed": "std_msgs/msg/Float64",
    "/imu": "sensor_msgs/msg/Imu",
    "/scan": "sensor_msgs/msg/LaserScan",
    "/load": "std_msgs/msg/Float64",
    "/button": "std_msgs/msg/Bool",
}
"""What the rules watch."""

COMMANDER = {"/cmd_vel_nav": "geometry_msgs/msg/Twist"}
"""What the gate takes in."""

TOPICS = {**SENSES, **COMMANDER}

COMMAND = 0.4
"""The commanded speed of the robot, in m/s."""


def speed(value: float) -> Any:
    """Return a message of the encoders."""
    from std_msgs.msg import Float64

    return Float64(data=value)


def command(forward: float = COMMAND) -> Any:
    """Return a command for the drive."""
    from geometry_msgs.msg import Twist

    message = Twist()
    message.linear.x = forward
    return message


load = speed
"""Return a message of the load cell."""


def ticks(first: float = 1000.0, *, step: float = 0.02) -> list[Any]:
    """Return messages of /clock, a minute's worth at 50 Hz."""
    from rosgraph_msgs.msg import Clock  # type: ignore[import-untyped]

    messages = []
    for number in range(3000):
        message = Clock()
        now = round((first + number * step) * 1e9)
        message.clock.sec, message.clock.nanosec = divmod(now, 1_000_000_000)
        messages.append(message)
    return messages


def button(pressed: bool) -> Any:
    """Return a message of the operator's button."""
    from std_msgs.msg import Bool

    return Bool(data=pressed)


def imu(roll: float = 0.0, *, stamp: float = 0.0) -> Any:
    """Return a message of the IMU, tilted by ``roll`` radians."""
    from sensor_msgs.msg import Imu

    message = Imu()
    message.header.stamp.sec = int(stamp)
    message.orientation.x, message.orientation.w = math.sin(roll / 2), math.cos(roll / 2)
    return message


def scan(distance: float, beams: int = 360, ahead: float | None = None) -> Any:
    """Return a message of the lidar, all around at one distance; a beam takes four bytes.

    Within 45 degrees ahead, which is the middle of the scan, it is another distance, if one is
    given.
    """
    from sensor_msgs.msg import LaserScan

    message = LaserScan(angle_min=-math.pi, angle_max=math.pi, range_min=0.05, range_max=30.0)
    message.angle_increment = 2 * math.pi / beams
    message.ranges = array.array("f", [distance]) * beams
    if ahead is not None:
        first, last = beams * 3 // 8, beams * 5 // 8
        message.ranges[first:last] = array.array("f", [ahead]) * (last - first)
    return message
