"""Identifiers for emitted code: descriptive, not reserved, and unique."""

from __future__ import annotations

from collections.abc import Sequence

from deros.generators.text.identifiers import python_identifier


class UniqueNames:
    """Creates identifiers that differ from each other and from all reserved ones."""

    def __init__(self, taken: frozenset[str] = frozenset()) -> None:
        """Treat the names in ``taken`` as used already."""
        self._taken = set(taken)

    def new(self, *parts: object, endings: Sequence[str] = ()) -> str:
        """Return a new identifier made of ``parts``, with a number at the end if it is taken.

        Args:
            parts: the words of the identifier, or steps of a path.
            endings: suffixes; the identifier with each of them is unique, too, and reserved.
        """
        words = (python_identifier(str(part)).strip("_") for part in parts)
        base = "_".join(word for word in words if word) or "value"
        if base[0].isdigit():
            base = f"n{base}"
        name, number = base, 2
        while not self._taken.isdisjoint(wanted := {name, *(name + ending for ending in endings)}):
            name, number = f"{base}_{number}", number + 1
        self._taken |= wanted
        return name
