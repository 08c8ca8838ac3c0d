"""The marking robot with its driver in physics, with the faults of its hardware, and a bank."""

from __future__ import annotations

import math

from builtin_interfaces.msg import Time
from geometry_msgs.msg import Quaternion, Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Imu
from wheeled_physics.experiment import begin, truth
from wheeled_physics.intelligent_one_board import IntelligentOneBoard
from wheeled_physics.intelligent_one_in_physics_base import IntelligentOneInPhysicsBase, run
from wheeled_physics.robot import Robot


class IntelligentOneInPhysics(IntelligentOneInPhysicsBase):
    """Wishes to drive along its lines, drives as commanded, and reports what its sensors show."""

    def __init__(self) -> None:
        """Stand at the first corner of the field."""
        super().__init__()
        self._board = IntelligentOneBoard(self.parameters.seed)
        self._experiment = begin(self, self._board)

    def on_command(self, msg: Twist) -> None:
        """Drive as the gate says."""
        self._board.command(msg.linear.x, msg.angular.z)

    def on_cycle(self) -> None:
        """Let the time since the last cycle pass, report, and go on along the lines."""
        stamp = self._experiment.advance()
        board = self._board
        self.publish_truth(truth(board.robot, stamp))
        if board.robot.heard:
            if board.reckon():
                self.publish_odometry(_odometry(board, stamp))
            self.publish_imu(_imu(board.robot, stamp))
        wish = Twist()
        wish.linear.x, wish.angular.z = board.wish()
        self.publish_wish(wish)


def _odometry(board: IntelligentOneBoard, stamp: Time) -> Odometry:
    msg = Odometry()
    msg.header.stamp = stamp
    msg.header.frame_id, msg.child_frame_id = 'odom', 'base_link'
    pose, twist = msg.pose.pose, msg.twist.twist
    pose.position.x, pose.position.y = board.pose.x, board.pose.y
    pose.orientation.z = math.sin(board.pose.yaw / 2)
    pose.orientation.w = math.cos(board.pose.yaw / 2)
    twist.linear.x, twist.angular.z = board.motion
    return msg


def _imu(robot: Robot, stamp: Time) -> Imu:
    x, y, z, w = robot.imu()
    msg = Imu(orientation=Quaternion(x=x, y=y, z=z, w=w))
    msg.header.stamp = stamp
    msg.header.frame_id = 'imu_link'
    msg.angular_velocity_covariance[0] = -1.0  # neither is reported
    msg.linear_acceleration_covariance[0] = -1.0
    return msg


def main(args: list[str] | None = None) -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(IntelligentOneInPhysics, args)


if __name__ == '__main__':
    main()
