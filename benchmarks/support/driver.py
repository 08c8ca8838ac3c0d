"""The end of all topics that a benchmark holds: it publishes, receives and takes the time.

It runs in the fastest executor of rclpy and handles bytes alone, so that little of what is
measured is its own; what is left of that is the same for everybody measured.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from typing import Any

import rclpy
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.serialization import serialize_message
from rclpy.utilities import ok, try_shutdown
from reaction_nodes.common import IMU_QOS, RECORD_QOS
from sensor_msgs.msg import Imu
from std_msgs.msg import Bool

from support.reaction_rules import Lane

_STATE_QOS = QoSProfile(reliability=ReliabilityPolicy.RELIABLE, depth=10)
_STATE = 4
"""Where in the bytes of a Bool its value stands: after the encapsulation."""


def _imu(roll: float) -> bytes:
    message = Imu()
    message.header.frame_id = "imu_link"
    message.orientation.x = math.sin(roll / 2)
    message.orientation.w = math.cos(roll / 2)
    return bytes(serialize_message(message))


class Channel:
    """Both topics of a lane, from the driver's side.

    Args:
        driver: the driver.
        node: its node.
        lane: the topics.
        resets: whether the other side's state turns false when it is levelled; a relay's is
            always true.
    """

    TILTED = _imu(math.radians(20.0))
    LEVEL = _imu(0.0)

    def __init__(self, driver: Driver, node: Any, lane: Lane, resets: bool) -> None:
        """Open both topics."""
        self._driver = driver
        self.lane = lane
        self.resets = resets
        self.sent = 0
        self.received = 0
        self._expected = -1
        self._publisher = node.create_publisher(Imu, lane.imu, IMU_QOS)
        self._subscription = node.create_subscription(
            Bool, lane.state, self._on_state, _STATE_QOS, raw=True
        )

    def tilt(self) -> None:
        """Tilt; the answer is a true state, at :attr:`received` by CLOCK_MONOTONIC in ns."""
        self._publish(self.TILTED, 1)

    def ask(self, tilted: bool, limit: int) -> bool:
        """Tilt or level, and receive until the answer comes, for at most ``limit`` ns.

        Returns:
            whether it came: a true state, or, if the other side resets it, a false one of level.
        """
        if tilted:
            self.tilt()
        else:
            self._publish(self.LEVEL, 0 if self.resets else 1)
        end = time.monotonic_ns() + limit
        while not self.received:
            if (left := end - time.monotonic_ns()) <= 0:
                self._expected = -1
                return False
            self._driver.spin_once(left)
        return True

    def is_met(self) -> bool:
        """Return whether all other endpoints are connected."""
        return bool(
            self._publisher.get_subscription_count() and self._subscription.get_publisher_count()
        )

    def _publish(self, message: bytes, expected: int) -> None:
        self._expected = expected
        self.received = 0
        self.sent = time.monotonic_ns()
        self._publisher.publish(message)

    def _on_state(self, data: bytes) -> None:
        now = time.monotonic_ns()
        if data[_STATE] == self._expected:
            self._expected = -1
            self.received = now


class Driver:
    """The benchmark's node with its channels; ends with :meth:`close`.

    Args:
        records: further topics, with their types, whose messages are kept as they come.
    """

    def __init__(self, records: Sequence[tuple[str, type]]) -> None:
        """Join the ROS domain that the environment names."""
        rclpy.init()
        self._node = Node("benchmark")
        self._executor = EventsExecutor()
        self._executor.add_node(self._node)
        self._channels: list[Channel] = []
        self.records: dict[str, list[bytes]] = {}
        for topic, kind in records:
            kept = self.records[topic] = []
            self._node.create_subscription(kind, topic, kept.append, RECORD_QOS, raw=True)

    def channel(self, lane: Lane, resets: bool = False) -> Channel:
        """Open the topics of a lane."""
        channel = Channel(self, self._node, lane, resets)
        self._channels.append(channel)
        return channel

    def meet(self, seconds: float, watch: Callable[[], None]) -> None:
        """Wait until all endpoints are connected; ``watch`` is called often.

        Raises:
            TimeoutError: if there still is not after so many seconds.
        """
        end = time.monotonic() + seconds
        while missing := self._missing():
            if time.monotonic() > end:
                raise TimeoutError(f"no endpoint is connected to {', '.join(missing)}")
            watch()
            self.spin_once(20_000_000)

    def _missing(self) -> list[str]:
        lanes = [each.lane.imu for each in self._channels if not each.is_met()]
        return lanes + [each for each in self.records if not self._node.count_publishers(each)]

    def spin_until(self, instant: int) -> None:
        """Receive until an instant of CLOCK_MONOTONIC, in ns."""
        while (left := instant - time.monotonic_ns()) > 0:
            self.spin_once(left)

    def spin_once(self, limit: int) -> None:
        """Receive what comes next, if anything does within ``limit`` ns."""
        self._executor.spin_once(timeout_sec=limit / 1e9)
        if not ok():
            raise KeyboardInterrupt

    def close(self) -> None:
        """Leave the domain."""
        self._executor.shutdown()
        self._node.destroy_node()
        try_shutdown()
