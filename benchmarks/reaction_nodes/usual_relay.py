"""A relay as rclpy's tutorials write it: typed messages, the default executor, nothing else."""

from __future__ import annotations

import contextlib

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import Imu
from std_msgs.msg import Bool

from reaction_nodes.common import IMU_QOS, STATE_QOS


class UsualRelay(Node):
    """Publishes a state for every message."""

    def __init__(self) -> None:
        """Open both ends."""
        super().__init__("usual_relay")
        self._publisher = self.create_publisher(Bool, "state", STATE_QOS)
        self.create_subscription(Imu, "imu", self._on_imu, IMU_QOS)

    def _on_imu(self, _: Imu) -> None:
        self._publisher.publish(Bool(data=True))


def main() -> None:
    """Run until SIGINT or SIGTERM."""
    rclpy.init()
    with contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(UsualRelay())


if __name__ == "__main__":
    main()
