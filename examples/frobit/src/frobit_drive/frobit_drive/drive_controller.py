"""Drives the two wheels as commanded, and tells by them where the robot is."""

from __future__ import annotations

import math

from frobit_drive.differential import Axle, Pose, towards
from frobit_drive.drive_controller_base import DriveControllerBase, run
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from std_msgs.msg import Float64

PERIOD = 0.02
"""Time, in s, from one cycle of control to the next."""

NEVER = -math.inf


class DriveController(DriveControllerBase):
    """Works at a fixed rate; a command that is too old is one to stand."""

    def __init__(self) -> None:
        """Stand at the origin of the odometry."""
        super().__init__()
        self._axle = Axle(self.parameters.wheel_radius, self.parameters.wheel_distance)
        self._pose = Pose()
        self._wanted = (0.0, 0.0)
        self._commanded_at = NEVER
        self._setpoints = (0.0, 0.0)
        self._speeds = [0.0, 0.0]
        self._measured_at = [NEVER, NEVER]

    def on_command(self, msg: Twist) -> None:
        """Take a command of the gate."""
        self._wanted = self._axle.wheels(msg.linear.x, msg.angular.z)
        self._commanded_at = self._now()

    def on_left_speed(self, msg: Float64) -> None:
        """Take the speed of the left wheel."""
        self._measure(0, msg.data)

    def on_right_speed(self, msg: Float64) -> None:
        """Take the speed of the right wheel."""
        self._measure(1, msg.data)

    def on_control(self) -> None:
        """Set both wheels, and report the motion while both are heard."""
        now, timeout = self._now(), self.parameters.timeout
        wanted = self._wanted if now - self._commanded_at <= timeout else (0.0, 0.0)
        most = self.parameters.acceleration / self.parameters.wheel_radius * PERIOD
        left = towards(self._setpoints[0], wanted[0], most)
        right = towards(self._setpoints[1], wanted[1], most)
        self._setpoints = (left, right)
        self.publish_left_setpoint(Float64(data=left))
        self.publish_right_setpoint(Float64(data=right))
        if now - min(self._measured_at) <= timeout:
            self._report(*self._axle.motion(*self._speeds))

    def _measure(self, side: int, speed: float) -> None:
        self._speeds[side] = speed
        self._measured_at[side] = self._now()

    def _report(self, forward: float, turn: float) -> None:
        self._pose.advance(forward, turn, PERIOD)
        msg = Odometry()
        msg.header.stamp = self.get_clock().now().to_msg()
        msg.header.frame_id, msg.child_frame_id = 'odom', 'base_link'
        pose = msg.pose.pose
        pose.position.x, pose.position.y = self._pose.x, self._pose.y
        pose.orientation.z = math.sin(self._pose.yaw / 2)
        pose.orientation.w = math.cos(self._pose.yaw / 2)
        msg.twist.twist.linear.x = forward
        msg.twist.twist.angular.z = turn
        self.publish_odometry(msg)

    def _now(self) -> float:
        return float(self.clock_of_timers.now().nanoseconds) / 1e9


def main(args: list[str] | None = None) -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(DriveController, args)


if __name__ == '__main__':
    main()
