"""Where a piece of the emitted code comes from, as a comment says it."""

from __future__ import annotations

import re
import textwrap

from deros.diagnostics import Span
from deros.generators.text.identifiers import file_label
from deros.generators.text.python import LINE_LENGTH


def origin(span: Span) -> str:
    """Return ``file:line``, of the file the name alone: no output depends on the machine."""
    return f"{file_label(span.file)}:{span.line}"


def comment(indent: int, title: str, span: Span, text: str | None = None) -> list[str]:
    """Return the comment above a block: its title, its origin and the source's text."""
    lines = _wrap(f"{title} ({origin(span)})", f"{' ' * indent}# ")
    for line in (span.text if text is None else text).splitlines():
        printable = "".join(c if c.isprintable() else " " for c in line)
        lines += _wrap(printable.strip(), f"{' ' * indent}#   ")
    return lines


def _wrap(text: str, lead: str) -> list[str]:
    further = f"{lead}  "
    return textwrap.wrap(text, LINE_LENGTH, initial_indent=lead, subsequent_indent=further)


def header(text: str) -> str:
    """Return the text of a behaviour up to its body."""
    match = re.search(r"\bthen\b", text)
    return text[: match.end()] if match else text
