"""The cheapest receiver that rclpy allows: bytes, the EventsExecutor, no collection of garbage."""

from __future__ import annotations

import gc
import json
import sys

import rclpy
from rclpy.node import Node
from rclpy.utilities import remove_ros_args
from reaction_nodes.common import spin
from support.experiments.message_types import message_class

from cost_nodes.topics import SENSOR_QOS, TYPES


def main() -> None:
    """Run until SIGINT or SIGTERM, then print how many messages came.

    The arguments are ``TYPE:TOPIC`` for each topic; without any, those of the cost benchmark.
    """
    asked = (each.split(":", 1) for each in remove_ros_args(sys.argv)[1:])
    topics = {topic: message_class(of_type) for of_type, topic in asked} or TYPES
    rclpy.init()
    gc.disable()
    node = Node("fastest_receiver")
    count = 0

    def take(_: bytes) -> None:
        nonlocal count
        count += 1

    for topic, kind in topics.items():
        node.create_subscription(kind, topic, take, SENSOR_QOS, raw=True)
    spin(node)
    json.dump(count, sys.stdout)


if __name__ == "__main__":
    main()
