"""The logic of a gate in time: it is told what time it is, also when nothing comes."""

from __future__ import annotations

from collections.abc import Callable
import time
from typing import Protocol

from rclpy.clock import Clock, JumpThreshold, TimeJump
from rclpy.clock_type import ClockType
from rclpy.duration import Duration
from rclpy.node import Node

from .clock_choice import refuse_clock_change, USE_SIM_TIME
from .one_shot_timer import OneShotTimer

NEVER = 1 << 62  # or later, in nanoseconds; timers cannot wait for that


class GateLogic(Protocol):
    """What the logic of a gate does by itself."""

    @property
    def next_deadline(self) -> int:
        """Return when to call advance() at the latest."""

    def advance(self, t: int) -> None:
        """Do what is due up to and including t."""


class GateRunner:
    """
    Runs a gate on steady time, which never steps, whatever the robot's time is.

    The owner hands to the gate what comes, with the time of now(), and calls settle() then.
    """

    def __init__(self, node: Node, in_simulated_time: bool) -> None:
        """Prepare; start() comes next. For tests, the gate can run on /clock, if the node does."""
        self._node = node
        refuse_clock_change(node)
        self.now, clock = self._choose_clock(in_simulated_time)
        self._deadline = OneShotTimer(node, clock, self.now, self.advance)

    def start(self, gate: GateLogic, settled: Callable[[], None]) -> None:
        """Start with a gate; settled is called whenever something has happened to it."""
        self._gate = gate
        self._settled = settled
        self.advance()

    def advance(self) -> None:
        """Do what is due."""
        self._gate.advance(self.now())
        self.settle()

    def settle(self) -> None:
        """Wake up for the next deadline; an timer that rings earlier may stay."""
        due = self._gate.next_deadline
        if due < NEVER and not (self._deadline.is_scheduled and self._deadline.due <= due):
            self._deadline.schedule(due)
        self._settled()

    def _choose_clock(self, in_simulated_time: bool) -> tuple[Callable[[], int], Clock]:
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        if not (in_simulated_time and self._node.get_parameter(USE_SIM_TIME).value):
            return time.monotonic_ns, steady  # what that clock shows, in a thirtieth of the time
        # The callback of a jump may not do much, so it leaves the rest to an timer due at once.
        self._step = OneShotTimer(self._node, steady, time.monotonic_ns, self.advance)
        jumps = JumpThreshold(min_forward=None, min_backward=Duration(nanoseconds=-1))
        clock = self._node.get_clock()
        self._jumps = clock.create_jump_callback(jumps, post_callback=self._on_clock_jump)
        return lambda: clock.now().nanoseconds, clock

    def _on_clock_jump(self, _jump: TimeJump) -> None:
        self._step.schedule(0)
