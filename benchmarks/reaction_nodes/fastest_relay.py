"""The fastest relay that rclpy allows: bytes in, constant bytes out, nothing looked at."""

from __future__ import annotations

import gc

import rclpy
from rclpy.node import Node
from rclpy.serialization import serialize_message
from sensor_msgs.msg import Imu
from std_msgs.msg import Bool

from reaction_nodes.common import IMU_QOS, STATE_QOS, spin
from reaction_nodes.timers import time_exactly


def main() -> None:
    """Run until SIGINT or SIGTERM."""
    time_exactly()
    rclpy.init()
    gc.disable()
    node = Node("fastest_relay")
    publisher = node.create_publisher(Bool, "state", STATE_QOS)
    # What publish() calls for bytes, without its checks of the type of the message.
    publish = publisher.handle.publish_raw
    state = serialize_message(Bool(data=True))

    def relay(_: bytes) -> None:
        publish(state)

    node.create_subscription(Imu, "imu", relay, IMU_QOS, raw=True)
    spin(node)


if __name__ == "__main__":
    main()
