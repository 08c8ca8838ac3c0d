"""Diagnostics as text for people: the place, the line with a caret, the hint, related places.

Colours appear only on a terminal, and never where ``NO_COLOR`` is set (https://no-color.org).
"""

from __future__ import annotations

import os
import sys
import unicodedata
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, TextIO

from deros.diagnostics import Diagnostic, Severity, Span

if TYPE_CHECKING:
    from deros.validators.findings.allowed import Allowed

Piece = tuple[str, str]
"""A piece of text and its style, a name that rich knows; ``""`` for none."""

_STYLE = {
    Severity.ERROR: "bold red",
    Severity.WARNING: "bold yellow",
    Severity.INFO: "bold cyan",
}
_WIDEST = 160
"""Longer lines are cut around the place that is meant."""


def render_text(diagnostics: Iterable[Diagnostic], allowed: Iterable[Allowed] = ()) -> str:
    """Return all diagnostics as plain text, each ended by a newline; those allowed come last."""
    return "".join(text for entry in _entries(diagnostics, allowed) for text, _ in entry)


def print_text(
    diagnostics: Sequence[Diagnostic],
    stream: TextIO | None = None,
    allowed: Sequence[Allowed] = (),
) -> None:
    """Write diagnostics to ``stream`` (standard output), coloured if it is a terminal."""
    out = stream if stream is not None else sys.stdout
    if not (out.isatty() and not os.environ.get("NO_COLOR")):
        out.write(render_text(diagnostics, allowed))
        return
    from rich.console import Console
    from rich.text import Text

    console = Console(file=out, soft_wrap=True, highlight=False, emoji=False, markup=False)
    for entry in _entries(diagnostics, allowed):
        console.print(Text.assemble(*entry), end="")


def summary(diagnostics: Iterable[Diagnostic], files: int, allowed: int = 0, known: int = 0) -> str:
    """Return the closing line, as ``2 errors and 1 warning in 3 files, 4 allowed``."""
    more = f", {allowed} allowed" if allowed else ""
    return _found(diagnostics, files) + more + (f", {known} in the baseline" if known else "")


def _found(diagnostics: Iterable[Diagnostic], files: int) -> str:
    count = Counter(d.severity for d in diagnostics)
    found = [
        counted(count[severity], word)
        for severity, word in (
            (Severity.ERROR, "error"),
            (Severity.WARNING, "warning"),
            (Severity.INFO, "remark"),
        )
        if count[severity]
    ]
    if not found:
        return f"{counted(files, 'file')} checked, no findings"
    *first, last = found
    return f"{', '.join(first)}{' and ' if first else ''}{last} in {counted(files, 'file')}"


def counted(number: int, word: str) -> str:
    """Return a number with its noun."""
    return f"{number} {word}" if number == 1 else f"{number} {word}s"


def _entries(
    diagnostics: Iterable[Diagnostic], allowed: Iterable[Allowed]
) -> Iterator[Iterable[Piece]]:
    yield from map(_pieces, diagnostics)
    for each in allowed:
        why = f"    = allowed at {_place(each.by.span)}: "
        yield (*_pieces(each.finding), (why, "cyan"), (f"{printable(each.by.reason)}\n", ""))


def _pieces(diagnostic: Diagnostic) -> Iterator[Piece]:
    span, style = diagnostic.span, _STYLE[diagnostic.severity]
    yield f"{_place(span)}: ", "bold"
    yield f"{diagnostic.severity.value}[{diagnostic.code}]", style
    yield f": {printable(diagnostic.message)}\n", "bold"
    yield from _excerpt(span, style)
    if diagnostic.hint:
        yield "    = hint: ", "bold green"
        yield f"{printable(diagnostic.hint)}\n", ""
    for related in diagnostic.related:
        yield f"    = {_place(related.span)}: ", "cyan"
        yield f"{printable(related.message)}\n", ""


def _place(span: Span) -> str:
    return f"{printable(span.file)}:{span.line}:{span.column}"


def _excerpt(span: Span, style: str) -> Iterator[Piece]:
    line, column = span.line, span.column
    text = span.source.line(line)
    if not text.strip():
        return
    last = span.end_column if span.end_line == line else len(text) + 1
    first = max(0, min(column - 1 - _WIDEST // 4, len(text) - _WIDEST))
    shown = text[first : first + _WIDEST]
    before = text[first : column - 1]
    marked = text[column - 1 : min(last - 1, first + _WIDEST)]
    gutter = f"{line:>5} | "
    yield gutter, "blue"
    yield (
        f"{'…' if first else ''}{printable(shown)}{'…' if first + _WIDEST < len(text) else ''}\n",
        "",
    )
    yield " " * (len(gutter) - 2) + "| ", "blue"
    yield f"{' ' if first else ''}{_blank(before)}{'^' * max(1, _width(marked))}\n", style


def printable(text: str) -> str:
    """Replace unprintable characters; tabs are kept, so that carets stay aligned."""
    return "".join(c if c.isprintable() or c == "\t" else "\N{REPLACEMENT CHARACTER}" for c in text)


def _blank(text: str) -> str:
    return "".join(c if c == "\t" else " " * _width(c) for c in text)


def _width(text: str) -> int:
    return sum(2 if unicodedata.east_asian_width(c) in "WF" else 1 for c in text)
