"""Drives along the feeding lane and signals that the main controller lives."""

from __future__ import annotations

import math

from feeding_robot_mission.mission import Mission
from feeding_robot_mission.mission_controller_base import MissionControllerBase, run
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.clock import Clock, ClockType
from std_msgs.msg import Bool, UInt64, UInt8

AUTOMATIC = 2
"""The position of the mode switch in which the mission drives."""


class MissionController(MissionControllerBase):
    """Answers each odometry message with a command."""

    def __init__(self) -> None:
        """Wait for an order."""
        super().__init__()
        self._mission = Mission(self.parameters.cruise_speed, self.parameters.acceleration)
        simulated = self.get_parameter('use_sim_time').value
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._clock = self.get_clock() if simulated else steady
        self._last = self._clock.now().nanoseconds
        self._ordered = False
        self._automatic = False
        self._controller_ok = False
        self._beats = 0

    def on_odometry(self, msg: Odometry) -> None:
        """Plan one step ahead."""
        now = self._clock.now().nanoseconds
        duration, self._last = (now - self._last) / 1e9, now
        pose = msg.pose.pose
        command = self._mission.plan(
            self._ordered and self._automatic and self._controller_ok,
            pose.position.y,
            2 * math.atan2(pose.orientation.z, pose.orientation.w),
            duration,
        )
        wanted = Twist()
        wanted.linear.x, wanted.angular.z = command.speed, command.steering
        self.publish_command(wanted)
        self._beats += 1
        self.publish_keep_alive(UInt64(data=self._beats))

    def on_order(self, msg: Bool) -> None:
        """Take the farmer's order."""
        self._ordered = msg.data

    def on_mode(self, msg: UInt8) -> None:
        """Follow the mode switch."""
        self._automatic = msg.data == AUTOMATIC

    def on_controller_ok(self, msg: Bool) -> None:
        """Hold while the safety node has reason to stop the robot."""
        self._controller_ok = msg.data


def main(args: list[str] | None = None) -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(MissionController, args)


if __name__ == '__main__':
    main()
