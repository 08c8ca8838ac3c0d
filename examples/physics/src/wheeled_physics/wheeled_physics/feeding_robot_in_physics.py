"""The feeding robot with its sensors' drivers in physics, with the faults of its hardware."""

from __future__ import annotations

from std_msgs.msg import Bool, Float64
from wheeled_physics.experiment import begin, truth
from wheeled_physics.feeding_robot_board import FeedingRobotBoard
from wheeled_physics.feeding_robot_in_physics_base import FeedingRobotInPhysicsBase, run
from wheeled_physics.measures import FEEDING_ROBOT
from wheeled_physics.messages import imu_message, odometry_message, scan_message

SLOW_CYCLES = 5
"""Engine and scanner report in every fifth cycle."""


class FeedingRobotInPhysics(FeedingRobotInPhysicsBase):
    """Drives by pedal and steering, and reports what its sensors show."""

    def __init__(self) -> None:
        """Stand in the alley, with the engine off."""
        super().__init__()
        self._board = FeedingRobotBoard(self.parameters.seed)
        self._bumpers = False, False
        self._cycles = 0
        self._experiment = begin(self, self._board)

    def on_pedal(self, msg: Float64) -> None:
        """Move the pedal."""
        self._board.pedal(msg.data)

    def on_steering(self, msg: Float64) -> None:
        """Turn the wheels."""
        self._board.steer(msg.data)

    def on_engine_enable(self, msg: Bool) -> None:
        """Open or shut the fuel valve; it has a line of its own."""
        self._board.engine(msg.data)
        self._publish_engine_speed()

    def on_cycle(self) -> None:
        """Let the time since the last cycle pass, and report."""
        stamp = self._experiment.advance()
        board = self._board
        self.publish_truth(truth(board.robot, stamp))
        self._publish_contacts()
        if board.robot.heard:
            if board.reckon():
                self.publish_odometry(odometry_message(board, stamp))
            self.publish_imu(imu_message(board.robot, stamp))
        self._cycles += 1
        if self._cycles % SLOW_CYCLES == 0:
            self._publish_engine_speed()
            ranges = board.robot.scan()
            if ranges is not None and FEEDING_ROBOT.lidar is not None:
                self.publish_scan(scan_message(FEEDING_ROBOT.lidar, ranges, stamp))

    def _publish_contacts(self) -> None:
        """Report each bumper whose contact opens or closes; they have lines of their own."""
        bumpers = self._board.bumpers()
        if bumpers != self._bumpers:
            self._bumpers = bumpers
            self.publish_contact_front_bumper(Bool(data=bumpers[0]))
            self.publish_contact_rear_bumper(Bool(data=bumpers[1]))

    def _publish_engine_speed(self) -> None:
        self.publish_engine_speed(Float64(data=self._board.engine_speed))


def main(args: list[str] | None = None) -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(FeedingRobotInPhysics, args)


if __name__ == '__main__':
    main()
