"""The fields that a decoder is to read, as a tree that follows the messages' structure."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from deros.interfaces.fields import FieldPath


@dataclass(slots=True)
class FieldSelection:
    """What is wanted of one field.

    Attributes:
        name: the variable for its value; ``None`` where only parts of it are wanted.
        parts: what is wanted of its fields, by name, or of its elements, by index.
    """

    name: str | None = None
    parts: dict[str | int, FieldSelection] = field(default_factory=dict)

    @property
    def elements(self) -> list[tuple[int, FieldSelection]]:
        """What is wanted of the elements of an array, in the order in which they come."""
        return sorted((key, part) for key, part in self.parts.items() if isinstance(key, int))

    def names(self) -> Iterator[str]:
        """Yield the variables for all its values."""
        if self.name is not None:
            yield self.name
        for part in self.parts.values():
            yield from part.names()


NOTHING = FieldSelection()
"""A field that is only passed over."""


def tree(paths: Sequence[FieldPath], names: Mapping[tuple[str | int, ...], str]) -> FieldSelection:
    """Return the tree of all ``paths``, each with its name."""
    root = FieldSelection()
    for path in paths:
        here = root
        for step in path:
            here = here.parts.setdefault(step, FieldSelection())
        here.name = names[tuple(path)]
    return root
