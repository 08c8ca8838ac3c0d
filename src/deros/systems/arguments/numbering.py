"""Numbers of assignments, in the order of how much they differ from the usual one."""

from __future__ import annotations

import math
from collections.abc import Sequence

from deros.systems.arguments.diagrams import Deviation


class Numbering:
    """Numbers all combinations without going through them; 0 is the usual one.

    Attributes:
        count: of all combinations.
    """

    def __init__(self, sizes: Sequence[int]) -> None:
        """Number the combinations of so many values in each place."""
        self.count = math.prod(sizes)
        self._others = [size - 1 for size in sizes]
        self._ways: list[list[int]] = [[1] * (len(sizes) + 1)]

    def number(self, deviation: Deviation) -> int:
        """Return the number of an assignment."""
        count, places, positions = deviation
        number = sum(self._of_all(less) for less in range(count))
        before, start = 1, 0
        for left, place in zip(range(count, 0, -1), places, strict=True):
            number += sum(self._from(skipped, left, before) for skipped in range(start, place))
            before *= self._others[place]
            start = place + 1
        index = 0
        for place, position in zip(places, positions, strict=True):
            index = index * self._others[place] + position - 1
        return number + index

    def deviation(self, number: int) -> Deviation:
        """Return the assignment of a number below :attr:`count`."""
        count = 0
        while number >= self._of_all(count):
            number -= self._of_all(count)
            count += 1
        places: list[int] = []
        before, place = 1, 0
        for left in range(count, 0, -1):
            while number >= self._from(place, left, before):
                number -= self._from(place, left, before)
                place += 1
            before *= self._others[place]
            places.append(place)
            place += 1
        positions: list[int] = []
        for each in reversed(places):
            number, index = divmod(number, self._others[each])
            positions.insert(0, index + 1)
        return count, tuple(places), tuple(positions)

    def _of_all(self, count: int) -> int:
        """Return how many assignments differ in so many places."""
        return self._ways_of(count)[0]

    def _from(self, place: int, left: int, before: int) -> int:
        """Return how many of those that agree so far differ next in ``place``, ``left`` in all."""
        return before * self._others[place] * self._ways_of(left - 1)[place + 1]

    def _ways_of(self, count: int) -> list[int]:
        """Return, from each place on, how many ways there are to differ in ``count`` places."""
        while len(self._ways) <= count:
            fewer, found = self._ways[-1], [0]
            for place in reversed(range(len(self._others))):
                found.append(found[-1] + self._others[place] * fewer[place + 1])
            self._ways.append(found[::-1])
        return self._ways[count]
