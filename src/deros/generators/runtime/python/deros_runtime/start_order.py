"""Decides which of two nodes of one name ends: the one that started last."""

from __future__ import annotations

YOUNG = 5_000_000_000  # ns; a node that meets the other one later than this after its start stays
PATIENCE = 200_000_000  # ns for which the other one has to be present: it may be ending


class StartOrder:
    """
    Decides whether a node gives way to another one of its name.

    The two detect each other at about the same time, and neither knows when the other one started.
    So each waits for as long again as it has run until then: the one that started last ends first,
    and the other one is alone.
    """

    def __init__(self, now: int) -> None:
        """Start at a time, in nanoseconds."""
        self._started = now
        self._met: int | None = None

    def gives_way(self, has_double: bool, now: int) -> bool:
        """Return whether the node is to end, given whether there is another one now."""
        if not has_double:
            self._met = None
            return False
        if self._met is None:
            self._met = now
        age = self._met - self._started
        return age < YOUNG and now - self._met >= PATIENCE + age
