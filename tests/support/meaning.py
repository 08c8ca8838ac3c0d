"""What a model says, without the places at which it says so."""

from __future__ import annotations

import enum
from dataclasses import fields, is_dataclass
from typing import Any

from deros.diagnostics import SourceFile, Span


def meaning(model: object) -> object:
    """Return the contents of a model as tuples: equal for two texts that say the same."""
    return _Reading().of(model)


class _Reading:
    """Reads a model, which may refer to models that refer to it: each object is read once."""

    def __init__(self) -> None:
        self._read: dict[int, object] = {}
        self._kept: list[Any] = []  # so that no other object takes its place

    def of(self, value: Any) -> object:
        """Return what a value says."""
        if isinstance(value, (str, int, float, bool, enum.Enum, type(None))):
            return repr(value)  # nan is equal to nan, True is not 1
        if isinstance(value, (Span, SourceFile)):
            return ""
        if id(value) not in self._read:
            self._kept.append(value)
            self._read[id(value)] = f"the {type(value).__name__} around this"
            self._read[id(value)] = self._contents(value)
        return self._read[id(value)]

    def _contents(self, value: Any) -> object:
        if isinstance(value, dict):
            return tuple((self.of(key), self.of(each)) for key, each in value.items())
        if isinstance(value, (tuple, list)):
            return tuple(self.of(each) for each in value)
        if isinstance(value, (set, frozenset)):
            return frozenset(self.of(each) for each in value)
        if is_dataclass(value):
            named = [(each.name, getattr(value, each.name)) for each in fields(value)]
        elif hasattr(value, "__dict__"):
            named = list(vars(value).items())
        elif hasattr(value, "__slots__") and type(value).__module__.startswith("deros."):
            named = [(name, getattr(value, name)) for name in value.__slots__]
        else:
            return repr(value)
        return (type(value).__name__, *((name, self.of(each)) for name, each in named))
