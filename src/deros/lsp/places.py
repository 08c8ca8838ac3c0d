"""Places as editors name them: URIs, lines and units of UTF-16, and how they become spans."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from urllib.parse import unquote, urlsplit

from lsprotocol import types

from deros.diagnostics import SourceFile, Span

Units = Callable[[str], int]
"""Returns the length of a text in the units that the editor counts in."""


def uri_of(path: str) -> str:
    """Return the URI of a file."""
    return Path(os.path.abspath(path)).as_uri()  # noqa: PTH100 - links stay


def path_of(uri: str) -> str | None:
    """Return the path of a file's URI; ``None`` for what is no file, such as a new buffer."""
    parts = urlsplit(uri)
    return unquote(parts.path) if parts.scheme == "file" and parts.path else None


class Places:
    """Translates between offsets in a text and the positions of an editor."""

    def __init__(self, units: Units = lambda text: len(text.encode("utf-16-le")) // 2) -> None:
        """Count in ``units``; editors that agree on nothing count in units of UTF-16."""
        self._units = units

    def position(self, source: SourceFile, offset: int) -> types.Position:
        """Return the position of a character."""
        line, column = source.line_column(offset)
        before = source.text[offset - column + 1 : offset]
        return types.Position(line - 1, self._length(before))

    def range(self, span: Span) -> types.Range:
        """Return the range of a span."""
        return types.Range(
            self.position(span.source, span.start), self.position(span.source, span.end)
        )

    def location(self, span: Span) -> types.Location:
        """Return the location of a span."""
        return types.Location(uri_of(span.file), self.range(span))

    def offset(self, source: SourceFile, position: types.Position) -> int:
        """Return the offset of a position; one behind a line's end is at its end."""
        start = source.line_start(position.line + 1)
        text = source.line(position.line + 1) if start < len(source.text) else ""
        if text.isascii():
            return start + min(position.character, len(text))
        units = 0
        for number, character in enumerate(text):
            if units >= position.character:
                return start + number
            units += self._units(character)
        return start + len(text)

    def length(self, span: Span) -> int:
        """Return the length of a span in one line."""
        return self._length(span.text)

    def _length(self, text: str) -> int:
        return len(text) if text.isascii() else self._units(text)
