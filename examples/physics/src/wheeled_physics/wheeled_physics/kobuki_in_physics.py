"""The base of the Kobuki with its driver in physics, with the faults of its hardware."""

from __future__ import annotations

from geometry_msgs.msg import Twist
from kobuki_base.messages import battery_message, imu_message, odometry_message
from kobuki_base.odometry import DeadReckoning
from std_msgs.msg import Bool, UInt8
from wheeled_physics.experiment import begin, truth
from wheeled_physics.kobuki_board import KobukiBoard
from wheeled_physics.kobuki_in_physics_base import KobukiInPhysicsBase, run


class KobukiInPhysics(KobukiInPhysicsBase):
    """Drives as commanded, and reports what its sensors show."""

    def __init__(self) -> None:
        """Stand in the middle of the room, with a full battery."""
        super().__init__()
        self._board = KobukiBoard(self.parameters.seed)
        self._reckoning = DeadReckoning()
        self._experiment = begin(self, self._board)

    def on_command(self, msg: Twist) -> None:
        """Drive as the gate says."""
        self._board.command(msg.linear.x, msg.angular.z)

    def on_motors_off(self, msg: Bool) -> None:
        """Take the power of the motors, or give it back; the relay has a line of its own."""
        self._board.robot.relay(msg.data)

    def on_cycle(self) -> None:
        """Let the time since the last cycle pass, and report."""
        stamp = self._experiment.advance()
        robot = self._board.robot
        self.publish_truth(truth(robot, stamp))
        if not robot.heard:
            return
        if self._reckoning.count(*self._board.counters(), self._board.stamp()):
            self.publish_odometry(odometry_message(self._reckoning, stamp))
        self.publish_imu(imu_message(robot.gyro(), stamp))
        self.publish_bumper(UInt8(data=self._board.bumper()))
        self.publish_battery(battery_message(robot.voltage, robot.charge, stamp))


def main(args: list[str] | None = None) -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(KobukiInPhysics, args)


if __name__ == '__main__':
    main()
