"""Drives a monitor from a clock, and carries out what it orders at once."""

from __future__ import annotations

from collections.abc import Callable, Iterable
import traceback
from typing import Any, Protocol, TypeVar

from rclpy.node import Node

from .clock_choice import refuse_clock_change, USE_SIM_TIME
from .one_shot_timer import NodeClock, OneShotTimer, SimulatedClock
from .report_types import ActionCall, Event, Explanation, Monitor

NEAR = 2_000_000  # ns before a deadline in which nothing is started that can wait
AFTER = 1_000_000  # ns after a deadline in which what the monitor orders is done

CallT = TypeVar('CallT', bound=ActionCall)


class ActionError(Exception):
    """The code of an action has failed; the text names it."""


class MonitorHost(Protocol):
    """The node around a monitor, as the runner calls it."""

    def begin(self, start: int, emit: Callable[[Event], None]) -> Monitor:
        """Return a monitor that starts at a time and calls emit with each event."""

    def show(self, event: Event) -> bool:
        """
        Publish the state that an event changes, and return whether nothing is left to be done.

        Called in the middle of an evaluation.
        """

    def run(self, call: ActionCall) -> None:
        """Run the robot code of an action."""

    def after(self, events: list[Event], done: list[int], states: list[Explanation]) -> None:
        """
        Take the events that have been acted upon.

        For each of them, done has the time of that, and states what the monitor explained.
        """

    def flush_reports(self) -> None:
        """Publish all reports, because the failure of an action ends the node."""

    def stepped(self) -> None:
        """Publish at once: simulated time has begun or stepped back, and that is evaluated."""


class MonitorRunner:
    """
    Runs a monitor on steady time, which never steps, or on ROS time under use_sim_time.

    For each message, the owner takes the time from now(), calls catch_up() with it, hands both to
    the monitor, and calls settle() then.
    """

    def __init__(self, node: Node, steady: NodeClock, host: MonitorHost) -> None:
        """Choose the clock; start() comes next."""
        self.monitor: Any = None  # a Monitor, and a method for each of its inputs
        self._node = node
        self._steady = steady
        self._host = host
        self._show = host.show  # looked up once: it is called while others wait for it
        self._run = host.run
        self._events: list[Event] = []  # of this evaluation, in the monitor's order
        self._done: list[int] = []  # when each of these was done; 0 for not yet
        self._unpublished: list[int] = []  # the indices of those that could not be shown
        self._code: list[int] = []  # the indices of those whose code is still to be run
        self._states: list[Explanation] = []  # what the monitor explained after each of them
        refuse_clock_change(node)
        self.clock = self._choose_clock(steady)
        self.now = self.clock.now
        self._deadline = OneShotTimer(self.clock, self._on_deadline)

    def start(self) -> None:
        """Start the monitor: its timeouts count from now."""
        self.monitor = self._host.begin(self.now(), self._take)
        self._arm()

    def settle(self) -> None:
        """Do the rest of what the monitor ordered, and wake up for its next deadline."""
        if self._events:
            self._carry_out()
        self._arm()

    def advance(self) -> int:
        """Evaluate all that is due, and return the time that it is now."""
        now = self.now()
        try:
            self.catch_up(now)
            self.monitor.advance(now)
        finally:
            self.settle()
        return now

    def catch_up(self, now: int) -> None:
        """
        Evaluate what was due up to now, before anything else.

        Each instant is evaluated by itself: its events are explained by what was known then.
        """
        while (due := self.monitor.next_deadline) is not None and due <= now:
            self.monitor.advance(due)
            self._explain()

    def run_again(self, calls: Iterable[ActionCall]) -> None:
        """Run the code of actions that were active before the start, each of them."""
        self._fail_with([error for call in calls for error in self._attempt(self._run, call)])

    def defer(self) -> int:
        """Return for how many nanoseconds what can wait has to, because a deadline is near."""
        deadline = self.monitor.next_deadline
        if deadline is None or self.clock is not self._steady:
            return 0
        left: int = deadline - self.now()
        return left + AFTER if left < NEAR else 0

    def _choose_clock(self, steady: NodeClock) -> NodeClock:
        if not self._node.get_parameter(USE_SIM_TIME).value:
            return steady
        # The callback of a jump may not do much, so it leaves the rest to a timer due at once.
        step = OneShotTimer(steady, self._on_step)
        return SimulatedClock(self._node, lambda: step.schedule(0))

    def _on_step(self) -> None:
        self._on_deadline()
        self._host.stepped()

    def _on_deadline(self) -> None:
        self._deadline.is_scheduled = False
        self.advance()

    def _arm(self) -> None:
        """Schedule the timer for the monitor's next deadline, unless it fires earlier anyway."""
        deadline = self.monitor.next_deadline
        timer = self._deadline
        if deadline is not None and not (timer.is_scheduled and timer.due <= deadline):
            timer.schedule(deadline)

    def _take(self, event: Event) -> None:
        """Show an event at once; robot code waits until all of them are shown."""
        try:
            left = None if self._show(event) else self._code
        except Exception:
            left = self._unpublished  # tried again when the evaluation is over
        if left is None:
            self._done.append(self.now())
        else:
            left.append(len(self._events))
            self._done.append(0)
        self._events.append(event)

    def _explain(self) -> None:
        """Have the monitor explain the events of the last instant, if there are any."""
        count = len(self._events) - len(self._states)
        if count:
            self._states += [self.monitor.explain()] * count

    def _carry_out(self) -> None:
        """Do all that is left of what was ordered, and only then fail if something failed."""
        try:
            self._explain()
        finally:  # even if it cannot, all is done
            self._do_all()

    def _do_all(self) -> None:
        events, done, states = self._events, self._done, self._states
        shown_late, code = self._unpublished, self._code
        # Code may spin the node, and so come back here: it must find nothing to be done.
        self._events, self._done, self._unpublished, self._code = [], [], [], []
        self._states = []
        failures: list[BaseException] = []
        try:
            for i in shown_late:
                failures += self._attempt(self._show, events[i])
                done[i] = self.now()
            for i in code:
                failures += self._attempt(self._run, events[i])
                done[i] = self.now()
        finally:
            self._host.after(events, done, states)
        self._fail_with(failures)

    def _fail_with(self, failures: list[BaseException]) -> None:
        """End the node, and its heartbeat with it, if anything was raised; sys.exit() counts."""
        if failures:
            self._host.flush_reports()
            raise ActionError('an action failed, so the node ends') from failures[0]

    def _attempt(self, act: Callable[[CallT], object], call: CallT) -> list[BaseException]:
        """Do something; log and return what it raised, even what is meant to end the process."""
        try:
            act(call)
        except BaseException as error:
            self._node.get_logger().fatal(
                f'action {call.action} failed:\n{traceback.format_exc()}'
            )
            return [error]
        return []
