"""How pieces of the emitted C are laid out: comments that name an origin, and calls in lines."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass

from deros.diagnostics import Span
from deros.generators.text.provenance import origin

MAX_LINE = 99
"""The length that ament's linters allow."""


@dataclass(frozen=True, slots=True)
class Call:
    """A call of a function with expressions; text is an expression without structure."""

    function: str
    arguments: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
class Infix:
    """Expressions joined by an operator, each in parentheses if it has operators of its own."""

    operator: str
    operands: tuple[str, ...]


Expression = Call | Infix | str


def flat(expression: Expression) -> str:
    """Return an expression in one line."""
    if isinstance(expression, str):
        return expression
    if isinstance(expression, Infix):
        return f" {expression.operator} ".join(expression.operands)
    return f"{expression.function}({', '.join(map(flat, expression.arguments))})"


def lay_out(indent: int, before: str, expression: Expression, after: str = ";") -> list[str]:
    """Return ``before`` + expression + ``after`` in lines that are not too long."""
    blank = " " * indent
    line = f"{blank}{before}{flat(expression)}{after}"
    if len(line) <= MAX_LINE or isinstance(expression, str):
        return [line]
    if isinstance(expression, Infix):
        first, *rest = expression.operands
        lines = [f"{blank}{before}{first}"]
        for operand in rest:
            lines[-1] += f" {expression.operator}"
            lines.append(f"{blank}{operand}")
        lines[-1] += after
        return lines
    lines = [f"{blank}{before}{expression.function}("]
    for number, argument in enumerate(expression.arguments):
        last = number == len(expression.arguments) - 1
        lines += lay_out(indent + 2, "", argument, f"){after}" if last else ",")
    return lines


def lay_out_list(indent: int, before: str, items: Sequence[str], after: str) -> list[str]:
    """Return ``before`` + items with commas + ``after``, filled into lines."""
    blank = " " * indent
    line = f"{blank}{before}{', '.join(items)}{after}"
    if len(line) <= MAX_LINE:
        return [line]
    lines = [f"{blank}{before}", f"{blank}  "]
    for number, item in enumerate(items):
        piece = f"{item}{after if number == len(items) - 1 else ','}"
        if len(lines[-1]) + len(piece) + 1 > MAX_LINE:
            lines[-1] = lines[-1].rstrip()
            lines.append(f"{blank}  ")
        lines[-1] += f"{piece} "
    return [line.rstrip() for line in lines]


def lay_out_if(joined: str, tests: Sequence[str], indent: int = 2) -> list[str]:
    """Return the line or lines that open a block where the tests, joined by a word, hold."""
    blank = " " * indent
    line = f"{blank}if ({joined.join(tests)}) {{"
    if len(line) <= MAX_LINE:
        return [line]
    middle = f"{joined.rstrip()}\n{blank}  ".join(tests)
    return [*f"{blank}if ({middle})".splitlines(), f"{blank}{{"]


def comment(indent: int, title: str, span: Span, text: str | None = None) -> list[str]:
    """Return the comment above a block: its title, its origin and the source's text."""
    blank = " " * indent
    lines = _wrap(f"{title} ({origin(span)})", f"{blank}/* ", f"{blank} * ")
    for line in (span.text if text is None else text).splitlines():
        printable = "".join(c if c.isprintable() else " " for c in line).strip()
        if printable:
            lines += _wrap(_harmless(printable), f"{blank} *   ", f"{blank} *     ")
    if len(lines) == 1 and len(lines[0]) <= MAX_LINE - 3:
        return [f"{lines[0]} */"]
    return [*lines, f"{blank} */"]


def _harmless(text: str) -> str:
    """Return a text that neither ends a comment, begins one, nor continues its line."""
    return text.replace("*/", "* /").replace("/*", "/ *").replace("//", "/ /").replace("??", "? ?")


def _wrap(text: str, first: str, further: str) -> list[str]:
    return textwrap.wrap(text, MAX_LINE - 1, initial_indent=first, subsequent_indent=further)
