"""The marking robot, simulated: it follows its route as far as the gate in between lets it."""

from __future__ import annotations

import math

from geometry_msgs.msg import Twist
from intelligent_one_robot.marking_robot_base import MarkingRobotBase, run
from nav_msgs.msg import Odometry
from rclpy.clock import Clock, ClockType
from sensor_msgs.msg import Imu

CRUISING, RACING = 0.4, 0.7
"""Speeds in m/s: as planned, and with the fault."""

PAUSE = 1.0
"""Time in s for which it stands before each attempt to set off, and for which it tries."""

SILENCE = 0.45
"""Time in s without a command after which it stops; a cycle later it stands."""

LEANING = math.radians(14.0)
"""Roll, in rad, with the fault."""


class MarkingRobot(MarkingRobotBase):
    """Wishes to drive, drives as commanded, and shows its speed and its attitude."""

    def __init__(self) -> None:
        """Stand until there is a command."""
        super().__init__()
        self._steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._started = self._now()
        self._set_off: float | None = None
        self._driving = False
        self._stopped = False
        self._commanded = self._started

    def on_command(self, msg: Twist) -> None:
        """Drive or stand."""
        self._commanded = self._now()
        driving = msg.linear.x != 0.0
        if driving and self._set_off is None:
            self._set_off = self._now()
            self.get_logger().info(f'driving at {CRUISING} m/s')
        if self._driving and not driving:
            self.get_logger().warning('stopped by the gate')
            self._stopped = True  # for good: the route is begun anew by whoever starts the robot
        self._driving = driving

    def on_cycle(self) -> None:
        """Go on along the route, and measure speed and attitude."""
        if self._driving and self._now() - self._commanded > SILENCE:
            self.get_logger().warning('stopped: there are no commands')
            self._driving, self._stopped = False, True
        wish = Twist()
        wish.linear.x = self._wished_speed()
        self.publish_wish(wish)
        since = self._set_off
        faulty = since is not None and self._now() - since >= self.parameters.fault_after
        racing = faulty and self.parameters.fault == 'speed'
        if racing:
            self.get_logger().warning(f'the throttle sticks at {RACING} m/s', once=True)
        odometry = Odometry()
        if self._driving:
            odometry.twist.twist.linear.x = RACING if racing else CRUISING
        self.publish_odometry(odometry)
        roll = LEANING if faulty and self.parameters.fault == 'tilt' else 0.0
        imu = Imu()
        imu.orientation.x, imu.orientation.w = math.sin(roll / 2), math.cos(roll / 2)
        self.publish_imu(imu)

    def _wished_speed(self) -> float:
        """Return zero after a stop and before each attempt to set off: the gate waits for it."""
        if self._stopped:
            return 0.0
        stands = self._set_off is None and (self._now() - self._started) % (2 * PAUSE) < PAUSE
        return 0.0 if stands else CRUISING

    def _now(self) -> float:
        return float(self._steady.now().nanoseconds) / 1e9


def main(args: list[str] | None = None) -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(MarkingRobot, args)


if __name__ == '__main__':
    main()
