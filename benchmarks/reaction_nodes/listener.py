"""Load: takes what the talker publishes. Prints how many messages per second came, at its end."""

from __future__ import annotations

import json
import sys
import time

import rclpy
from rclpy.node import Node
from rclpy.utilities import remove_ros_args
from sensor_msgs.msg import Imu

from reaction_nodes.common import IMU_QOS, spin


def main() -> None:
    """Take the messages of the topics given as arguments until SIGINT or SIGTERM."""
    rclpy.init()
    node = Node("listener")
    count, first, last = 0, 0, 0

    def take(_: bytes) -> None:
        nonlocal count, first, last
        last = time.monotonic_ns()
        first = first or last
        count += 1

    for topic in remove_ros_args(sys.argv)[1:]:
        node.create_subscription(Imu, topic, take, IMU_QOS, raw=True)
    spin(node)
    json.dump(1e9 * (count - 1) / (last - first) if last > first else 0.0, sys.stdout)


if __name__ == "__main__":
    main()
