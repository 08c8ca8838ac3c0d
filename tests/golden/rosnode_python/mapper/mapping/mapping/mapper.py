"""The node mapper: yours to fill in. deros wrote this file once and leaves it alone."""

from mapping.mapper_base import MapperBase, run
from rclpy.action.server import ServerGoalHandle
from std_msgs.msg import String
from std_srvs.srv import Trigger
from test_msgs.action import Fibonacci


class Mapper(MapperBase):
    """Publishes and subscribes one name."""

    def on_map(self, msg: String) -> None:
        """Handle a message on map."""
        self.get_logger().warning('on_map does nothing yet', once=True)

    def on_each(self, msg: String) -> None:
        """
        Handle a message on each.

        The parameter sources lists the topics at start.
        """
        self.get_logger().warning('on_each does nothing yet', once=True)

    def on_target(self, entry: str, msg: String) -> None:
        """
        Handle a message on target.

        The parameters gains.<joints>.target name the topics at start; an entry with an empty name
        has none.
        """
        self.get_logger().warning('on_target does nothing yet', once=True)

    def handle_map(
        self,
        request: Trigger.Request,
        response: Trigger.Response,
    ) -> Trigger.Response:
        """Answer a request to map: fill in the response and return it."""
        self.get_logger().warning('handle_map does nothing yet', once=True)
        return response

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
    run(Mapper, args)


if __name__ == '__main__':
    main()
