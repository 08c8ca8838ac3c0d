"""Small pieces of C source text: expressions, conditions, and comments that name an origin."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from deros.diagnostics import Span
from deros.generators.text.document import (
    LINE,
    SOFTLINE,
    Document,
    Line,
    comma_separated,
    concat,
    fill,
    flatten,
    group,
    join,
    nest,
    render_lines,
)
from deros.generators.text.prose import paragraph
from deros.generators.text.provenance import origin

LINE_LENGTH = 99
"""The longest line that ament's linters allow."""


@dataclass(frozen=True, slots=True)
class Call:
    """A call of a function; an expression without structure is a string."""

    function: str
    arguments: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
class Infix:
    """Operands joined by an operator, each in brackets if it has operators of its own."""

    operator: str
    operands: tuple[str, ...]


Expression = Call | Infix | str


def flat(expression: Expression) -> str:
    """Return an expression on one line."""
    return flatten(_document(expression))


def _document(expression: Expression) -> Document:
    if isinstance(expression, str):
        return expression
    if isinstance(expression, Infix):
        return group(join(concat(" ", expression.operator, LINE), expression.operands))
    arguments = comma_separated(map(_document, expression.arguments))
    return group(expression.function, "(", nest(2, SOFTLINE, arguments), ")")


def lay_out(indent: int, before: str, expression: Expression, after: str = ";") -> list[str]:
    """Return ``before`` + expression + ``after`` in lines that are not too long."""
    document = concat(before, _document(expression), after)
    return render_lines(document, LINE_LENGTH, indent)


def lay_out_list(indent: int, before: str, items: Sequence[str], after: str) -> list[str]:
    """Return ``before`` + items with commas + ``after``, each line with as many items as fit."""
    listed = fill([*(f"{item}," for item in items[:-1]), *items[-1:]])
    return render_lines(group(before, nest(2, SOFTLINE, listed), after), LINE_LENGTH, indent)


def lay_out_if(
    joint: str, tests: Sequence[str], indent: int = 2, width: int = LINE_LENGTH
) -> list[str]:
    """Return the line or lines that open a block, as uncrustify asks for them.

    Args:
        joint: the operator between the tests.
        tests: the operands of the condition.
        indent: the blanks in front of every line.
        width: the length that no line should exceed.
    """
    operands = nest(2, join(concat(" ", joint.strip(), LINE), tests))
    return render_lines(group("if (", operands, ")", LINE, "{"), width, indent)


def comment(indent: int, title: str, span: Span, text: str | None = None) -> list[str]:
    """Return the comment above a block: its title, its origin and the text of the source."""
    longest = LINE_LENGTH - indent - len(" *     ")
    head = paragraph(f"{title} ({origin(span)})", "/* ", " * ", longest)
    further = Line(None, after=" *   ")
    lines: list[Document] = []
    for line in (span.text if text is None else text).splitlines():
        printable = "".join(c if c.isprintable() else " " for c in line).strip()
        if printable:
            lines += [further, paragraph(harmless(printable), "", " *     ", longest)]
    document = group(head, *lines, Line(" ", after=" "), "*/")
    return render_lines(document, LINE_LENGTH, indent)


def harmless(text: str) -> str:
    """Return a text that neither ends a comment, begins one, nor continues its line."""
    return text.replace("*/", "* /").replace("/*", "/ *").replace("//", "/ /").replace("??", "? ?")
