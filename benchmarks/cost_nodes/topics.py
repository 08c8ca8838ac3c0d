"""The topics that all nodes listen to, each node in a namespace of its own."""

from __future__ import annotations

from nav_msgs.msg import Odometry
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import Imu, LaserScan

SENSOR_QOS = QoSProfile(reliability=ReliabilityPolicy.BEST_EFFORT, depth=10)
"""As the safety node subscribes."""

TYPES: dict[str, type] = {
    "imu": Imu,
    "odometry": Odometry,
    "scan": LaserScan,
    "rear_scan": LaserScan,
}
"""The message type of each topic."""
