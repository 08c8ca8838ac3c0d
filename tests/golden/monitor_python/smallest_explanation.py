"""
Why the monitor of small says what it says.

… 4 lines of explanation.py.j2: All that the monitor decides is in monitor.py: here it is read, and nothing of it is changed.
from typing import NamedTuple

from .monitor import Monitor, verdict_on


… 46 lines of explanation.py.j2: class Reading(NamedTuple):
… 5 lines of explanation.py.j2: def because(head: str, causes: tuple[str, ...]) -> str:
… 8 lines of explanation.py.j2: class ExplainedMonitor(Monitor):
            explained(
                'e.r', 2, 'r: v;', self._e_r, self._e_r_since, self._why_e_r, ('v', self._v),
            ),
        )
        causes = {}
        if self._behaviour_1:
            causes['behaviour_1'] = self._why_behaviour_1()
        return Explanation(rules, causes)

    def _why_e_r(self) -> tuple[str, ...]:
        """Return why e.r is true."""
        return ('v is true',)

    def _why_behaviour_1(self) -> tuple[str, ...]:
        """Return why behaviour_1 holds."""
        return (because('e.r: ', self._why_e_r()),)
