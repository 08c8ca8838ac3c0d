"""Identifiers of emitted text: descriptive names, never reserved, never the same twice."""

from __future__ import annotations

from collections.abc import Sequence

from deros.generators.text.identifiers import python_identifier


class UniqueNames:
    """Hands out identifiers that differ from each other and from all reserved ones."""

    def __init__(self, taken: frozenset[str] = frozenset()) -> None:
        """Start with the names that are ``taken``."""
        self._taken = set(taken)

    def new(self, *parts: str | int, endings: Sequence[str] = ()) -> str:
        """Return an identifier made of ``parts``; a number is added where it is taken already.

        Args:
            parts: the words of the identifier.
            endings: what others end in that are made of it; they are as free as it is, and taken.
        """
        words = (python_identifier(str(part)).strip("_") for part in parts)
        base = "_".join(word for word in words if word) or "value"
        if base[0].isdigit():
            base = f"n{base}"
        name, number = base, 2
        while not self._taken.isdisjoint(wanted := {name, *(name + each for each in endings)}):
            name, number = f"{base}_{number}", number + 1
        self._taken |= wanted
        return name
