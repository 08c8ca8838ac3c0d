"""The node odometry_node: yours to fill in. deros wrote this file once and leaves it alone."""

from differential_odometry.odometry_node_base import OdometryNodeBase, run
from sensor_msgs.msg import Imu, LaserScan
from std_msgs.msg import Int32
from std_srvs.srv import Trigger


class OdometryNode(OdometryNodeBase):
    """Turns encoder ticks into odometry."""

    def on_ticks(self, msg: Int32) -> None:
        """Handle a message on ticks."""
        self.get_logger().warning('on_ticks does nothing yet', once=True)

    def on_imu(self, msg: Imu) -> None:
        """
        Handle a message on imu.

        The parameter imu_topic gives the topic's name at start.
        """
        self.get_logger().warning('on_imu does nothing yet', once=True)

    def on_scan(self, msg: LaserScan) -> None:
        """Handle a message on scan."""
        self.get_logger().warning('on_scan does nothing yet', once=True)

    def on_control(self) -> None:
        """
        Run every 20 ms.

        Integrates the ticks.
        """
        self.get_logger().warning('on_control does nothing yet', once=True)

    def handle_reset(
        self,
        request: Trigger.Request,
        response: Trigger.Response,
    ) -> Trigger.Response:
        """Answer a request to reset: fill in the response and return it."""
        self.get_logger().warning('handle_reset does nothing yet', once=True)
        return response


def main(args: list[str] | None = None) -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(OdometryNode, args)


if __name__ == '__main__':
    main()
