"""The base of the Kobuki with its driver in physics, with the faults of its hardware."""

from __future__ import annotations

import math

from geometry_msgs.msg import Twist
from kobuki_base.odometry import DeadReckoning
from nav_msgs.msg import Odometry
from rclpy.clock import Clock, ClockType
from sensor_msgs.msg import BatteryState, Imu
from std_msgs.msg import Bool, UInt8
from wheeled_physics.experiment import Experiment, truth
from wheeled_physics.kobuki_board import KobukiBoard
from wheeled_physics.kobuki_in_physics_base import KobukiInPhysicsBase, run


class KobukiInPhysics(KobukiInPhysicsBase):
    """Drives as commanded, and reports what its sensors show."""

    def __init__(self) -> None:
        """Stand in the middle of the room, with a full battery."""
        super().__init__()
        self._steady = Clock(clock_type=ClockType.STEADY_TIME)
        given = self.parameters
        self._board = KobukiBoard(given.seed)
        self._reckoning = DeadReckoning()
        self._experiment = Experiment(
            self._board, given.fault, given.fault_after, self._now(), self.get_logger().warning
        )

    def on_command(self, msg: Twist) -> None:
        """Drive as the gate says."""
        self._board.command(msg.linear.x, msg.angular.z)

    def on_motors_off(self, msg: Bool) -> None:
        """Take the power of the motors, or give it back; the relay has a line of its own."""
        self._board.robot.relay(msg.data)

    def on_cycle(self) -> None:
        """Let the time since the last cycle pass, and report."""
        self._experiment.advance(self._now())
        robot = self._board.robot
        stamp = self.get_clock().now().to_msg()
        self.publish_truth(truth(robot, stamp))
        if not robot.heard:
            return
        if self._reckoning.count(*self._board.counters(), self._board.stamp()):
            self._report_odometry()
        imu = Imu()
        imu.header.stamp = stamp
        imu.header.frame_id = 'gyro_link'
        imu.orientation_covariance[0] = -1.0  # it has none
        imu.linear_acceleration_covariance[0] = -1.0
        imu.angular_velocity.z = robot.gyro()
        self.publish_imu(imu)
        self.publish_bumper(UInt8(data=self._board.bumper()))
        battery = BatteryState(voltage=robot.voltage, percentage=robot.charge)
        battery.header.stamp = stamp
        battery.present = True
        self.publish_battery(battery)

    def _report_odometry(self) -> None:
        msg = Odometry()
        msg.header.stamp = self.get_clock().now().to_msg()
        msg.header.frame_id, msg.child_frame_id = 'odom', 'base_footprint'
        pose, twist = msg.pose.pose, msg.twist.twist
        pose.position.x, pose.position.y = self._reckoning.x, self._reckoning.y
        pose.orientation.z = math.sin(self._reckoning.yaw / 2)
        pose.orientation.w = math.cos(self._reckoning.yaw / 2)
        twist.linear.x, twist.angular.z = self._reckoning.forward, self._reckoning.turn
        self.publish_odometry(msg)

    def _now(self) -> float:
        return float(self._steady.now().nanoseconds) / 1e9


def main(args: list[str] | None = None) -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(KobukiInPhysics, args)


if __name__ == '__main__':
    main()
