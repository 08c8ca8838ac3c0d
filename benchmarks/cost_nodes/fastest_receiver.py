"""The cheapest receiver that rclpy allows: bytes, the EventsExecutor, no collection of garbage."""

from __future__ import annotations

import gc
import json
import sys

import rclpy
from rclpy.node import Node
from reaction_nodes.common import spin

from cost_nodes.topics import SENSOR_QOS, TYPES


def main() -> None:
    """Run until SIGINT or SIGTERM, then print how many messages came."""
    rclpy.init()
    gc.disable()
    node = Node("fastest_receiver")
    count = 0

    def take(_: bytes) -> None:
        nonlocal count
        count += 1

    for topic, kind in TYPES.items():
        node.create_subscription(kind, topic, take, SENSOR_QOS, raw=True)
    spin(node)
    json.dump(count, sys.stdout)


if __name__ == "__main__":
    main()
