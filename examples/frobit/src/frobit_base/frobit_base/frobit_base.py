"""The board of the Frobit, simulated, with the faults of its lines."""

from __future__ import annotations

from frobit_base.board import Board
from frobit_base.frobit_base_base import FrobitBaseBase, run
from rclpy.clock import Clock, ClockType
from sensor_msgs.msg import BatteryState
from std_msgs.msg import Bool, Float64, Int32

LONGEST_CYCLE = 0.1
"""Most seconds that one cycle makes up for: a board that was held up does not leap."""


class FrobitBase(FrobitBaseBase):
    """Drives the motors as it is told, and shows what the encoders count."""

    def __init__(self) -> None:
        """Stand, with a full battery."""
        super().__init__()
        self._steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._board = Board(self.parameters.ticks_per_turn)
        self._last_cycle = self._now()
        self._turning_since: float | None = None
        self._failed = self.parameters.fault == 'none'

    def on_left_thrust(self, msg: Float64) -> None:
        """Drive the left motor."""
        self._board.left.command(msg.data, self._now())

    def on_right_thrust(self, msg: Float64) -> None:
        """Drive the right motor."""
        self._board.right.command(msg.data, self._now())

    def on_motors_off(self, msg: Bool) -> None:
        """Open or close the relay in the motors' supply."""
        if msg.data and not self._board.motors_off:
            self.get_logger().warning('the motors have lost their supply')
        self._board.motors_off = msg.data

    def on_cycle(self) -> None:
        """Let the time since the last cycle pass, and report."""
        now = self._now()
        self._board.advance(now, min(now - self._last_cycle, LONGEST_CYCLE))
        self._last_cycle = now
        self._fail_in_time(now)
        self.publish_left_encoder(Int32(data=self._board.left.ticks()))
        self.publish_right_encoder(Int32(data=self._board.right.ticks()))
        battery = BatteryState(voltage=self._board.voltage, percentage=self._board.charge)
        battery.header.stamp = self.get_clock().now().to_msg()
        battery.present = True
        self.publish_battery(battery)

    def _fail_in_time(self, now: float) -> None:
        if self._turning_since is None and self._board.turns():
            self._turning_since = now
            self.get_logger().info('the wheels turn')
        since = self._turning_since
        if self._failed or since is None or now - since < self.parameters.fault_after:
            return
        self._failed = True
        self._board.fail(self.parameters.fault, now)
        self.get_logger().warning(f'fault: {self.parameters.fault}')

    def _now(self) -> float:
        return float(self._steady.now().nanoseconds) / 1e9


def main(args: list[str] | None = None) -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(FrobitBase, args)


if __name__ == '__main__':
    main()
