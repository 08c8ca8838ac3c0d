"""The text of templates in generated text: named where a golden file has it, and not repeated.

Whoever changes a line of a template sees that in the template; a golden file shows what comes out
of its statements, and which of its lines stand between.
"""

from __future__ import annotations

import ast
import functools
import itertools
import re
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

_SOURCE = Path(__file__).resolve().parents[2] / "src/deros"
_FOLDERS = ("generators", "rules/functions")
FEWEST = 3
"""The number of lines in a row that are worth naming; empty ones do not count."""

_STATEMENT = re.compile(r"\s*\{%.*%\}\s*")
_SMALL = {"{{ P }}": "small", "{{ M }}": "SMALL", "@_": "small_", "$_": "SMALL_"}
"""Names in the templates of a monitor in C, and those of the one that golden files show."""


class Template(NamedTuple):
    """The lines of a template, or of a text in a module, without statements."""

    name: str
    lines: Sequence[str]


def shortened(text: str) -> str:
    """Return a text with the name of a template in place of the lines that are from there.

    The empty lines after them count; those before them, and at the end of the text, stay.
    """
    lines, made, at = text.split("\n"), [], 0
    while at < len(lines):
        count, name = _from_template(lines, at) if lines[at] else (0, "")
        count -= at + count == len(lines)
        if sum(map(bool, lines[at : at + count])) >= FEWEST:
            made.append(f"… {count} lines of {name}: {lines[at].strip()}")
        else:
            count = 1
            made.append(lines[at])
        at += count
    return "\n".join(made)


def _from_template(lines: Sequence[str], at: int) -> tuple[int, str]:
    """Return how many lines are from a template, and its name; of several the longest run."""
    found = (0, "")
    for template, start in _places().get(lines[at], ()):
        pairs = zip(lines[at:], template.lines[start:], strict=False)
        count = sum(1 for _ in itertools.takewhile(lambda pair: pair[0] == pair[1], pairs))
        found = max(found, (count, template.name))
    return found


@functools.cache
def _places() -> Mapping[str, Sequence[tuple[Template, int]]]:
    """Return where each line stands in the templates."""
    places: defaultdict[str, list[tuple[Template, int]]] = defaultdict(list)
    for template in _templates():
        for number, line in enumerate(template.lines):
            places[line].append((template, number))
    return dict(places)


def _templates() -> Iterator[Template]:
    for path in sorted(each for folder in _FOLDERS for each in (_SOURCE / folder).rglob("*")):
        if path.suffix in (".j2", ".py"):
            text = path.read_text(encoding="utf-8")
            for each in [text] if path.suffix == ".j2" else _texts(text):
                for old, new in _SMALL.items():
                    each = each.replace(old, new)
                kept = [line for line in each.split("\n") if not _STATEMENT.fullmatch(line)]
                yield Template(path.name, kept)


def _texts(module: str) -> Iterator[str]:
    """Yield the texts in a module that are long enough."""
    for node in ast.walk(ast.parse(module)):
        text = node.value if isinstance(node, ast.Constant) else None
        if isinstance(text, str) and text.count("\n") >= FEWEST:
            yield text
