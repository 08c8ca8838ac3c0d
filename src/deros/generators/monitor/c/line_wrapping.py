"""Lines that names have made too long, broken; what is to be proved is left as it is."""

from __future__ import annotations

import re
import textwrap

from deros.generators.text.c import LINE_LENGTH

_TRAILING_COMMENT = re.compile(r"( *)(\S.*[;{])  (/\*.*\*/)")
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
    words = line[len(first) :]
    further = first.replace("/*", " *")
    return textwrap.wrap(
        words,
        LINE_LENGTH,
        initial_indent=first,
        subsequent_indent=further,
        break_long_words=False,
        break_on_hyphens=False,
    )


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
    return [line]


def _filled(before: str, items: list[str], after: str) -> list[str]:
    """Return what stands before and after items, which are filled into lines between them."""
    blank = " " * (len(before) - len(before.lstrip()))
    indent = f"{blank}  "
    lines = [before, ""]
    closing = [f"{blank}{after}"] if before.endswith("{") else []
    for number, item in enumerate(items):
        *pieces, last = _pieces(item)
        ending = ("" if closing else after) if number == len(items) - 1 else ","
        for piece in (*pieces, f"{last}{ending}"):
            if lines[-1] and len(lines[-1]) + 1 + len(piece) > LINE_LENGTH:
                lines.append("")
            lines[-1] = f"{lines[-1]} {piece}" if lines[-1] else f"{indent}{piece}"
    return [*lines, *closing]


def _pieces(item: str) -> list[str]:
    """Return an item, a text being cut in pieces, which C puts together."""
    if len(item) < LINE_LENGTH - 10 or not item.startswith('"'):
        return [item]
    contents = [each[1] for each in _LITERAL.finditer(item)]
    return [f'"{piece}"' for each in contents for piece in _CHARACTERS.findall(each)]


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
