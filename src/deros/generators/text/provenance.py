"""The origin of a piece of the emitted code, for the comment above it."""

from __future__ import annotations

import re

from deros.diagnostics import Span
from deros.generators.text.document import HARDLINE, join, render_lines
from deros.generators.text.identifiers import file_label
from deros.generators.text.prose import paragraph
from deros.generators.text.python import LINE_LENGTH


def origin(span: Span) -> str:
    """Return ``file:line``, without the folder: no output depends on the machine."""
    return f"{file_label(span.file)}:{span.line}"


def comment(indent: int, title: str, span: Span, text: str | None = None) -> list[str]:
    """Return the comment above a block: its title, its origin and the text of the source."""
    longest = LINE_LENGTH - indent - len("#     ")
    lines = [paragraph(f"{title} ({origin(span)})", "# ", "#   ", longest)]
    for line in (span.text if text is None else text).splitlines():
        printable = "".join(c if c.isprintable() else " " for c in line).strip()
        if printable:
            lines.append(paragraph(printable, "#   ", "#     ", longest))
    return render_lines(join(HARDLINE, lines), LINE_LENGTH, indent)


def header(text: str) -> str:
    """Return the text of a behaviour up to its body, ``then`` included."""
    match = re.search(r"\bthen\b", text)
    return text[: match.end()] if match else text
