"""The marking robot, simulated: it drives while the safety node lives and does not stop it."""

from __future__ import annotations

import math

from intelligent_one_robot.marking_robot_base import MarkingRobotBase, run
from nav_msgs.msg import Odometry
from rclpy.clock import Clock, ClockType
from sensor_msgs.msg import Imu
from std_msgs.msg import Bool, UInt64

CRUISING, RACING = 0.4, 0.7
"""Speeds in m/s: as planned, and with the fault."""

LEANING = math.radians(14.0)
"""Roll, in rad, with the fault."""

SILENCE = 0.5
"""Seconds without a heartbeat after which the safety node is taken to be dead."""


class MarkingRobot(MarkingRobotBase):
    """Shows its speed and its attitude, and obeys the stop."""

    def __init__(self) -> None:
        """Wait for the first heartbeat."""
        super().__init__()
        self._steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._set_off: float | None = None
        self._heartbeat = -math.inf
        self._stopped = False

    def on_heartbeat(self, _msg: UInt64) -> None:
        """Note that the safety node lives, and set off when it has come to life."""
        self._heartbeat = self._now()
        if self._set_off is None:
            self._set_off = self._heartbeat
            self.get_logger().info(f'driving at {CRUISING} m/s')

    def on_stop(self, msg: Bool) -> None:
        """Stand still while the safety node says so."""
        if msg.data and not self._stopped:
            self.get_logger().warning('stopped by the safety node')
        self._stopped = msg.data

    def on_cycle(self) -> None:
        """Measure speed and attitude."""
        now = self._now()
        driving = not self._stopped and now - self._heartbeat < SILENCE
        faulty = self._set_off is not None and now - self._set_off >= self.parameters.fault_after
        racing = faulty and self.parameters.fault == 'speed'
        if racing:
            self.get_logger().warning(f'the throttle sticks at {RACING} m/s', once=True)
        odometry = Odometry()
        if driving:
            odometry.twist.twist.linear.x = RACING if racing else CRUISING
        self.publish_odometry(odometry)
        roll = LEANING if faulty and self.parameters.fault == 'tilt' else 0.0
        imu = Imu()
        imu.orientation.x, imu.orientation.w = math.sin(roll / 2), math.cos(roll / 2)
        self.publish_imu(imu)

    def _now(self) -> float:
        return float(self._steady.now().nanoseconds) / 1e9


def main(args: list[str] | None = None) -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(MarkingRobot, args)


if __name__ == '__main__':
    main()
