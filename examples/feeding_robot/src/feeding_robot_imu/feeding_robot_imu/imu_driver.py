"""Inertial measurement unit: the true attitude with the sensor's noise."""

from __future__ import annotations

import math
import random

from feeding_robot_imu.attitude import disturbed
from feeding_robot_imu.imu_driver_base import ImuDriverBase, run
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Imu

GRAVITY = 9.81
"""Acceleration, in m/s^2, that the sensor shows at rest."""


class ImuDriver(ImuDriverBase):
    """Answers each report of the truth with a measurement."""

    def __init__(self) -> None:
        """Seed the noise, so that runs can be repeated."""
        super().__init__()
        self._noise = random.Random(self.parameters.seed)

    def on_motion(self, msg: Odometry) -> None:
        """Measure the attitude and the turn rate."""
        true = msg.pose.pose.orientation
        shown = disturbed(
            (true.x, true.y, true.z, true.w), math.radians(self.parameters.noise), self._noise
        )
        imu = Imu()
        imu.header.stamp = self.get_clock().now().to_msg()
        imu.header.frame_id = self.parameters.frame_id
        (
            imu.orientation.x,
            imu.orientation.y,
            imu.orientation.z,
            imu.orientation.w,
        ) = shown
        imu.angular_velocity.z = msg.twist.twist.angular.z
        imu.linear_acceleration.z = GRAVITY
        self.publish_imu(imu)


def main(args: list[str] | None = None) -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(ImuDriver, args)


if __name__ == '__main__':
    main()
