"""The node dock: yours to fill in. deros wrote this file once and leaves it alone."""

from docking.dock_base import DockBase, run
from example_interfaces.action import Fibonacci
from rclpy.action.server import ServerGoalHandle
from rosgraph_msgs.msg import Clock as RosgraphMsgsClock


class Dock(DockBase):
    """The node dock."""

    def on_clock(self, msg: RosgraphMsgsClock) -> None:
        """Handle a message on clock."""
        self.get_logger().warning('on_clock does nothing yet', once=True)

    def execute_dock(self, goal_handle: ServerGoalHandle) -> Fibonacci.Result:
        """
        Execute a goal of dock: succeed, abort or cancel it, and return the result.

        It runs in a thread of its own. Return soon when goal_handle.is_active is false, because
        the node ends, or goal_handle.is_cancel_requested is true.
        """
        self.get_logger().warning('execute_dock does nothing yet', once=True)
        goal_handle.abort()
        return Fibonacci.Result()


def main(args: list[str] | None = None) -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(Dock, args)


if __name__ == '__main__':
    main()
