"""Looks ahead: what becomes of the verdicts of rules as time goes on, without news."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from .report_types import Monitor

STAYING = 'if values stay'  # all inputs send on what they sent last
SILENT = 'if no message comes'
INSTANTS = 256  # that are looked at, at most


class NextVerdict(NamedTuple):
    """What a rule becomes next; None is unknown."""

    value: bool | None
    at: int  # in nanoseconds


class LookAhead:
    """
    Plays the deadlines of a monitor in copies, until all rules have changed or none is left.

    Nobody acts on what a copy orders. Found holds the next verdicts of each rule that changes, by
    its place among the rules and by what has to be the case.
    """

    def __init__(self, monitor: Monitor) -> None:
        """Copy a monitor as it is now; run through steps() to look ahead."""
        self.found: dict[int, dict[str, NextVerdict]] = {}
        self._before = monitor.verdicts()
        self._copies = {STAYING: monitor.copy(True), SILENT: monitor.copy(False)}

    def steps(self) -> Iterator[None]:
        """Yield after each instant, so that a caller may do something else in between."""
        for case, copy in self._copies.items():
            left = set(range(len(self._before)))
            for _ in range(INSTANTS):
                due = copy.next_deadline
                if due is None or not left:
                    break
                copy.advance(due)
                verdicts = copy.verdicts()
                for place in [each for each in left if verdicts[each] is not self._before[each]]:
                    left.remove(place)
                    change = NextVerdict(verdicts[place], due)
                    self.found.setdefault(place, {})[case] = change
                yield
