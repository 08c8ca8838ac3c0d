"""
The monitor of small: what its safety rules say of messages and of time.

… 6 lines of monitor.py.j2: It is pure: whoever owns it hands in messages and the time, in nanoseconds of one clock, and takes
from collections.abc import Callable, Collection
import copy
import enum
import math
from typing import NamedTuple

… 5 lines of monitor.py.j2: NAN = math.nan
    'behaviour_1': ('e.r',),
}


… 43 lines of monitor.py.j2: class EventKind(str, enum.Enum):
… 5 lines of monitor.py.j2: class Monitor:
    __slots__ = ('_emit', '_now', '_due', '_e_r', '_behaviour_1', '_v', '_e_r_since')

    def __init__(
        self, start: int, emit: Callable[[Event], None], grace: int = 0,
        latched: Collection[str] = (),
… 6 lines of monitor.py.j2: ) -> None:
… 3 lines of monitor.py.j2: """
        self._e_r = False
        self._behaviour_1 = False
… 25 lines of monitor.py.j2: self._restart(start, grace)
            ('behaviour_1', self._behaviour_1, False),
        )

… 3 lines of monitor.py.j2: @property
        return False

… 3 lines of monitor.py.j2: def verdicts(self) -> tuple[bool | None, ...]:
            verdict_on(self._e_r, self._v),
… 10 lines of monitor.py.j2: )
        return copied

… 14 lines of monitor.py.j2: def advance(self, t: int) -> None:
        return True

    def on_flag(self, t: int, data: bool) -> None:
        """Process a message of /flag (std_msgs/msg/Bool)."""
… 3 lines of monitor.py.j2: if not self._now <= t < self._due:
        # Input v (small.deros:2)
        #   input v = topic /flag.data
        if data == self._v:
            return
        self._v = data
        if self._judge_flag(t):
            self._act(t)

    def _judge_flag(self, t: int) -> bool:
        """Evaluate the rules on /flag; return whether a verdict changed."""
        v = self._v
        changed = False

        # Rule e.r (small.deros:2)
        #   r: v;
        if v:
            if not self._e_r:
                self._e_r = True
                self._e_r_since = t
                changed = True
        elif self._e_r:
            self._e_r = False
            self._e_r_since = t
            changed = True
… 4 lines of monitor.py.j2: return changed
        e_r = self._e_r

        # Behaviour behaviour_1 (small.deros:2)
        #   if e.r then { stop; };
        if e_r:
            if not self._behaviour_1:
                self._behaviour_1 = True
                self._trigger(t, 'stop', 'behaviour_1', 2)
        else:
            self._behaviour_1 = False

    def _evaluate(self, t: int) -> None:
        """Evaluate all rules and behaviours, at a deadline or a step of the clock."""
        self._judge_flag(t)
… 8 lines of monitor.py.j2: self._act(t)
… 10 lines of monitor.py.j2: def _catch_up(self, t: int) -> None:
… 6 lines of monitor.py.j2: self._evaluate(due)
        return NEVER

    def _restart(self, t: int, grace: int) -> None:
        """Forget all inputs and intervals at t; timeouts count from t + grace."""
        self._e_r_since = t
        self._forget_v()
        self._due = self._earliest()

    def _forget_v(self) -> None:
        """Make the values of input v unknown."""
        self._v = None
