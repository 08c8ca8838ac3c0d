"""The loads under which the cost is measured, and who puts the nodes under them."""

from __future__ import annotations

import heapq
import math
import random
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import cycle
from typing import Any

import rclpy
from cost_nodes.topics import SENSOR_QOS, TYPES
from nav_msgs.msg import Odometry
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.serialization import serialize_message
from rclpy.utilities import try_shutdown
from sensor_msgs.msg import Imu, LaserScan
from std_msgs.msg import Bool

VARIANTS = 64
"""How many different messages each topic carries in turn: sensors are noisy."""

RANGES = 2000
"""Beams of a laser scan."""

_random = random.Random(1)


@dataclass(frozen=True, slots=True)
class Load:
    """How many messages per second each topic carries; none on those not named."""

    name: str
    rates: dict[str, float] = field(default_factory=dict)


_PAPER = {"imu": 100.0, "odometry": 50.0, "scan": 20.0}
IDLE = Load("nothing published")
PAPER = Load("the paper's: IMU 100 Hz, odometry 50 Hz, scan 20 Hz", _PAPER)
SECOND_SCAN = Load("the paper's, and another scan at 40 Hz", {**_PAPER, "rear_scan": 40.0})
KILOHERTZ = Load("the paper's, with the IMU at 1 kHz", {**_PAPER, "imu": 1000.0})
LOADS = (IDLE, PAPER, SECOND_SCAN, KILOHERTZ)


class Talker:
    """Publishes to the topics of one node at a time; ends with :meth:`close`.

    Args:
        namespaces: those of the nodes.
    """

    def __init__(self, namespaces: tuple[str, ...]) -> None:
        """Join the ROS domain that the environment names."""
        rclpy.init()
        self._node: Any = Node("sensors")
        self._publishers = {
            (namespace, topic): self._node.create_publisher(
                kind, f"/{namespace}/{topic}", SENSOR_QOS
            )
            for namespace in namespaces
            for topic, kind in TYPES.items()
        }
        makers = {"imu": _imu, "odometry": _odometry, "scan": _scan, "rear_scan": _scan}
        self._messages = {
            topic: cycle([serialize_message(maker()) for _ in range(VARIANTS)])
            for topic, maker in makers.items()
        }
        self.sent = dict.fromkeys(namespaces, 0)

    def meet(self, seconds: float, watch: Callable[[], None]) -> None:
        """Wait until every topic has a subscriber; ``watch`` is called meanwhile.

        Raises:
            TimeoutError: if one still has none after so many seconds.
        """
        end = time.monotonic() + seconds
        while missing := [
            publisher.topic_name
            for publisher in self._publishers.values()
            if not publisher.get_subscription_count()
        ]:
            if time.monotonic() > end:
                raise TimeoutError(f"no endpoint is connected to {', '.join(missing)}")
            watch()
            rclpy.spin_once(self._node, timeout_sec=0.02)

    def feed(self, namespace: str, load: Load, seconds: float) -> None:
        """Put one node under a load for a while."""
        now = time.monotonic()
        end = now + seconds
        due = [(now + _random.random() / rate, topic) for topic, rate in load.rates.items()]
        due.append((end, ""))
        heapq.heapify(due)
        while due[0][1]:
            at, topic = due[0]
            if (left := at - time.monotonic()) > 0:
                time.sleep(left)
            self._publishers[namespace, topic].publish(next(self._messages[topic]))
            self.sent[namespace] += 1
            heapq.heapreplace(due, (at + 1.0 / load.rates[topic], topic))
        time.sleep(max(end - time.monotonic(), 0.0))

    def see_stop(self, namespace: str, seconds: float) -> bool:
        """Tilt a safety node far, again and again, until it stops; tell whether it did in time."""
        stops: list[bool] = []
        qos = QoSProfile(depth=10)
        self._node.create_subscription(
            Bool, f"/{namespace}/stop", lambda msg: stops.append(msg.data), qos
        )
        tilted = serialize_message(_imu(math.radians(40.0)))
        executor = SingleThreadedExecutor()
        executor.add_node(self._node)
        end = time.monotonic() + seconds
        while not any(stops) and time.monotonic() < end:
            self._publishers[namespace, "imu"].publish(tilted)
            executor.spin_once(timeout_sec=0.05)
        executor.shutdown()
        return any(stops)

    def close(self) -> None:
        """Leave the domain."""
        self._node.destroy_node()
        try_shutdown()


def _imu(roll: float = 0.0) -> Imu:
    message = Imu()
    message.header.frame_id = "imu_link"
    roll += _random.gauss(0.0, 0.01)
    message.orientation.x, message.orientation.w = math.sin(roll / 2), math.cos(roll / 2)
    message.angular_velocity.z = _random.gauss(0.0, 0.02)
    message.linear_acceleration.z = _random.gauss(9.81, 0.05)
    return message


def _odometry() -> Odometry:
    message = Odometry()
    message.header.frame_id, message.child_frame_id = "odom", "base_link"
    message.pose.pose.position.x = _random.uniform(0.0, 100.0)
    message.twist.twist.linear.x = _random.gauss(0.3, 0.02)
    return message


def _scan() -> LaserScan:
    message = LaserScan()
    message.header.frame_id = "laser"
    message.angle_min, message.angle_max = -math.pi, math.pi
    message.angle_increment = 2.0 * math.pi / RANGES
    message.range_min, message.range_max = 0.1, 30.0
    message.ranges = [_random.uniform(5.0, 25.0) for _ in range(RANGES)]
    message.intensities = [_random.uniform(0.0, 255.0) for _ in range(RANGES)]
    return message
