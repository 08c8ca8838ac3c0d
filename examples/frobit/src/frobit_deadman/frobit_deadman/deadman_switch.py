"""The deadman's switch, simulated: released and held by turns."""

from __future__ import annotations

from frobit_deadman.deadman_switch_base import DeadmanSwitchBase, run
from std_msgs.msg import Bool


class DeadmanSwitch(DeadmanSwitchBase):
    """Begins released, so that the gate sees zero before anything moves."""

    def __init__(self) -> None:
        """Take the time."""
        super().__init__()
        self._started = self._now()

    def on_scan(self) -> None:
        """Report whether the switch is held."""
        released = self.parameters.released
        since = (self._now() - self._started) % (released + self.parameters.held)
        self.publish_deadman(Bool(data=since >= released))

    def _now(self) -> float:
        return float(self.clock_of_timers.now().nanoseconds) / 1e9


def main(args: list[str] | None = None) -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(DeadmanSwitch, args)


if __name__ == '__main__':
    main()
