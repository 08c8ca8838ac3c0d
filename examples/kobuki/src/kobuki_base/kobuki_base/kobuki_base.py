"""The base of the Kobuki with its driver, simulated, with motors that may stick."""

from __future__ import annotations

from geometry_msgs.msg import Twist
from kobuki_base.base import Base, COUNTER
from kobuki_base.kobuki_base_base import KobukiBaseBase, run
from kobuki_base.messages import battery_message, imu_message, odometry_message
from kobuki_base.odometry import DeadReckoning
from rclpy.clock import Clock, ClockType
from std_msgs.msg import Bool, UInt8

LONGEST_CYCLE = 0.1
"""Most seconds that one cycle makes up for: a base that was held up does not leap."""


class KobukiBase(KobukiBaseBase):
    """Drives as commanded, and reports what its sensors show."""

    def __init__(self) -> None:
        """Stand in the middle of the room, with a full battery."""
        super().__init__()
        self._steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._base = Base()
        self._reckoning = DeadReckoning()
        self._last_cycle = self._now()
        self._milliseconds = 0.0
        self._moving_since: float | None = None

    def on_command(self, msg: Twist) -> None:
        """Drive as the gate says."""
        self._base.command(msg.linear.x, msg.angular.z, self._now())

    def on_motors_off(self, msg: Bool) -> None:
        """Take the power of the motors, or give it back."""
        if msg.data and not self._base.motors_off:
            self.get_logger().warning('the motors have lost their power')
        self._base.motors_off = msg.data

    def on_cycle(self) -> None:
        """Let the time since the last cycle pass, and report."""
        now = self._now()
        duration = min(now - self._last_cycle, LONGEST_CYCLE)
        self._base.advance(now, duration)
        self._last_cycle = now
        self._milliseconds += duration * 1000.0
        self._fail_in_time(now)
        stamp = self.get_clock().now().to_msg()
        if self._reckoning.count(*self._base.counters(), int(self._milliseconds) % COUNTER):
            self.publish_odometry(odometry_message(self._reckoning, stamp))
        self.publish_imu(imu_message(self._base.gyro(), stamp))
        self.publish_bumper(UInt8(data=self._base.bumper()))
        self.publish_battery(battery_message(self._base.voltage, self._base.charge, stamp))

    def _fail_in_time(self, now: float) -> None:
        if self._moving_since is None and self._base.moves():
            self._moving_since = now
            self.get_logger().info('it moves')
        since, fault = self._moving_since, self.parameters.fault
        if fault == 'none' or self._base.fault or since is None:
            return
        if now - since >= self.parameters.fault_after:
            self._base.fault = fault
            self.get_logger().warning(f'fault: {fault}')

    def _now(self) -> float:
        return float(self._steady.now().nanoseconds) / 1e9


def main(args: list[str] | None = None) -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(KobukiBase, args)


if __name__ == '__main__':
    main()
