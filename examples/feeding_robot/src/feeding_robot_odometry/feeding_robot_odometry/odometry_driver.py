"""Wheel odometry: the true motion with the error of slipping wheels."""

from __future__ import annotations

import random

from feeding_robot_odometry.odometry_driver_base import OdometryDriverBase, run
from nav_msgs.msg import Odometry


class OdometryDriver(OdometryDriverBase):
    """Answers each report of the truth with what the encoders make of it."""

    def __init__(self) -> None:
        """Seed the noise, so that runs can be repeated."""
        super().__init__()
        self._noise = random.Random(self.parameters.seed)

    def on_motion(self, msg: Odometry) -> None:
        """Measure pose and speed; encoders at rest have no noise."""
        odometry = Odometry()
        odometry.header.stamp = self.get_clock().now().to_msg()
        odometry.header.frame_id = 'odom'
        odometry.child_frame_id = self.parameters.child_frame_id
        odometry.pose.pose = msg.pose.pose
        slip = self._noise.gauss(1.0, self.parameters.noise)
        odometry.twist.twist.linear.x = msg.twist.twist.linear.x * slip
        odometry.twist.twist.angular.z = msg.twist.twist.angular.z
        self.publish_odometry(odometry)


def main(args: list[str] | None = None) -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(OdometryDriver, args)


if __name__ == '__main__':
    main()
