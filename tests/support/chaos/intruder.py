"""A foreign process on the robot's network: it runs from the beginning and publishes on command.

    python intruder.py

It joins its ROS domain at once, so that its publisher is found in a moment when it begins. The line
that it reads then says where, what and how often, in JSON:

    {"topic": …, "type": "PACKAGE/TYPE", "latched": …, "rate": HZ, "messages": [BASE64, …]}

It leaves the domain on SIGTERM: a killed process would be counted until its lease expires, also in
the next round.
"""

from __future__ import annotations

import base64
import importlib
import itertools
import json
import os
import signal
import sys
import time
from typing import Any

import rclpy
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.signals import SignalHandlerOptions


def main() -> None:
    """Publish for ever what the command names."""
    signal.signal(signal.SIGTERM, lambda *_: sys.exit())
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    node = rclpy.create_node(f"intruder_{os.getpid()}")
    try:
        print("ready", flush=True)
        speak(node, json.loads(sys.stdin.readline() or "null"))
    finally:
        node.destroy_node()
        rclpy.shutdown()


def speak(node: Any, order: dict[str, Any] | None) -> None:
    """Publish as ordered, for ever; without an order, nothing."""
    if order is None:
        return
    package, _, kind = order["type"].partition("/")
    message_type = getattr(importlib.import_module(f"{package}.msg"), kind)
    latched = DurabilityPolicy.TRANSIENT_LOCAL if order["latched"] else DurabilityPolicy.VOLATILE
    profile = QoSProfile(depth=10, durability=latched)
    publisher = node.create_publisher(message_type, order["topic"], profile)
    for message in itertools.cycle(map(base64.b64decode, order["messages"])):
        publisher.publish(message)
        time.sleep(1.0 / order["rate"])


if __name__ == "__main__":
    main()
