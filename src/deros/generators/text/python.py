"""Small pieces of Python source text: imports, calls, texts, comments; in ament's line length."""

from __future__ import annotations

import io
import tokenize
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from types import CodeType

from deros.generators.text.document import (
    HARDLINE,
    SOFTLINE,
    Document,
    breakable,
    comma_separated,
    concat,
    fill,
    group,
    if_broken,
    join,
    nest,
    render,
    render_lines,
)
from deros.generators.text.prose import pieces, printable_line, wrap

LINE_LENGTH = 99
"""The longest line that ament's flake8 settings allow."""


def import_lines(imports: Mapping[str, Iterable[str]]) -> list[str]:
    """Return one group of import statements in the order of ament's flake8 settings.

    Args:
        imports: the names to import by module; no names stand for ``import module``.
    """
    lines: list[str] = []
    for module in sorted(imports, key=lambda name: (name.lower(), name)):
        names = sorted(set(imports[module]), key=lambda name: (name.lower(), name))
        if not names:
            lines.append(f"import {module}")
            continue
        document = bracketed(f"from {module} import ", if_broken("("), names, if_broken(")"))
        lines += render_lines(document, LINE_LENGTH)
    return lines


def names_in(lines: Iterable[str]) -> frozenset[str]:
    """Return the names and attributes that complete statements use, those in texts left out."""
    names: set[str] = set()
    left = [compile("\n".join(lines), "<generated>", "exec")]  # a third of the time of ast.parse
    while left:
        code = left.pop()
        names.update(code.co_names)
        left += (each for each in code.co_consts if isinstance(each, CodeType))
    return frozenset(names)


# Calls --------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Text:
    """A string argument, broken into several literals where it is too long.

    Attributes:
        head: its keyword with ``=``, or nothing.
        text: the string.
    """

    head: str
    text: str


@dataclass(frozen=True, slots=True)
class Call:
    """A call; where it is too long, it has one argument on each line.

    Attributes:
        head: what is called; of a tuple it is empty.
        arguments: the arguments.
        tail: the text behind the closing bracket, ``.value`` for instance.
        brackets: the opening and the closing one.
    """

    head: str
    arguments: tuple[str | Text | Call, ...]
    tail: str = ""
    brackets: tuple[str, str] = ("(", ")")


def call(
    head: str, arguments: Iterable[str | Text | Call | None], indent: int, end: str = ""
) -> str:
    """Return a call, for a template that has written ``indent`` blanks already.

    Arguments that are ``None`` are left out; ``end`` follows the closing bracket.
    """
    given = tuple(argument for argument in arguments if argument is not None)
    return expression(Call(head, given), indent, end)


def expression(value: str | Text | Call, indent: int, end: str = "") -> str:
    """Return an expression, for a template that has written ``indent`` blanks already."""
    return render(concat(_document(value), end), LINE_LENGTH, indent)


def _document(value: str | Text | Call) -> Document:
    if isinstance(value, str):
        return value
    if isinstance(value, Call):
        arguments = [_document(argument) for argument in value.arguments]
        opening, closing = value.brackets
        return bracketed(value.head, opening, arguments, concat(closing, value.tail))
    return breakable(f"{value.head}{value.text!r}", lambda indent: _literals(value, indent))


def _literals(text: Text, indent: int) -> Document:
    """Return a text as several literals, which Python joins."""
    literals = join(HARDLINE, map(repr, pieces(text.text, LINE_LENGTH - indent - 8)))
    return concat(text.head, "(", nest(4, HARDLINE, literals), HARDLINE, ")")


def bracketed(
    head: str, opening: Document, items: Sequence[Document], closing: Document
) -> Document:
    """Return items in brackets; where they are too long, there is one on each line."""
    inner = nest(4, SOFTLINE, comma_separated(items), _last_comma(items)) if items else ""
    return group(head, opening, inner, SOFTLINE, closing)


def filled(opening: Document, items: Sequence[str], closing: Document) -> Document:
    """Return items in brackets; where they are too long, each line has as many as fit."""
    listed = [*(f"{item}," for item in items[:-1]), *items[-1:]]
    inner = nest(4, SOFTLINE, fill(listed), _last_comma(listed)) if listed else ""
    return group(opening, inner, SOFTLINE, closing)


def tuple_entries(values: Iterable[str]) -> list[str]:
    """Return what is between the brackets of a tuple, where a single value has a comma."""
    listed = list(values)
    return [f"{listed[0]},"] if len(listed) == 1 else listed


def _last_comma(items: Sequence[Document]) -> Document:
    last = items[-1]
    return "" if isinstance(last, str) and last.endswith(",") else if_broken(",")


def lay_out_call(indent: int, before: str, arguments: Sequence[str], after: str = ")") -> list[str]:
    """Return a call in lines that are not too long, each with as many arguments as fit.

    Args:
        indent: the blanks in front of every line.
        before: the text in front of the arguments, which ends with the opening bracket.
        arguments: the arguments.
        after: the text behind them, which begins with the closing bracket.
    """
    return render_lines(filled(before, arguments, after), LINE_LENGTH, indent)


# Prose and long lines -----------------------------------------------------------------------------


def wrapped(text: str, indent: int) -> list[str]:
    """Return ``text`` as lines that fit behind ``indent`` columns; long words stay whole."""
    return wrap(printable_line(text), LINE_LENGTH - indent)


def mark_long_lines(text: str) -> str:
    """Add ``# noqa: E501`` to the lines that are too long.

    They cannot be broken: a name in ROS 2 may have 255 characters.
    """
    lines = text.splitlines()
    if all(len(line) <= LINE_LENGTH for line in lines):
        return text
    first: int | None = None
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        first = token.start[0] if first is None else first
        if token.type not in (tokenize.NL, tokenize.NEWLINE):
            continue
        # First and last differ only for a string of several lines; the mark goes behind its end.
        last = token.start[0]
        if any(len(line) > LINE_LENGTH for line in lines[first - 1 : last]):
            lines[last - 1] += "  # noqa: E501"
        first = None
    return "\n".join(lines) + "\n"
