"""The size of a message with all nested ones, checked before it is traversed.

rosidl has no messages that contain themselves, and a few files of nested arrays can ask for more
fields than any machine has memory for.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from deros.interfaces.types import InterfaceType, MessageDefinition

MOST_FIELDS = 10_000
"""The most fields of a message, nested ones included; an array counts once."""

MOST_ELEMENTS = 1 << 24
"""The most elements of fixed arrays in a message: enough for an image of 16 MB."""

DEEPEST = 50

Look = Callable[[InterfaceType], MessageDefinition | None]


@dataclass(frozen=True, slots=True)
class Extent:
    """The size of a message: fields and fixed elements; or the reason why it cannot be used.

    ``unknown`` is a type nested in it that has no definition: fields before it can still be named.
    """

    fields: int = 0
    elements: int = 0
    problem: str = ""
    unknown: InterfaceType | None = None


class Extents:
    """Measures messages, each once, in time linear in the definitions however they nest."""

    def __init__(self, look: Look) -> None:
        """Look nested messages up with ``look``, which returns ``None`` for one that is unknown."""
        self._look = look
        self._known: dict[InterfaceType, Extent] = {}
        self._open: list[InterfaceType] = []

    def of(self, definition: MessageDefinition) -> Extent:
        """Return the extent of a message."""
        kind = definition.type
        if kind in self._open:
            chain = [*self._open[self._open.index(kind) :], kind]
            return Extent(problem=f"it contains itself: {' → '.join(map(str, chain))}")
        if kind not in self._known:
            if len(self._open) > DEEPEST:
                return Extent(problem=f"messages are nested more than {DEEPEST} levels deep in it")
            self._open.append(kind)
            self._known[kind] = self._measured(definition)
            self._open.pop()
        return self._known[kind]

    def _measured(self, definition: MessageDefinition) -> Extent:
        fields = elements = 0
        unknown: InterfaceType | None = None
        for _, kind in definition.fields:
            inner = Extent(1, 1)
            if isinstance(kind.base, InterfaceType):
                nested = self._look(kind.base)
                inner = Extent(1, 1, unknown=kind.base) if nested is None else self.of(nested)
                if inner.problem:
                    return inner
                unknown = unknown or inner.unknown
            fields += inner.fields
            if not kind.is_array or kind.array == "fixed":
                elements += inner.elements * (1 if kind.size is None else kind.size)
            if fields > MOST_FIELDS:
                return Extent(
                    problem=f"it has more than {MOST_FIELDS:,} fields, nested ones included"
                )
            if elements > MOST_ELEMENTS:
                return Extent(problem=f"its fixed arrays have more than {MOST_ELEMENTS:,} elements")
        return Extent(fields, elements, unknown=unknown)
