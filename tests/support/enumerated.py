"""Sets of assignments as lists of all that are in them: the oracle of decision diagrams."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence

from deros.systems.arguments.diagrams import Deviation


def deviations(sizes: Sequence[int]) -> Iterator[Deviation]:
    """Yield all combinations of so many values in each place, in the order that numbers have."""
    for count in range(len(sizes) + 1):
        for places in itertools.combinations(range(len(sizes)), count):
            for positions in itertools.product(*(range(1, sizes[place]) for place in places)):
                yield count, places, positions


def positions_of(deviation: Deviation, sizes: Sequence[int]) -> tuple[int, ...]:
    """Return the position of the value in each place."""
    _, places, positions = deviation
    by_place = dict(zip(places, positions, strict=True))
    return tuple(by_place.get(place, 0) for place in range(len(sizes)))
