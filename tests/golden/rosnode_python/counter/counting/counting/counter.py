"""The node counter: yours to fill in. deros wrote this file once and leaves it alone."""

from counting.counter_base import CounterBase, run
from rclpy.action.server import ServerGoalHandle
from std_msgs.msg import Empty
from test_msgs.action import Fibonacci


class Counter(CounterBase):
    """Counts as far as it is asked to."""

    def on_release(self, msg: Empty) -> None:
        """Handle a message on release."""
        self.get_logger().warning('on_release does nothing yet', once=True)

    def execute_count(self, goal_handle: ServerGoalHandle) -> Fibonacci.Result:
        """
        Execute a goal of count: succeed, abort or cancel it, and return the result.

        It runs in a thread of its own. Return soon when goal_handle.is_active is false, because
        the node ends, or goal_handle.is_cancel_requested is true.
        """
        self.get_logger().warning('execute_count does nothing yet', once=True)
        goal_handle.abort()
        return Fibonacci.Result()


def main(args: list[str] | None = None) -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(Counter, args)


if __name__ == '__main__':
    main()
