"""The board of the Frobit on its wheels in physics, with the faults of its hardware."""

from __future__ import annotations

from rclpy.clock import Clock, ClockType
from sensor_msgs.msg import BatteryState
from std_msgs.msg import Bool, Float64, Int32
from wheeled_physics.experiment import Experiment, truth
from wheeled_physics.frobit_board import FrobitBoard
from wheeled_physics.frobit_in_physics_base import FrobitInPhysicsBase, run


class FrobitInPhysics(FrobitInPhysicsBase):
    """Drives the motors as it is told, and shows what the encoders count."""

    def __init__(self) -> None:
        """Stand, with a full battery."""
        super().__init__()
        self._steady = Clock(clock_type=ClockType.STEADY_TIME)
        given = self.parameters
        self._board = FrobitBoard(given.seed)
        self._experiment = Experiment(
            self._board, given.fault, given.fault_after, self._now(), self.get_logger().warning
        )

    def on_left_thrust(self, msg: Float64) -> None:
        """Drive the left motor."""
        self._board.command('left', msg.data)

    def on_right_thrust(self, msg: Float64) -> None:
        """Drive the right motor."""
        self._board.command('right', msg.data)

    def on_motors_off(self, msg: Bool) -> None:
        """Open or close the relay in the motors' supply; it has a line of its own."""
        self._board.robot.relay(msg.data)

    def on_cycle(self) -> None:
        """Let the time since the last cycle pass, and report."""
        self._experiment.advance(self._now())
        robot = self._board.robot
        stamp = self.get_clock().now().to_msg()
        self.publish_truth(truth(robot, stamp))
        if not robot.heard:
            return
        self.publish_left_encoder(Int32(data=self._board.ticks('left')))
        self.publish_right_encoder(Int32(data=self._board.ticks('right')))
        battery = BatteryState(voltage=robot.voltage, percentage=robot.charge)
        battery.header.stamp = stamp
        battery.present = True
        self.publish_battery(battery)

    def _now(self) -> float:
        return float(self._steady.now().nanoseconds) / 1e9


def main(args: list[str] | None = None) -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(FrobitInPhysics, args)


if __name__ == '__main__':
    main()
