"""Fields of a message in YAML; what is not there has the value zero, as in ROS 2."""

from __future__ import annotations

import math
from collections.abc import Iterator

from deros.diagnostics import Span
from deros.importers.formats import loading
from deros.importers.results import Missing
from deros.interfaces.types import INT64
from deros.metamodels.yaml_trees.tree import Mapping, Scalar, Sequence, Tree


class Fields:
    """The fields of one message.

    Attributes:
        tree: the message.
    """

    def __init__(self, tree: Mapping, missing: list[Missing]) -> None:
        """Store a message, and where to note what cannot be read of it."""
        self.tree = tree
        self._missing = missing

    @classmethod
    def of(cls, tree: Tree, what: str, missing: list[Missing]) -> Fields | None:
        """Return the fields of a message; ``None``, with a note, where there is none."""
        if isinstance(tree, Mapping):
            return cls(tree, missing)
        missing.append(loading.missing(what, "has no fields; print it in full", tree.span))
        return None

    def lack(self, what: str, why: str) -> None:
        """Note what the model does not say of the message."""
        self._missing.append(loading.missing(what, why, self._place))

    @property
    def _place(self) -> Span:
        return next(iter(self.tree.keys.values()), self.tree.span)

    def text(self, key: str) -> str:
        """Return a field of type string."""
        found = self.tree.get(key)
        return found.text if isinstance(found, Scalar) else ""

    def number(self, key: str) -> float:
        """Return a field that is a number; ``nan`` for what is none, or has more than 64 bits."""
        found = self.tree.get(key)
        value = found.value if isinstance(found, Scalar) else 0 if found is None else None
        if isinstance(value, bool) or not isinstance(value, int | float):
            return math.nan
        return value if isinstance(value, float) or value in INT64 else math.nan

    def integer(self, key: str) -> int:
        """Return a field that is an integer of 64 bits."""
        value = self.number(key)
        return value if isinstance(value, int) else 0

    def is_true(self, key: str) -> bool:
        """Return a field of type bool."""
        found = self.tree.get(key)
        return isinstance(found, Scalar) and found.value is True

    def within(self, key: str) -> Fields:
        """Return the fields of a nested message."""
        found = self.tree.get(key)
        return Fields(found if isinstance(found, Mapping) else _nothing(self._place), self._missing)

    def items(self, key: str) -> Iterator[Fields]:
        """Yield the messages of a list."""
        found = self.tree.get(key)
        for each in found.items if isinstance(found, Sequence) else ():
            fields = Fields.of(each, f"an entry of '{key}'", self._missing)
            if fields is not None:
                yield fields


def _nothing(place: Span) -> Mapping:
    return Mapping({}, {}, place)
