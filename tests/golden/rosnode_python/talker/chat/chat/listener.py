"""The node listener: yours to fill in. deros wrote this file once and leaves it alone."""

from chat.listener_base import ListenerBase, run
from std_msgs.msg import String


class Listener(ListenerBase):
    """The node listener."""

    def on_chatter(self, msg: String) -> None:
        """Handle a message on chatter."""
        self.get_logger().warning('on_chatter does nothing yet', once=True)


def main(args: list[str] | None = None) -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(Listener, args)


if __name__ == '__main__':
    main()
