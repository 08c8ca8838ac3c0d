"""Values and comments as Python text in ament's style, for files that start systems."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping

from deros.generators.text.document import (
    HARDLINE,
    Document,
    breakable,
    concat,
    join,
    nest,
    render,
    render_lines,
)
from deros.generators.text.prose import paragraph
from deros.generators.text.python import LINE_LENGTH, bracketed
from deros.models.common import Value

Literal = Value | None | Mapping[str, Value] | Mapping[str, str]


def python_literal(value: Literal, column: int = 0, indent: int = 0, after: int = 1) -> str:
    """Return ``value`` as Python text.

    Where it is too long for a line, arrays (which become lists) and mappings have one element on
    each line, and texts become several literals in brackets.

    Args:
        value: the value.
        column: where it starts in its first line.
        indent: the blanks in front of that line.
        after: how many characters follow the value on its last line.
    """
    document = concat(_document(value), "," * after)
    text = render(document, LINE_LENGTH, indent, column)
    return text[: len(text) - after]


def listed(items: Iterable[str], indent: int) -> str:
    """Return a list of expressions, each on a line of its own, in a line behind ``indent``."""
    margin = " " * indent
    return "\n".join(["[", *(f"{margin}    {each}," for each in items), f"{margin}]"])


def _document(value: Literal) -> Document:
    if isinstance(value, str):
        return breakable(_flat(value), lambda indent: _literals(value, indent + 4))
    if isinstance(value, tuple):
        return bracketed("", "[", [_document(item) for item in value], "]")
    if isinstance(value, Mapping):
        pairs = ((_document(key), _document(item)) for key, item in value.items())
        return bracketed("", "{", [concat(key, ": ", item) for key, item in pairs], "}")
    return _flat(value)


def _literals(text: str, indent: int) -> Document:
    pieces = join(HARDLINE, map(_flat, _pieces(text, max(1, LINE_LENGTH - indent - 2))))
    return concat("(", nest(4, HARDLINE, pieces), HARDLINE, ")")


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
    return pieces or [""]


def comment(text: str, indent: int = 0) -> str:
    """Return a text as comment lines, each behind ``indent`` blanks."""
    longest = LINE_LENGTH - indent - len("# ")
    return "\n".join(render_lines(paragraph(text, "# ", "# ", longest), LINE_LENGTH, indent))
