"""Drives the route while a person holds the deadman's switch."""

from __future__ import annotations

import math

from frobit_route.route import pairs, Route
from frobit_route.route_driver_base import RouteDriverBase, run
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import BatteryState
from std_msgs.msg import Bool

NEVER = -math.inf


class RouteDriver(RouteDriverBase):
    """Commands at a fixed rate: the way to the next waypoint, or zero."""

    def __init__(self) -> None:
        """Stand until switch, odometry and battery have been heard."""
        super().__init__()
        self._route = Route(pairs(self.parameters.waypoints), self.parameters.cruise_speed)
        self._pose = (0.0, 0.0, 0.0)
        self._located_at = NEVER
        self._voltage = 0.0
        self._held = False
        self._held_at = NEVER

    def on_odometry(self, msg: Odometry) -> None:
        """Take the pose."""
        pose = msg.pose.pose
        yaw = 2.0 * math.atan2(pose.orientation.z, pose.orientation.w)
        self._pose = (pose.position.x, pose.position.y, yaw)
        self._located_at = self._now()

    def on_battery(self, msg: BatteryState) -> None:
        """Take the voltage."""
        self._voltage = msg.voltage

    def on_deadman(self, msg: Bool) -> None:
        """Take the state of the switch."""
        self._held = msg.data
        self._held_at = self._now()

    def on_control(self) -> None:
        """Drive on, or stand."""
        command = Twist()
        if self._may_drive():
            command.linear.x, command.angular.z = self._route.command(*self._pose)
        self.publish_command(command)

    def _may_drive(self) -> bool:
        oldest = min(self._held_at, self._located_at)
        heard = self._now() - oldest <= self.parameters.timeout
        return heard and self._held and self._voltage >= self.parameters.low_battery

    def _now(self) -> float:
        return float(self.clock_of_timers.now().nanoseconds) / 1e9


def main(args: list[str] | None = None) -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(RouteDriver, args)


if __name__ == '__main__':
    main()
