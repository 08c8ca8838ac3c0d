"""The board of the Frobit on its wheels in physics, with the faults of its hardware."""

from __future__ import annotations

from sensor_msgs.msg import BatteryState
from std_msgs.msg import Bool, Float64, Int32
from wheeled_physics.experiment import begin, truth
from wheeled_physics.frobit_board import FrobitBoard
from wheeled_physics.frobit_in_physics_base import FrobitInPhysicsBase, run


class FrobitInPhysics(FrobitInPhysicsBase):
    """Drives the motors as it is told, and shows what the encoders count."""

    def __init__(self) -> None:
        """Stand, with a full battery."""
        super().__init__()
        self._board = FrobitBoard(self.parameters.seed)
        self._experiment = begin(self, self._board)

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
        stamp = self._experiment.advance()
        robot = self._board.robot
        self.publish_truth(truth(robot, stamp))
        if not robot.heard:
            return
        self.publish_left_encoder(Int32(data=self._board.ticks('left')))
        self.publish_right_encoder(Int32(data=self._board.ticks('right')))
        battery = BatteryState(voltage=robot.voltage, percentage=robot.charge)
        battery.header.stamp = stamp
        battery.present = True
        self.publish_battery(battery)


def main(args: list[str] | None = None) -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(FrobitInPhysics, args)


if __name__ == '__main__':
    main()
