"""Lines that names have made too long, broken; what is to be proved is left as it is."""

from __future__ import annotations

import re

from deros.generators.text.c import LINE_LENGTH
from deros.generators.text.document import HARDLINE, concat, fill, nest, render_lines
from deros.generators.text.prose import paragraph

_TRAILING_COMMENT = re.compile(r"( *)(\S.*[;{])  (/\*.*\*/)")
_OPERATOR = re.compile(r" (?=(?:[?:]|&&|\|\||[-+*/]) )")
_LITERAL = re.compile(r'"((?:\\.|[^"\\])*)"')
_CHARACTERS = re.compile(r"(?:\\[0-7]{3}|\\.|[^\\]){1,80}")


def wrap_long_lines(text: str) -> str:
    """Return a text of C in which no line is too long, if its names let it be broken."""
    lines: list[str] = []
    to_prove = within = False
    for line in text.splitlines():
        begins = line.lstrip().startswith("/*")
        to_prove = line.lstrip().startswith("/*@") if begins else to_prove
        within = within or begins
        if len(line) <= LINE_LENGTH or (within and to_prove):
            lines.append(line)
        else:
            lines += _comment(line) if within else _code(line)
        within = within and "*/" not in line
    return "\n".join(lines) + "\n"


def _comment(line: str) -> list[str]:
    opening = re.match(r" *(?:/\*| \*) *", line)
    first = opening.group() if opening else ""
    document = paragraph(line[len(first) :], first, first.replace("/*", " *"))
    return render_lines(document, LINE_LENGTH)


def _code(line: str) -> list[str]:
    commented = _TRAILING_COMMENT.fullmatch(line)
    if commented:
        indent, code, comment = commented.groups()
        return [
            *wrap_long_lines(f"{indent}{comment}").splitlines(),
            *wrap_long_lines(indent + code).splitlines(),
        ]
    for start in (each.end() for each in re.finditer(r"[({]", line)):
        end, items = _items(line, start)
        if len(items) > 1:
            return _filled(line[:start], items, line[end:])
    if '"' not in line:
        blank = " " * (len(line) - len(line.lstrip()))
        parts = _OPERATOR.split(line.lstrip())
        return render_lines(concat(blank, nest(f"{blank}  ", fill(parts))), LINE_LENGTH)
    return [line]


def _filled(before: str, items: list[str], after: str) -> list[str]:
    """Return the lines of ``before``, items that fill lines, and ``after``."""
    blank = " " * (len(before) - len(before.lstrip()))
    last = len(items) - 1
    texts = [
        f"{piece}{',' if is_last and number < last else ''}"
        for number, item in enumerate(items)
        for piece, is_last in _pieces(item)
    ]
    is_closed_below = before.endswith("{")
    inner = nest(2, HARDLINE, fill(texts), "" if is_closed_below else after)
    document = concat(
        before, nest(blank, inner, concat(HARDLINE, after) if is_closed_below else "")
    )
    return render_lines(document, LINE_LENGTH)


def _pieces(item: str) -> list[tuple[str, bool]]:
    """Return an item, a long text in pieces, which C joins; and whether each is the last one."""
    if len(item) < LINE_LENGTH - 10 or not item.startswith('"'):
        return [(item, True)]
    contents = [literal[1] for literal in _LITERAL.finditer(item)]
    *pieces, last = [f'"{piece}"' for text in contents for piece in _CHARACTERS.findall(text)]
    return [*((piece, False) for piece in pieces), (last, True)]


def _items(line: str, start: int) -> tuple[int, list[str]]:
    """Return where the bracket closes that opens before ``start``, and what commas part in it."""
    depth, items, place = 0, [start], start
    while place < len(line) and depth >= 0:
        literal = _LITERAL.match(line, place)
        if literal:
            place = literal.end()
            continue
        depth += {"(": 1, "{": 1, ")": -1, "}": -1}.get(line[place], 0)
        if line[place] == "," and depth == 0:
            items.append(place + 1)
        place += 1
    end = place - 1
    ends = [*(each - 1 for each in items[1:]), end]
    return end, [line[a:b].strip() for a, b in zip(items, ends, strict=True)]
