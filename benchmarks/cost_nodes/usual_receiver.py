"""A receiver as rclpy's tutorials write it: typed messages, the default executor, nothing else."""

from __future__ import annotations

import contextlib
import json
import sys
from typing import Any

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

from cost_nodes.topics import SENSOR_QOS, TYPES


class UsualReceiver(Node):
    """Counts the messages of all topics."""

    def __init__(self) -> None:
        """Subscribe."""
        super().__init__("usual_receiver")
        self.count = 0
        for topic, kind in TYPES.items():
            self.create_subscription(kind, topic, self._on_message, SENSOR_QOS)

    def _on_message(self, _: Any) -> None:
        self.count += 1


def main() -> None:
    """Run until SIGINT or SIGTERM, then print how many messages came."""
    rclpy.init()
    node = UsualReceiver()
    with contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(node)
    json.dump(node.count, sys.stdout)


if __name__ == "__main__":
    main()
