"""Laser scanner on the front of the robot."""

from __future__ import annotations

import math

from feeding_robot_lidar.lidar_driver_base import LidarDriverBase, run
from feeding_robot_lidar.sweep import ranges
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float64

RANGE_MIN = 0.05
"""Shortest distance, in m, that the scanner measures."""


class LidarDriver(LidarDriverBase):
    """Answers each report of the clearance with a scan."""

    def on_clearance(self, msg: Float64) -> None:
        """Sweep once."""
        scan = LaserScan()
        scan.header.stamp = self.get_clock().now().to_msg()
        scan.header.frame_id = self.parameters.frame_id
        scan.angle_min, scan.angle_max = -math.pi / 2, math.pi / 2
        scan.angle_increment = math.pi / (self.parameters.beams - 1)
        scan.range_min, scan.range_max = RANGE_MIN, self.parameters.range_max
        nearest = max(msg.data, RANGE_MIN)
        scan.ranges = ranges(nearest, self.parameters.beams, self.parameters.range_max)
        self.publish_scan(scan)


def main(args: list[str] | None = None) -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(LidarDriver, args)


if __name__ == '__main__':
    main()
