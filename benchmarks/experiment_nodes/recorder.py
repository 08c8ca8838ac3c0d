"""Records topics to MCAP, like ``ros2 bag record``: with the times of sending and of receipt.

Both are those that the middleware keeps of each message, so they do not depend on when this process
gets to it; they are turned into times of the steady clock, which no correction of the time moves.
It says on a topic of its own when it is connected to a publisher of each topic.
"""

from __future__ import annotations

import signal
import sys
import time
from pathlib import Path
from typing import Any

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import try_shutdown
from std_msgs.msg import Bool
from support.experiments.driver import LATCHED_QOS, READY
from support.experiments.message_types import message_class
from support.experiments.recording import Recorded, Recording

SENSOR, STATE, EVENTS = "sensor", "state", "events"
"""The kinds of topics: best effort; reliable; reliable with what was sent before."""

_PROFILES = {
    SENSOR: QoSProfile(reliability=ReliabilityPolicy.BEST_EFFORT, depth=1000),
    STATE: QoSProfile(reliability=ReliabilityPolicy.RELIABLE, depth=1000),
    EVENTS: QoSProfile(
        reliability=ReliabilityPolicy.RELIABLE,
        durability=DurabilityPolicy.TRANSIENT_LOCAL,
        depth=1000,
    ),
}


_WAIT = 0.1
"""Seconds after which it is seen whether the process is to end."""


def main() -> None:
    """Record until SIGINT; the arguments are the file, and ``KIND:TYPE:TOPIC`` for each topic."""
    path, *topics = sys.argv[1:]
    asked: list[int] = []
    signal.signal(signal.SIGINT, lambda number, _: asked.append(number))
    rclpy.init(args=[], signal_handler_options=SignalHandlerOptions.NO)
    node = Node("recorder", enable_rosout=False, start_parameter_services=False)
    # That executor of rclpy alone hands over the times of a message.
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    with Recording(Path(path)) as recording:
        for each in topics:
            kind, of_type, topic = each.split(":", 2)
            take = _taker(recording, topic, of_type)
            profile = _PROFILES[kind]
            kind_of_message = message_class(of_type)
            node.create_subscription(kind_of_message, topic, take, profile, raw=True)
        ready = node.create_publisher(Bool, READY, LATCHED_QOS)
        is_ready = False
        while not asked:
            executor.spin_once(timeout_sec=_WAIT)
            if not is_ready and all(each.get_publisher_count() for each in node.subscriptions):
                is_ready = True
                ready.publish(Bool(data=True))
    executor.shutdown()
    node.destroy_node()
    try_shutdown()


def _taker(recording: Recording, topic: str, of_type: str) -> Any:
    def take(data: bytes, info: dict[str, int]) -> None:
        steady = time.monotonic_ns() - time.time_ns()
        received, sent = info["received_timestamp"] + steady, info["source_timestamp"] + steady
        recording.add(Recorded(topic, of_type, received, sent, bytes(data)))

    return take


if __name__ == "__main__":
    main()
