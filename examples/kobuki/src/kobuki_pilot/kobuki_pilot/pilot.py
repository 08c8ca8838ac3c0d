"""Drives along a star, or, with a fault, out of the yard, or without leaving the processor."""

from __future__ import annotations

import math
from threading import Thread

from geometry_msgs.msg import Twist
from kobuki_pilot.pilot_base import PilotBase, run
from kobuki_pilot.star import stands, Star
from nav_msgs.msg import Odometry
from sensor_msgs.msg import BatteryState
from std_msgs.msg import UInt8

NEVER = -math.inf
MOVES = 0.05
"""Speed, in m/s, from which the robot counts as moving."""


def work_without_end() -> None:
    """Use all of a processor."""
    number = 0
    while True:
        number = (number * 1103515245 + 12345) % 2**31


class Pilot(PilotBase):
    """Commands at a fixed rate: the way to the next point, or zero."""

    def __init__(self) -> None:
        """Stand until odometry, bumper and battery have been heard."""
        super().__init__()
        self._star = Star(self.parameters.cruise_speed)
        self._started = self._now()
        self._pose = (0.0, 0.0, 0.0)
        self._located_at = NEVER
        self._bumped = 0
        self._felt_at = NEVER
        self._voltage = 0.0
        self._moving_since: float | None = None
        self._fault = ''

    def on_odometry(self, msg: Odometry) -> None:
        """Take the pose."""
        pose, now = msg.pose.pose, self._now()
        yaw = 2.0 * math.atan2(pose.orientation.z, pose.orientation.w)
        self._pose = (pose.position.x, pose.position.y, yaw)
        self._located_at = now
        if self._moving_since is None and abs(msg.twist.twist.linear.x) > MOVES:
            self._moving_since = now

    def on_bumper(self, msg: UInt8) -> None:
        """Take the state of the bumper."""
        self._bumped = msg.data
        self._felt_at = self._now()

    def on_battery(self, msg: BatteryState) -> None:
        """Take the voltage."""
        self._voltage = msg.voltage

    def on_control(self) -> None:
        """Drive on, or stand."""
        self._fail_in_time()
        command = Twist()
        if self._may_drive():
            if self._fault == 'astray':
                command.linear.x = self.parameters.cruise_speed
            else:
                command.linear.x, command.angular.z = self._star.command(*self._pose)
        self.publish_command(command)

    def _may_drive(self) -> bool:
        now = self._now()
        heard = now - min(self._located_at, self._felt_at) <= self.parameters.timeout
        able = self._voltage >= self.parameters.low_battery and not self._bumped
        return heard and able and not stands(now - self._started)

    def _fail_in_time(self) -> None:
        since, fault = self._moving_since, self.parameters.fault
        if fault == 'none' or self._fault or since is None:
            return
        if self._now() - since >= self.parameters.fault_after:
            self._fault = fault
            self.get_logger().warning(f'fault: {fault}')
            if fault == 'load':
                Thread(target=work_without_end, daemon=True).start()

    def _now(self) -> float:
        return float(self.clock_of_timers.now().nanoseconds) / 1e9


def main(args: list[str] | None = None) -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(Pilot, args)


if __name__ == '__main__':
    main()
