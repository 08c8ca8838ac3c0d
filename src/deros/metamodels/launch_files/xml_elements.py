"""The elements of a launch file in XML.

Expat reads no other files. No entity is ever expanded, so none can grow into a great text: of a
file that declares one nothing is known.
"""

from __future__ import annotations

from collections.abc import Mapping
from xml.parsers import expat

from deros.diagnostics import SourceFile, Span
from deros.metamodels.launch_files.elements import MOST, Element, NotALaunchFile, NotRead
from deros.metamodels.parameter_files.events import DEEPEST


def xml_elements(source: SourceFile) -> Element:
    """Return the root of a file.

    Raises:
        NotALaunchFile: it is not XML.
        NotRead: it is not read here.
    """
    return _Reading(source).root()


class _Reading:
    """Builds the elements of one file."""

    def __init__(self, source: SourceFile) -> None:
        self._source = source
        self._data = source.text.encode()
        self._parser = expat.ParserCreate("utf-8")
        self._parser.StartElementHandler = self._start
        self._parser.EndElementHandler = self._end
        self._parser.EntityDeclHandler = self._entity
        self._parser.CharacterDataHandler = self._text
        self._parser.buffer_text = True
        self._open: list[Element] = []
        self._root: Element | None = None
        self._count = 0
        self._place = (0, 0)
        """A position in bytes, and the same in characters; positions only grow."""

    def root(self) -> Element:
        try:
            self._parser.Parse(self._data, True)
        except expat.ExpatError as error:
            position = self._characters(self._parser.ErrorByteIndex)
            words = expat.ErrorString(error.code)
            span = self._span(position, 1)
            raise NotALaunchFile(f"this is not XML: {words}", span) from error
        assert self._root is not None  # else there was an error
        return self._root

    def _start(self, tag: str, attributes: Mapping[str, str]) -> None:
        position = self._characters(self._parser.CurrentByteIndex) + 1
        found = Element(tag.replace("-", "_"), self._span(position, len(tag)), dict(attributes))
        self._count += 1 + len(attributes)
        if len(self._open) >= DEEPEST or self._count > MOST:
            raise NotRead
        if self._open:
            self._open[-1].children.append(found)
        else:
            self._root = found
        self._open.append(found)

    def _text(self, text: str) -> None:
        if not text.isspace():  # else there is one between any two elements
            self._open[-1].texts.append(text)

    def _end(self, tag: str) -> None:  # noqa: ARG002
        self._open.pop()

    def _entity(self, *_: object) -> None:
        raise NotRead

    def _characters(self, position: int) -> int:
        """Return a position in bytes as one in characters."""
        before, known = self._place
        position = max(position, before)
        known += len(self._data[before:position].decode(errors="replace"))
        self._place = (position, known)
        return known

    def _span(self, start: int, length: int) -> Span:
        end = min(start + length, len(self._source.text))
        return Span(self._source, min(start, end), end)
