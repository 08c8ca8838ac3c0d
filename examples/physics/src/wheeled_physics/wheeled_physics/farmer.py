"""Who starts the feeding robot in a rehearsal: the panel's switches, and the order to feed."""

from __future__ import annotations

from rclpy.task import Future
from std_msgs.msg import Bool, UInt64, UInt8
from std_srvs.srv import Trigger
from wheeled_physics.farmer_base import FarmerBase, run

MANUAL, AUTOMATIC = 0, 2
"""Positions of the mode switch."""

WATCHED = 3
"""For how many looks, of half a second, the farmer stays once the robot is to drive."""

PATIENCE = 4
"""After how many looks without an answer the gate is asked again."""


class Farmer(FarmerBase):
    """
    Starts the engine, resets the gate, and lets the robot drive once: after a stop it stays.

    If the PLC shuts the engine off at once, as it has not found all others yet, it is begun anew.
    """

    def __init__(self) -> None:
        """Take the robot over, and turn the key."""
        super().__init__()
        self._safety_lives = self._engine_runs = self._is_taken_over = False
        self._take_over()

    def on_safety_heartbeat(self, _msg: UInt64) -> None:
        """See that the safety node has all that it watches."""
        self._safety_lives = True

    def on_engine_running(self, msg: Bool) -> None:
        """Hear the engine."""
        self._engine_runs = msg.data

    def on_controller_ok(self, msg: Bool) -> None:
        """See whether the safety node lets the robot be driven."""
        self._is_taken_over = msg.data

    def on_look(self) -> None:
        """Do what is next."""
        if self._is_ordered:
            self._looks += 1
            if self._looks <= WATCHED and not self._engine_runs:
                self._take_over()
        elif self._may_start() and self._is_reset():
            self._order()

    def _may_start(self) -> bool:
        return self._safety_lives and self._engine_runs and self._is_taken_over

    def _take_over(self) -> None:
        self._is_ordered = False
        self._looks = 0
        self._answer: Future | None = None
        self.publish_order(Bool(data=False))
        self.publish_mode(UInt8(data=MANUAL))
        self.publish_ignition(Bool(data=True))

    def _is_reset(self) -> bool:
        """Return whether the gate has been reset; ask it to be, if need be again."""
        self._looks += 1
        if self._answer is not None and self._answer.done():
            if self._answer.result().success:
                return True
        elif self._answer is not None and self._looks <= PATIENCE:
            return False
        if self.client_reset_gate.service_is_ready():
            self._looks = 0
            self._answer = self.call_reset_gate(Trigger.Request())
        return False

    def _order(self) -> None:
        self._is_ordered = True
        self._looks = 0
        self.publish_ignition(Bool(data=False))
        self.publish_mode(UInt8(data=AUTOMATIC))
        self.publish_order(Bool(data=True))


def main(args: list[str] | None = None) -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(Farmer, args)


if __name__ == '__main__':
    main()
