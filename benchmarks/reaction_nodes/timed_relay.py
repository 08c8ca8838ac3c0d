"""The fastest timed relay that rclpy allows: bytes in, a one-shot timer, constant bytes out.

It has one lane per argument, SECONDS:IMU TOPIC:STATE TOPIC. After each state it publishes on
``~/stamps`` four numbers in ns: its duration, and by CLOCK_MONOTONIC when it was due, when its
callback began, and when the state was published.
"""

from __future__ import annotations

import gc
import sys
import time
from typing import Any

import rclpy
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.node import Node
from rclpy.serialization import serialize_message
from rclpy.utilities import remove_ros_args
from sensor_msgs.msg import Imu
from std_msgs.msg import Bool, Int64MultiArray

from reaction_nodes.common import IMU_QOS, RECORD_QOS, STATE_QOS, spin
from reaction_nodes.timers import time_exactly


class Lane:
    """One pair of topics with one timer."""

    def __init__(self, node: Node, stamps: Any, seconds: float, imu: str, state: str) -> None:
        """Open both ends."""
        self._duration = round(seconds * 1e9)
        self._due = 0
        self._stamps = stamps
        self._state = serialize_message(Bool(data=True))
        publisher = node.create_publisher(Bool, state, STATE_QOS)
        # What publish() calls for bytes, without its checks of the type of the message.
        self._publish = publisher.handle.publish_raw
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._timer = node.create_timer(seconds, self._on_timer, clock=steady, autostart=False)
        node.create_subscription(Imu, imu, self._on_imu, IMU_QOS, raw=True)

    def _on_imu(self, _: bytes) -> None:
        self._due = time.monotonic_ns() + self._duration
        self._timer.timer_period_ns = self._due - time.monotonic_ns()
        self._timer.reset()

    def _on_timer(self) -> None:
        began = time.monotonic_ns()
        self._publish(self._state)
        published = time.monotonic_ns()
        self._timer.cancel()
        self._stamps.publish(Int64MultiArray(data=[self._duration, self._due, began, published]))


def main() -> None:
    """Run until SIGINT or SIGTERM."""
    time_exactly()
    rclpy.init()
    gc.disable()
    node = Node("timed_relay")
    stamps = node.create_publisher(Int64MultiArray, "~/stamps", RECORD_QOS)
    lanes = []
    for argument in remove_ros_args(sys.argv)[1:]:
        seconds, imu, state = argument.split(":")
        lanes.append(Lane(node, stamps, float(seconds), imu, state))
    spin(node)


if __name__ == "__main__":
    main()
