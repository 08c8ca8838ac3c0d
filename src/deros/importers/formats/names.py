"""Names for what files of other tools call otherwise."""

from __future__ import annotations

import itertools
import re

_LONGEST = 100
_LONG_WORD = re.compile(r"\w{256}")


def identifier(text: str, otherwise: str = "node") -> str:
    """Return a text as a name: other characters become ``_``."""
    name = re.sub(r"[^A-Za-z0-9_]+", "_", text).strip("_")[:_LONGEST]
    return f"_{name}" if name[:1].isdigit() else name or otherwise


def has_long_word(name: str) -> bool:
    """Return whether a part of a name is longer than what the languages read."""
    return _LONG_WORD.search(name) is not None


class UniqueNames:
    """Gives names that differ in more than case: they are those of files."""

    def __init__(self) -> None:
        """Start without names."""
        self._given: set[str] = set()

    def of(self, text: str) -> str:
        """Return a name that comes near to a text, and was not given before."""
        first = identifier(text)
        numbered = (f"{first}_{number}" for number in itertools.count(2))
        candidates = itertools.chain([first], numbered)
        name = next(each for each in candidates if each.lower() not in self._given)
        self._given.add(name.lower())
        return name
