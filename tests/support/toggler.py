"""Break a rule and keep it again, N times, each as soon as the answer to the last has come.

    python toggler.py INPUT OUTPUT BROKEN KEPT N

INPUT is a std_msgs/Float64, OUTPUT the state of an action, a std_msgs/Bool. Exits with 0 when the
action has come N times and gone N times, each within a second.

Only the first of all is asked for again and again: the publisher may have found the subscription
before the subscription has found it, and nothing is kept for those who come late.
"""

from __future__ import annotations

import sys
import time

import rclpy
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.serialization import serialize_message
from std_msgs.msg import Bool, Float64

VALUE = 4
"""Where the value of a serialized Bool is; it is padded with bytes that are not initialised."""

ANSWER_S = 1.0
DISCOVERY_S = 30.0


def main(source: str, target: str, broken: str, kept: str, times: str) -> None:
    """Toggle until it is done, or an answer is missing."""
    rclpy.init()
    node = rclpy.create_node("toggler")
    publisher = node.create_publisher(Float64, source, 10)
    messages = [serialize_message(Float64(data=float(text))) for text in (kept, broken)]
    end = 2 * int(times)
    wanted, done, asked = False, -1, time.monotonic()  # first it must say that nothing is broken

    def receive(state: bytes) -> None:
        nonlocal wanted, done, asked
        if bool(state[VALUE]) != wanted:
            return  # the state is repeated now and then
        wanted = not wanted
        done += 1
        asked = time.monotonic()
        if done < end:
            publisher.publish(messages[wanted])

    kept_state = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    node.create_subscription(Bool, target, receive, kept_state, raw=True)
    executor = EventsExecutor()
    executor.add_node(node)
    while done < end:
        if done < 1:  # until the first answer: the node ignores repeated messages
            publisher.publish(messages[wanted])
        executor.spin_once(timeout_sec=0.1)
        if time.monotonic() - asked > (DISCOVERY_S if done < 1 else ANSWER_S):
            sys.exit(f"no answer to number {done + 1}")
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main(*sys.argv[1:])
