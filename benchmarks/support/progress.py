"""One line that shows the progress of a benchmark, at hardly any cost."""

from __future__ import annotations

import time
from typing import TextIO

_SELDOM = 10.0


class Line:
    """Rewritten in place on a terminal, elsewhere a new line every ten seconds.

    Use it as a context manager; it is gone at the end.
    """

    def __init__(self, stream: TextIO) -> None:
        """Write to ``stream``."""
        self._stream = stream
        self._in_place = stream.isatty()
        self._shown = -_SELDOM

    def __enter__(self) -> Line:
        """Begin with an empty line."""
        return self

    def __exit__(self, *_: object) -> None:
        """Clear the line."""
        if self._in_place:
            self._write("\r\x1b[K")

    def show(self, text: str) -> None:
        """Show a text."""
        if self._in_place:
            self._write(f"\r\x1b[K{text}")
        elif time.monotonic() - self._shown >= _SELDOM:
            self._shown = time.monotonic()
            self._write(f"{text}\n")

    def _write(self, text: str) -> None:
        self._stream.write(text)
        self._stream.flush()
