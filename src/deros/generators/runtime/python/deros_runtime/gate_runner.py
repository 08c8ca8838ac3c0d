"""Drives a gate from a clock, also when no message arrives."""

from __future__ import annotations

from collections.abc import Callable

from rclpy.node import Node

from .clock_choice import refuse_clock_change, USE_SIM_TIME
from .gate_logic import Gate
from .one_shot_timer import NodeClock, OneShotTimer, SimulatedClock, steady_clock

NEVER = 1 << 62  # or later, in nanoseconds; no timer can wait for so long


class GateRunner:
    """
    Runs a gate on steady time, which never steps, whatever the robot's time is.

    The owner passes each message to the gate, with the time of now(), and calls settle() then.
    """

    def __init__(
        self, node: Node, in_simulated_time: bool, steady: NodeClock | None = None
    ) -> None:
        """Set up; start() comes next. For tests, the gate can run on /clock, if the node does."""
        self._node = node
        refuse_clock_change(node)
        self.clock = self._choose_clock(in_simulated_time, steady or steady_clock(node))
        self.now = self.clock.now
        self._deadline = OneShotTimer(self.clock, self.advance)

    def start(self, gate: Gate, settled: Callable[[], None]) -> None:
        """Start a gate; settled is called after each call of it."""
        self._gate = gate
        self._settled = settled
        self.advance()

    def advance(self) -> None:
        """Do what is due."""
        self._gate.advance(self.now())
        self.settle()

    def settle(self) -> None:
        """Wake up for the next deadline, if the timer does not fire earlier anyway."""
        due = self._gate.next_deadline
        if due < NEVER and not (self._deadline.is_scheduled and self._deadline.due <= due):
            self._deadline.schedule(due)
        self._settled()

    def _choose_clock(self, in_simulated_time: bool, steady: NodeClock) -> NodeClock:
        if not (in_simulated_time and self._node.get_parameter(USE_SIM_TIME).value):
            return steady
        # The callback of a jump may not do much, so it leaves the rest to a timer due at once.
        step = OneShotTimer(steady, self.advance)
        return SimulatedClock(self._node, lambda: step.schedule(0))
