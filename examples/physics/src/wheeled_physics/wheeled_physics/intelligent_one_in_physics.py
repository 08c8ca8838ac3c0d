"""The marking robot with its driver in physics, with the faults of its hardware, and a bank."""

from __future__ import annotations

from geometry_msgs.msg import Twist
from wheeled_physics.experiment import begin, truth
from wheeled_physics.intelligent_one_board import IntelligentOneBoard
from wheeled_physics.intelligent_one_in_physics_base import IntelligentOneInPhysicsBase, run
from wheeled_physics.messages import imu_message, odometry_message


class IntelligentOneInPhysics(IntelligentOneInPhysicsBase):
    """Wishes to drive along its lines, drives as commanded, and reports what its sensors show."""

    def __init__(self) -> None:
        """Stand at the first corner of the field."""
        super().__init__()
        self._board = IntelligentOneBoard(self.parameters.seed)
        self._experiment = begin(self, self._board)

    def on_command(self, msg: Twist) -> None:
        """Drive as the gate says."""
        self._board.command(msg.linear.x, msg.angular.z)

    def on_cycle(self) -> None:
        """Let the time since the last cycle pass, report, and go on along the lines."""
        stamp = self._experiment.advance()
        board = self._board
        self.publish_truth(truth(board.robot, stamp))
        if board.robot.heard:
            if board.reckon():
                self.publish_odometry(odometry_message(board, stamp))
            self.publish_imu(imu_message(board.robot, stamp))
        wish = Twist()
        wish.linear.x, wish.angular.z = board.wish()
        self.publish_wish(wish)


def main(args: list[str] | None = None) -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(IntelligentOneInPhysics, args)


if __name__ == '__main__':
    main()
