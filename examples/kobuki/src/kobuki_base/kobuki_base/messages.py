"""What the Kobuki's driver reports of its sensors, as messages."""

from __future__ import annotations

import math

from builtin_interfaces.msg import Time
from kobuki_base.odometry import DeadReckoning
from nav_msgs.msg import Odometry
from sensor_msgs.msg import BatteryState, Imu


def odometry_message(reckoning: DeadReckoning, stamp: Time) -> Odometry:
    """Return where the robot is by its odometry, and how it moves."""
    msg = Odometry()
    msg.header.stamp = stamp
    msg.header.frame_id, msg.child_frame_id = 'odom', 'base_footprint'
    pose, twist = msg.pose.pose, msg.twist.twist
    pose.position.x, pose.position.y = reckoning.x, reckoning.y
    pose.orientation.z = math.sin(reckoning.yaw / 2)
    pose.orientation.w = math.cos(reckoning.yaw / 2)
    twist.linear.x, twist.angular.z = reckoning.forward, reckoning.turn
    return msg


def imu_message(turn: float, stamp: Time) -> Imu:
    """Return the turn rate (rad/s) about the vertical axis; the gyroscope knows nothing else."""
    msg = Imu()
    msg.header.stamp = stamp
    msg.header.frame_id = 'gyro_link'
    msg.orientation_covariance[0] = -1.0  # it has none
    msg.linear_acceleration_covariance[0] = -1.0
    msg.angular_velocity.z = turn
    return msg


def battery_message(voltage: float, charge: float, stamp: Time) -> BatteryState:
    """Return the voltage of the battery (V), and how full it is, from 0 to 1."""
    msg = BatteryState(voltage=voltage, percentage=charge)
    msg.header.stamp = stamp
    msg.present = True
    return msg
