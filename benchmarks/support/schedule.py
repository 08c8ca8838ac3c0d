"""When the driver of a benchmark may act: never near an instant at which a reaction is due."""

from __future__ import annotations

from bisect import bisect_left, insort


class Schedule:
    """The instants at which reactions are due, each with some quiet before and after it.

    Args:
        quiet_ns: how far from a due reaction everything else has to stay.
    """

    def __init__(self, quiet_ns: int) -> None:
        """Begin without any."""
        self._quiet = quiet_ns
        self._due: list[int] = []

    def add(self, due: int) -> None:
        """Note that a reaction is due at an instant."""
        insort(self._due, due)

    def admits(self, due: int) -> bool:
        """Tell whether another reaction may be due at an instant."""
        return self._clash(due) is None

    def first_free(self, instant: int) -> int:
        """Return the first instant, from the given one on, that disturbs no due reaction."""
        while (clash := self._clash(instant)) is not None:
            instant = clash + self._quiet
        return instant

    def forget_before(self, instant: int) -> None:
        """Drop what was due so long ago that nothing from ``instant`` on can disturb it."""
        del self._due[: bisect_left(self._due, instant - self._quiet)]

    def _clash(self, instant: int) -> int | None:
        """Return the last due instant nearer than the quiet."""
        position = bisect_left(self._due, instant + self._quiet) - 1
        if position < 0 or self._due[position] <= instant - self._quiet:
            return None
        return self._due[position]
