"""The clocks of a node, and one-shot timers, which share a single timer of rclpy per clock."""

from __future__ import annotations

from collections.abc import Callable
import time

from rclpy.clock import Clock, JumpThreshold, TimeJump
from rclpy.clock_type import ClockType
from rclpy.duration import Duration
from rclpy.node import Node

MAX_DEFERRAL = 50_000_000  # ns that a timer may be deferred in all
TOLERANCE = 100_000  # ns by which a timer of rclpy may be off from what it was set to
BEGINNING = 1 << 61  # ns: when simulated time begins, with room for 73 years back and forth


class OneShotTimer:
    """
    Calls back once, at an instant of a clock.

    Of several timers that are due, the earliest fires first, and messages are handled before the
    next one fires.
    """

    def __init__(
        self,
        clock: NodeClock,
        callback: Callable[[], None],
        defer: Callable[[], int] | None = None,
    ) -> None:
        """
        Create the timer; it is not scheduled.

        defer, which timers that are not urgent have, returns for how many nanoseconds the callback
        has to wait for something else.
        """
        self.due = 0  # for which it is scheduled, or was last
        self.wait_until = 0  # the same, or later if it has been deferred
        self.is_scheduled = False
        self._clock = clock
        self._callback = callback
        self._defer = defer
        clock.timers.append(self)

    def schedule(self, due: int) -> None:
        """Fire at an instant, or at once if it is past; this replaces an earlier schedule."""
        self.due = self.wait_until = due
        self.is_scheduled = True
        self._clock.adjust()

    def repeat(self, period: int) -> None:
        """Fire again a period after the last time, or after now if either was long ago."""
        latest = self._clock.now() + period
        due = self.due + period
        self.schedule(due if latest - period < due <= latest else latest)

    def fire(self) -> None:
        """Call back, or defer that."""
        now = self._clock.now()
        if self._defer is not None and now - self.due < MAX_DEFERRAL:
            pause = self._defer()
            if pause > 0:
                self.wait_until = now + pause
                return
        self.is_scheduled = False
        self._callback()


class NodeClock:
    """
    A clock of a node, with one timer, which expires when the first of its one-shot timers is due.

    While a timer has expired and not been called yet, the EventsExecutor calls it once more each
    time that any timer is set, and after each of these calls it looks for expired timers again:
    with several of them, set in such calls, the calls of a busy node multiply until no message
    gets its turn. One timer, set only when it has to be, cannot do that; and a call that comes too
    early has no effect.
    """

    def __init__(self, node: Node, clock: Clock, now: Callable[[], int]) -> None:
        """Create the timer; nothing is due. now returns the time of the clock in nanoseconds."""
        self.now = now
        self.origin = 0  # ns that reports add to times of the clock
        self.timers: list[OneShotTimer] = []
        self._due: int | None = None  # when the timer expires
        self._is_firing = False
        self._timer = node.create_timer(1.0, self._expire, clock=clock, autostart=False)

    @property
    def has_begun(self) -> bool:
        """Whether time runs; before that, nothing can become due."""
        return self.origin > -BEGINNING

    def adjust(self) -> None:
        """Make the timer expire when the first one-shot timer is due, if not earlier."""
        if self._is_firing:
            return  # the callback may schedule several
        first = self._first()
        if first is not None and (self._due is None or first.wait_until < self._due):
            self._due = first.wait_until
            self._wait(self._due - self.now())

    def _first(self) -> OneShotTimer | None:
        scheduled = (timer for timer in self.timers if timer.is_scheduled)
        return min(scheduled, key=lambda timer: timer.wait_until, default=None)

    def _expire(self) -> None:
        if self._due is None:
            self._timer.cancel()
            return
        now = self.now()
        if now < self._due:
            left = self._timer.time_until_next_call()
            if left is None or abs(self._due - now - left) > TOLERANCE:  # the clock has stepped
                self._wait(self._due - now)
            return
        self._timer.cancel()
        self._due = None
        self._is_firing = True
        try:
            first = self._first()
            if first is not None and first.wait_until <= now:
                first.fire()
        finally:
            self._is_firing = False
            self.adjust()

    def _wait(self, time: int) -> None:
        """Expire once in so many nanoseconds; a call before that postpones it by one only."""
        self._timer.timer_period_ns = max(time, 1)
        self._timer.reset()
        self._timer.timer_period_ns = 1


def steady_clock(node: Node) -> NodeClock:
    """Return the steady clock, which never steps."""
    clock = Clock(clock_type=ClockType.STEADY_TIME)
    return NodeClock(node, clock, time.monotonic_ns)  # the same time, read in a thirtieth of it


class SimulatedClock(NodeClock):
    """
    ROS time of a node under use_sim_time, counted from BEGINNING.

    Until the first /clock comes it stands still. ROS time leaps then, this one does not: whatever
    has been received before is as new as it was.
    """

    def __init__(self, node: Node, changed: Callable[[], None]) -> None:
        """Create the clock; changed, which may not do much, is told of its begin and its steps."""
        clock = node.get_clock()
        super().__init__(node, clock, lambda: clock.now().nanoseconds - self.origin)
        self.origin = -BEGINNING
        self._changed = changed
        self._begin()
        jumps = JumpThreshold(
            min_forward=Duration(nanoseconds=1), min_backward=Duration(nanoseconds=-1)
        )
        self._jumps = clock.create_jump_callback(jumps, post_callback=self._on_jump)

    def _on_jump(self, jump: TimeJump) -> None:
        if jump.delta.nanoseconds < 0 or (not self.has_begun and self._begin()):
            self._changed()

    def _begin(self) -> bool:
        """Begin if ROS time has begun, and return whether it has."""
        ros_time = self.now() - BEGINNING
        if ros_time > 0:
            self.origin = ros_time - BEGINNING
        return self.has_begun
