"""Alarms that ring at an instant, once; all those of one clock share one timer."""

from __future__ import annotations

from collections.abc import Callable

from rclpy.clock import Clock
from rclpy.node import Node

PATIENCE = 50_000_000  # ns that an alarm may be put off in all
NEARLY = 100_000  # ns by which a timer may be off from what it was set to


class Alarm:
    """
    Something that is to be done at an instant of a clock, once.

    The earliest is done first, and messages have their turn before the next.
    """

    def __init__(
        self,
        node: Node,
        clock: Clock,
        now: Callable[[], int],
        callback: Callable[[], None],
        put_off: Callable[[], int] | None = None,
    ) -> None:
        """
        Prepare; now returns the time of the clock in nanoseconds.

        put_off tells of an alarm that is not urgent for how long something else goes before it.
        """
        self.due = 0  # for which it is set, or was last
        self.wait_until = 0  # the same, or later if it has been put off
        self.is_set = False
        self._now = now
        self._callback = callback
        self._put_off = put_off
        self._hand = _hand(node, clock, now)
        self._hand.alarms.append(self)

    def ring_at(self, due: int) -> None:
        """Ring at an instant, or at once if it is past; what was set before is forgotten."""
        self.due = self.wait_until = due
        self.is_set = True
        self._hand.adjust()

    def repeat(self, period: int) -> None:
        """Ring again a period after the last time, or after now if either was long ago."""
        latest = self._now() + period
        due = self.due + period
        self.ring_at(due if latest - period < due <= latest else latest)

    def ring(self) -> None:
        """Do what is to be done, or put it off."""
        now = self._now()
        if self._put_off is not None and now - self.due < PATIENCE:
            pause = self._put_off()
            if pause > 0:
                self.wait_until = now + pause
                return
        self.is_set = False
        self._callback()


class _Hand:
    """
    The one timer of a clock, which expires when the first of its alarms is due.

    While a timer has expired and not been called yet, the EventsExecutor calls it once more each
    time that any timer is set, and after each of these calls it looks for expired timers again:
    with several of them, set in such calls, the calls of a busy node multiply until no message
    gets its turn. One timer, set only when it has to be, cannot do that; and what is called too
    early stays as it is.
    """

    def __init__(self, node: Node, clock: Clock, now: Callable[[], int]) -> None:
        """Prepare; nothing is due."""
        self.alarms: list[Alarm] = []
        self._now = now
        self._due: int | None = None  # when the timer expires
        self._is_ringing = False
        self._timer = node.create_timer(1.0, self._expire, clock=clock, autostart=False)

    def adjust(self) -> None:
        """See to it that the timer expires when the first alarm is due, if not earlier."""
        if self._is_ringing:
            return  # what rings may set several
        first = self._first()
        if first is not None and (self._due is None or first.wait_until < self._due):
            self._due = first.wait_until
            self._wait(self._due - self._now())

    def _first(self) -> Alarm | None:
        waiting = (alarm for alarm in self.alarms if alarm.is_set)
        return min(waiting, key=lambda alarm: alarm.wait_until, default=None)

    def _expire(self) -> None:
        if self._due is None:
            self._timer.cancel()
            return
        now = self._now()
        if now < self._due:
            left = self._timer.time_until_next_call()
            if left is None or abs(self._due - now - left) > NEARLY:  # the clock has stepped
                self._wait(self._due - now)
            return
        self._timer.cancel()
        self._due = None
        self._is_ringing = True
        try:
            first = self._first()
            if first is not None and first.wait_until <= now:
                first.ring()
        finally:
            self._is_ringing = False
            self.adjust()

    def _wait(self, time: int) -> None:
        """Expire once in so many nanoseconds; a call before that postpones it by one only."""
        self._timer.timer_period_ns = max(time, 1)
        self._timer.reset()
        self._timer.timer_period_ns = 1


def _hand(node: Node, clock: Clock, now: Callable[[], int]) -> _Hand:
    """Return the timer that the alarms of a node have for a clock."""
    hands: dict[Clock, _Hand] = vars(node).setdefault('_hands', {})
    if clock not in hands:
        hands[clock] = _Hand(node, clock, now)
    return hands[clock]
