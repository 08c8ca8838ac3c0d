"""The selection of fields that a decoder reads, as a tree with the structure of the message."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from deros.interfaces.fields import FieldPath


@dataclass(slots=True)
class FieldSelection:
    """The selected parts of one field.

    Attributes:
        name: the variable for its value; ``None`` if at most parts of it are selected.
        parts: the selections of its fields by name, or of its elements by index.
    """

    name: str | None = None
    parts: dict[str | int, FieldSelection] = field(default_factory=dict)

    @property
    def elements(self) -> list[tuple[int, FieldSelection]]:
        """The selected elements of an array, sorted by index."""
        return sorted((key, part) for key, part in self.parts.items() if isinstance(key, int))

    def names(self) -> Iterator[str]:
        """Yield the variables of all selected values."""
        if self.name is not None:
            yield self.name
        for part in self.parts.values():
            yield from part.names()


NOTHING = FieldSelection()
"""The selection of nothing: the field is skipped."""


def select(
    paths: Sequence[FieldPath], names: Mapping[tuple[str | int, ...], str]
) -> FieldSelection:
    """Return the selection of all ``paths``, with the variable of each."""
    root = FieldSelection()
    for path in paths:
        here = root
        for step in path:
            here = here.parts.setdefault(step, FieldSelection())
        here.name = names[tuple(path)]
    return root
