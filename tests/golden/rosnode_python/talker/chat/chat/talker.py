"""The node talker: yours to fill in. deros wrote this file once and leaves it alone."""

from chat.talker_base import TalkerBase
import rclpy
from rclpy.executors import ExternalShutdownException


class Talker(TalkerBase):
    """Says hello."""


def main(args: list[str] | None = None) -> None:
    """Run the node until SIGINT or SIGTERM."""
    try:
        rclpy.init(args=args)
        node = Talker()
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
