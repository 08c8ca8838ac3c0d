"""One-shot timers that ring at an instant, once."""

from __future__ import annotations

from collections.abc import Callable

from rclpy.clock import Clock
from rclpy.node import Node

PATIENCE = 50_000_000  # ns that an alarm may be put off in all


class Alarm:
    """
    A timer that is set to an instant of a clock.

    The EventsExecutor may run the callback of a timer twice for one expiry, when another timer is
    set in the same moment; of a periodic timer the next call is then one period late. An alarm
    knows when it is due, whatever the executor does.
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
        self.is_set = False
        self._now = now
        self._callback = callback
        self._put_off = put_off
        self._timer = node.create_timer(1.0, self._ring, clock=clock, autostart=False)

    def ring_at(self, due: int) -> None:
        """Ring at an instant, or at once if it is past; what was set before is forgotten."""
        self.due, self.is_set = due, True
        self._wait(due - self._now())

    def repeat(self, period: int) -> None:
        """Ring again a period after the last time, or after now if either was long ago."""
        latest = self._now() + period
        due = self.due + period
        self.ring_at(due if latest - period < due <= latest else latest)

    def _ring(self) -> None:
        self._timer.cancel()
        if not self.is_set:
            return
        late = self._now() - self.due
        if late < 0:
            self._wait(-late)
            return
        if self._put_off is not None and late < PATIENCE and (pause := self._put_off()) > 0:
            self._wait(pause)
            return
        self.is_set = False
        self._callback()

    def _wait(self, time: int) -> None:
        self._timer.timer_period_ns = max(time, 1)
        self._timer.reset()
