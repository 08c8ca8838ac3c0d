"""Load: publishes on so many topics 100 times a second, as the sensors of a robot do."""

from __future__ import annotations

import sys

import rclpy
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.node import Node
from rclpy.serialization import serialize_message
from rclpy.utilities import remove_ros_args
from sensor_msgs.msg import Imu

from reaction_nodes.common import IMU_QOS, spin

FREQUENCY = 100.0


def main() -> None:
    """Publish on the topics given as arguments until SIGINT or SIGTERM."""
    rclpy.init()
    node = Node("talker")
    publishers = [node.create_publisher(Imu, t, IMU_QOS) for t in remove_ros_args(sys.argv)[1:]]
    message = serialize_message(Imu())

    def publish() -> None:
        for publisher in publishers:
            publisher.publish(message)

    steady = Clock(clock_type=ClockType.STEADY_TIME)
    node.create_timer(1.0 / FREQUENCY, publish, clock=steady)
    spin(node)


if __name__ == "__main__":
    main()
