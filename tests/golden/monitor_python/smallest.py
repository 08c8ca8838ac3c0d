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


… 30 lines of monitor.py.j2: class EventKind(str, enum.Enum):
… 9 lines of monitor.py.j2: class Monitor:
        '_e_r',
        '_behaviour_1',
        '_v',
        '_e_r_since',
… 4 lines of monitor.py.j2: )
        latched: Collection[str] = (),
… 6 lines of monitor.py.j2: ) -> None:
… 3 lines of monitor.py.j2: """
        self._e_r = False
        self._behaviour_1 = False
… 11 lines of monitor.py.j2: self._restart(start, grace)
            ('behaviour_1', self._behaviour_1),
… 6 lines of monitor.py.j2: )
… 5 lines of monitor.py.j2: return ()
… 5 lines of monitor.py.j2: return ()
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
                self._emit(Event(t, EventKind.TRIGGER, 'stop', 'behaviour_1', (), 2))
        else:
            self._behaviour_1 = False

    def _evaluate(self, t: int) -> None:
        """Evaluate all rules and behaviours, at a deadline or a step of the clock."""
        self._judge_flag(t)
        self._act(t)

… 10 lines of monitor.py.j2: def _catch_up(self, t: int) -> None:
… 6 lines of monitor.py.j2: self._evaluate(due)
        due = NEVER
… 4 lines of monitor.py.j2: return due
        self._e_r_since = t
        self._forget_v()
        self._due = self._earliest()

    def _forget_v(self) -> None:
        """Make the values of input v unknown."""
        self._v = None
