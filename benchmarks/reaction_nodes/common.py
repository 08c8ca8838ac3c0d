"""What the hand-written nodes share: the QoS of the safety node, and how they spin."""

from __future__ import annotations

from typing import Any

from rclpy.executors import ExternalShutdownException
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.utilities import ok

IMU_QOS = QoSProfile(reliability=ReliabilityPolicy.BEST_EFFORT, depth=10)
"""As the safety node subscribes."""

STATE_QOS = QoSProfile(
    reliability=ReliabilityPolicy.RELIABLE,
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
    depth=1,
)
"""As the safety node publishes the state of an action."""

RECORD_QOS = QoSProfile(reliability=ReliabilityPolicy.RELIABLE, depth=1000)
"""For events: none of them is to be lost while the driver has something else to do."""


def spin(node: Any) -> None:
    """Run a node in the fastest executor of rclpy until SIGINT or SIGTERM."""
    executor = EventsExecutor()
    executor.add_node(node)
    try:
        while ok():
            executor.spin_once(timeout_sec=1.0)  # without a limit it would never wake up
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
