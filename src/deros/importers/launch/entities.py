"""The elements of a launch file as they are taken apart, and what is left of each."""

from __future__ import annotations

from collections.abc import Iterator

from deros.importers.launch.values.substitutions import InexpressibleError
from deros.metamodels.launch_files.elements import Element


class Entity:
    """An element, of which is known what has been asked for."""

    def __init__(self, element: Element) -> None:
        """Look at an element."""
        self.element = element
        self._asked: set[str] = set()

    @property
    def tag(self) -> str:
        """The name of the element, with ``_`` for ``-``."""
        return self.element.tag

    @property
    def line(self) -> int:
        """Where it stands, from 1."""
        return self.element.span.line

    def get(self, name: str) -> str | None:
        """Return an attribute, if it is there."""
        self._asked.add(name)
        return self.element.attributes.get(name)

    def needed(self, name: str) -> str:
        """Return an attribute.

        Raises:
            InexpressibleError: it is not there.
        """
        found = self.get(name)
        if found is None:
            raise InexpressibleError(f"has no '{name}'")
        return found

    def details(self, tag: str) -> list[Entity]:
        """Return the elements of one name in it."""
        self._asked.add(f"<{tag}>")
        return [Entity(each) for each in self.element.children if each.tag == tag]

    def children(self) -> list[Element]:
        """Return all elements in it that have not been asked for."""
        self._asked.add("<>")
        return [e for e in self.element.children if f"<{e.tag}>" not in self._asked]

    def left(self) -> Iterator[tuple[str, int]]:
        """Yield what has not been asked for, and where it stands."""
        for name, value in self.element.attributes.items():
            if name not in self._asked:
                yield f"{name}=\"{value}\" of '{self.tag}'", self.line
        if "<>" not in self._asked:
            for each in self.element.children:
                if f"<{each.tag}>" not in self._asked:
                    yield f"'{each.tag}' in '{self.tag}'", each.span.line
        if not self.element.is_whole:
            yield f"an alias or an empty value in '{self.tag}'", self.line
