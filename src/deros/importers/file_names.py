"""Names of node types, which are those of files: they differ in more than case."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator


class FileNames:
    """Gives each name once."""

    def __init__(self, taken: Iterable[str] = ()) -> None:
        """Start with names that are never given."""
        self._given = {each.lower() for each in taken}

    def first(self, candidates: Iterable[str]) -> str:
        """Return the first one that is free, and take it; some candidate has to be."""
        name = next(each for each in candidates if each.lower() not in self._given)
        self._given.add(name.lower())
        return name


def numbered(name: str, first: int = 2) -> Iterator[str]:
    """Yield a name, and then the same with the numbers from ``first`` behind it."""
    yield name
    yield from (f"{name}_{number}" for number in itertools.count(first))
