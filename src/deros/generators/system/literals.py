"""Python text in ament's style: single quotes, no line over 99 columns."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Mapping

from deros.metamodels.common import Value

WIDTH = 99
Literal = Value | None | Mapping[str, Value] | Mapping[str, str]


def python_literal(value: Literal, column: int = 0, indent: int = 0, after: int = 1) -> str:
    """Return ``value`` as Python text that starts at ``column`` of a line indented by ``indent``.

    Where a line would be longer than :data:`WIDTH`, with ``after`` characters to follow, the value
    is broken: arrays (which become lists) into one element on a line, texts into pieces in
    parentheses.
    """
    flat = _flat(value)
    if column + len(flat) + after <= WIDTH:
        return flat
    inner = indent + 4
    margin = "\n" + " " * inner
    end = "\n" + " " * indent
    if isinstance(value, str):
        room = WIDTH - inner - 2
        pieces = "".join(margin + _flat(piece) for piece in _pieces(value, room))
        return f"({pieces}{end})"
    if isinstance(value, tuple):
        items = "".join(f"{margin}{python_literal(item, inner, inner)}," for item in value)
        return f"[{items}{end}]"
    if isinstance(value, Mapping):
        items = ""
        for key, item in value.items():
            head = f"{python_literal(key, inner, inner)}: "
            column = inner + len(head.rpartition("\n")[2])
            items += f"{margin}{head}{python_literal(item, column, inner)},"
        return f"{{{items}{end}}}"
    return flat


def _flat(value: Literal) -> str:
    if isinstance(value, float) and not math.isfinite(value):
        return f"float({str(value)!r})"
    if isinstance(value, tuple):
        return f"[{', '.join(map(_flat, value))}]"
    if isinstance(value, Mapping):
        return f"{{{', '.join(f'{_flat(key)}: {_flat(item)}' for key, item in value.items())}}}"
    return repr(value)


def _pieces(text: str, room: int) -> list[str]:
    """Cut a text, after blanks if it has any, so that each literal fits into ``room`` columns."""
    pieces = []
    while text:
        end = len(text)
        while end > 1 and len(_flat(text[:end])) > room:
            end = min(end - 1, room)
        blank = text.rfind(" ", room // 2, end)
        if end < len(text) and blank > 0:
            end = blank + 1
        pieces.append(text[:end])
        text = text[end:]
    return pieces


def comment(text: str, indent: int = 0) -> str:
    """Return a text as comment lines, each after ``indent`` blanks."""
    margin = " " * indent + "# "
    return textwrap.fill(
        text, WIDTH, initial_indent=margin, subsequent_indent=margin, break_on_hyphens=False
    )
