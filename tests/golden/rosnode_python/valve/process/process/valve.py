"""The node valve: yours to fill in. deros wrote this file once and leaves it alone."""

from process.valve_base import run, ValveBase
from std_msgs.msg import Bool


class Valve(ValveBase):
    """Opens and closes a valve."""

    def on_command(self, msg: Bool) -> None:
        """Handle a message on command."""
        self.get_logger().warning('on_command does nothing yet', once=True)

    def on_report(self) -> None:
        """Run every 50 ms."""
        self.get_logger().warning('on_report does nothing yet', once=True)


def main(args: list[str] | None = None) -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(Valve, args)


if __name__ == '__main__':
    main()
