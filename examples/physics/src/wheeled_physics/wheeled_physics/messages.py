"""What odometry, IMU and laser scanner of a robot in physics show, as messages."""

from __future__ import annotations

import math

from builtin_interfaces.msg import Time
from geometry_msgs.msg import Quaternion
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Imu, LaserScan
from wheeled_physics.measures import Lidar
from wheeled_physics.reckoning_board import ReckoningBoard
from wheeled_physics.robot import Robot


def odometry_message(board: ReckoningBoard, stamp: Time) -> Odometry:
    """Return where the encoders say that a robot is, and how it moves."""
    msg = Odometry()
    msg.header.stamp = stamp
    msg.header.frame_id, msg.child_frame_id = 'odom', 'base_link'
    pose, twist = msg.pose.pose, msg.twist.twist
    pose.position.x, pose.position.y = board.pose.x, board.pose.y
    pose.orientation.z = math.sin(board.pose.yaw / 2)
    pose.orientation.w = math.cos(board.pose.yaw / 2)
    twist.linear.x, twist.angular.z = board.motion
    return msg


def imu_message(robot: Robot, stamp: Time) -> Imu:
    """Return how an IMU says that a robot stands."""
    x, y, z, w = robot.imu()
    msg = Imu(orientation=Quaternion(x=x, y=y, z=z, w=w))
    msg.header.stamp = stamp
    msg.header.frame_id = 'imu_link'
    msg.angular_velocity_covariance[0] = -1.0  # neither is reported
    msg.linear_acceleration_covariance[0] = -1.0
    return msg


def scan_message(lidar: Lidar, ranges: list[float], stamp: Time) -> LaserScan:
    """Return a sweep of a laser scanner."""
    msg = LaserScan(ranges=ranges)
    msg.header.stamp = stamp
    msg.header.frame_id = 'lidar_link'
    msg.angle_min, msg.angle_max = -lidar.half_angle, lidar.half_angle
    msg.angle_increment = 2 * lidar.half_angle / (lidar.beams - 1)
    msg.range_min, msg.range_max = lidar.range_min, lidar.range_max
    return msg
