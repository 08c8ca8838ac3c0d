"""The fastest timed relay that rclpy allows: bytes in, a one-shot timer, constant bytes out.

It has one lane per argument, SECONDS:IMU TOPIC:STATE TOPIC. At its end it prints four numbers in ns
for each state: the duration, and by CLOCK_MONOTONIC when the timer was due, when its callback
began, and when the state had been published.
"""

from __future__ import annotations

import gc
import json
import sys
import time

import rclpy
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.node import Node
from rclpy.serialization import serialize_message
from rclpy.utilities import remove_ros_args
from sensor_msgs.msg import Imu
from std_msgs.msg import Bool

from reaction_nodes.common import IMU_QOS, STATE_QOS, spin
from reaction_nodes.timers import time_exactly


class Lane:
    """One pair of topics with one timer.

    Args:
        fired: the record of each state is appended there, after it is published.
    """

    def __init__(
        self, node: Node, fired: list[tuple[int, ...]], seconds: float, imu: str, state: str
    ) -> None:
        """Open both ends."""
        self._duration = round(seconds * 1e9)
        self._due = 0
        self._fired = fired
        self._state = serialize_message(Bool(data=True))
        publisher = node.create_publisher(Bool, state, STATE_QOS)
        # What publish() calls for bytes, without its checks of the type of the message.
        self._publish = publisher.handle.publish_raw
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._timer = node.create_timer(seconds, self._on_timer, clock=steady, autostart=False)
        node.create_subscription(Imu, imu, self._on_imu, IMU_QOS, raw=True)

    def _on_imu(self, _: bytes) -> None:
        self._due = time.monotonic_ns() + self._duration
        self._arm()

    def _arm(self) -> None:
        self._timer.timer_period_ns = max(self._due - time.monotonic_ns(), 1)
        self._timer.reset()

    def _on_timer(self) -> None:
        began = time.monotonic_ns()
        if began < self._due:  # the executor may call twice for one expiry
            self._arm()
        elif self._due:
            self._publish(self._state)
            published = time.monotonic_ns()
            self._timer.cancel()
            self._fired.append((self._duration, self._due, began, published))
            self._due = 0


def main() -> None:
    """Run until SIGINT or SIGTERM."""
    time_exactly()
    rclpy.init()
    gc.disable()
    node = Node("timed_relay")
    fired: list[tuple[int, ...]] = []
    lanes = []
    for argument in remove_ros_args(sys.argv)[1:]:
        seconds, imu, state = argument.split(":")
        lanes.append(Lane(node, fired, float(seconds), imu, state))
    spin(node)
    json.dump(fired, sys.stdout)


if __name__ == "__main__":
    main()
