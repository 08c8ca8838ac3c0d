"""Small pieces of Python source text: imports, calls, literals; all within ament's line length."""

from __future__ import annotations

import io
import textwrap
import tokenize
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from deros.generators.text.prose import printable_line

LINE_LENGTH = 99
"""Longest line that ament's flake8 settings allow."""


def import_lines(imports: Mapping[str, Iterable[str]]) -> list[str]:
    """Return one group of import statements in the order that ament's flake8 settings want.

    Args:
        imports: the names to import by module; no names stand for ``import module``.
    """
    lines: list[str] = []
    for module in sorted(imports, key=lambda name: (name.lower(), name)):
        names = sorted(set(imports[module]), key=lambda name: (name.lower(), name))
        if not names:
            lines.append(f"import {module}")
            continue
        line = f"from {module} import {', '.join(names)}"
        if len(line) <= LINE_LENGTH:
            lines.append(line)
        else:
            lines += [f"from {module} import (", *(f"    {name}," for name in names), ")"]
    return lines


@dataclass(frozen=True, slots=True)
class Text:
    """A string argument, ``head`` being its keyword with ``=`` or empty; broken where too long."""

    head: str
    text: str


@dataclass(frozen=True, slots=True)
class Call:
    """A call, or with an empty ``head`` a tuple; where too long, it has one argument a line.

    ``tail`` follows the closing parenthesis: ``.value``.
    """

    head: str
    arguments: tuple[str | Text | Call, ...]
    tail: str = ""


def layout(expression: str | Text | Call, indent: int, trailer: str = "") -> list[str]:
    """Return the lines of an expression that starts in column ``indent``; the first has no blanks.

    ``trailer`` is what follows the expression on its last line, a comma most often.
    """
    line = _on_one_line(expression) + trailer
    if isinstance(expression, str) or indent + len(line) <= LINE_LENGTH:
        return [line]
    margin = " " * (indent + 4)
    if isinstance(expression, Call):
        trailer = expression.tail + trailer
    lines = [f"{expression.head}("]
    if isinstance(expression, Text):
        width = LINE_LENGTH - indent - 8
        pieces = textwrap.wrap(
            expression.text,
            width,
            break_long_words=False,
            break_on_hyphens=False,
            drop_whitespace=False,
        )
        lines += [f"{margin}{piece!r}" for piece in pieces]
    else:
        for argument in expression.arguments:
            inner = layout(argument, indent + 4, ",")
            lines += [margin + inner[0], *inner[1:]]
    return [*lines, " " * indent + ")" + trailer]


def call(
    head: str, arguments: Iterable[str | Text | Call | None], indent: int, end: str = ""
) -> str:
    """Return a call as text for a template that has written ``indent`` blanks already.

    Arguments that are ``None`` are left out.
    """
    given = tuple(argument for argument in arguments if argument is not None)
    return "\n".join(layout(Call(head, given), indent, end))


def expression(value: str | Text | Call, indent: int, end: str = "") -> str:
    """Return any expression as text for a template that has written ``indent`` blanks already."""
    return "\n".join(layout(value, indent, end))


def _on_one_line(expression: str | Text | Call) -> str:
    if isinstance(expression, str):
        return expression
    if isinstance(expression, Text):
        return f"{expression.head}{expression.text!r}"
    return (
        f"{expression.head}({', '.join(map(_on_one_line, expression.arguments))}){expression.tail}"
    )


def wrapped(text: str, indent: int) -> list[str]:
    """Return ``text`` as lines that fit behind ``indent`` columns; long words stay whole."""
    return textwrap.wrap(
        printable_line(text), LINE_LENGTH - indent, break_long_words=False, break_on_hyphens=False
    )


def mark_long_lines(text: str) -> str:
    """Add ``# noqa: E501`` where no wrapping could keep to the line length.

    ROS 2 names may be 255 characters long, and a name cannot be broken.
    """
    lines = text.splitlines()
    if all(len(line) <= LINE_LENGTH for line in lines):
        return text
    first: int | None = None
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        first = token.start[0] if first is None else first
        if token.type not in (tokenize.NL, tokenize.NEWLINE):
            continue
        # Only a string of several lines makes first and last differ; its mark stands behind it.
        last = token.start[0]
        if any(len(line) > LINE_LENGTH for line in lines[first - 1 : last]):
            lines[last - 1] += "  # noqa: E501"
        first = None
    return "\n".join(lines) + "\n"
