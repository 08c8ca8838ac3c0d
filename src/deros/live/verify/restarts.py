"""Nodes that start again and again: each time they are back before anybody would miss them.

All times are nanoseconds of one steady clock, given from outside.
"""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Collection, Iterable

from deros.interfaces.durations import NS_PER_S
from deros.live.verify.differences import Difference, Kind

WITHIN_S = 60
"""Seconds in which starts are counted."""

MOST = 2
"""Starts within these seconds that are not reported: somebody may be trying something out."""


class Restarts:
    """Counts the starts of nodes from look to look."""

    def __init__(self, expected: Collection[str]) -> None:
        """Begin with the full names of the nodes that are watched."""
        self._expected = expected
        self._before: Counter[str] | None = None
        self._starts: dict[str, deque[int]] = {}

    def look(self, now_ns: int, names: Iterable[str] | None) -> tuple[Difference, ...]:
        """Return the nodes that start too often, after one more look.

        Args:
            now_ns: when.
            names: the full names of the nodes that are there; one that was killed is there
                until its lease ends, so that its successor is a second one of the name. ``None``:
                as they were at the last look.
        """
        if names is not None:
            self._count(now_ns, Counter(names))
        return tuple(self._differences(now_ns))

    def _count(self, now_ns: int, there: Counter[str]) -> None:
        before = there if self._before is None else self._before
        for name in there:
            for _ in range(there[name] - before[name]):
                if name in self._expected:
                    self._starts.setdefault(name, deque()).append(now_ns)
        self._before = there

    def _differences(self, now_ns: int) -> Iterable[Difference]:
        for name, starts in self._starts.items():
            while starts and now_ns - starts[0] > WITHIN_S * NS_PER_S:
                starts.popleft()
            if len(starts) > MOST:
                seen = f"more than {MOST} starts within {WITHIN_S} s"
                yield Difference(Kind.RESTARTING_NODE, name, seen=seen)
