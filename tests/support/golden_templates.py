"""Lines of generated text that stand elsewhere: golden files name them, and do not repeat them.

Whoever changes a line of a template sees that in the template; a golden file shows what comes out
of its statements, and which of its lines stand between. What several golden files have, the first
one shows.
"""

from __future__ import annotations

import ast
import functools
import itertools
import re
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

_SOURCE = Path(__file__).resolve().parents[2] / "src/deros"
_FOLDERS = ("generators", "rules/functions")
FEWEST = 3
"""The number of lines in a row that are worth naming; empty ones do not count."""
FEWEST_REPEATED = 8
"""The same of lines that another golden file has: fewer are read more easily than looked up."""

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

    def found(lines: Sequence[str], at: int) -> tuple[int, str]:
        runs = [
            (_alike(lines, at, template.lines, start), f"of {template.name}")
            for template, start in _places().get(lines[at], ())
        ]
        return max(runs, default=(0, ""))

    return _named(text, found, lambda _: None, FEWEST)


def unrepeated(texts: Mapping[str, str]) -> dict[str, str]:
    """Return texts, in their order, with a reference in place of lines that stand before them."""
    places: defaultdict[str, list[tuple[str, int]]] = defaultdict(list)
    whole = {path: text.split("\n") for path, text in texts.items()}
    made = {}
    for path, text in texts.items():

        def found(lines: Sequence[str], at: int, path: str = path) -> tuple[int, str]:
            runs = [
                (min(count, at - start) if there == path else count, there)
                for there, start in places[lines[at]]
                for count in [_alike(lines, at, whole[there], start)]
            ]
            count, there = max(runs, default=(0, ""), key=lambda run: run[0])
            return count, "as above" if there == path else f"as in {there.rpartition('/')[2]}"

        def passed(at: int, path: str = path) -> None:
            places[whole[path][at]].append((path, at))

        made[path] = _named(text, found, passed, FEWEST_REPEATED)
    return made


def _named(
    text: str,
    found: Callable[[Sequence[str], int], tuple[int, str]],
    passed: Callable[[int], None],
    fewest: int,
) -> str:
    """Return a text with what is said of lines in place of those that are found elsewhere.

    Args:
        text: the text.
        found: returns how many lines from one on are elsewhere, and what is said of them.
        passed: is told the number of each line that is done.
        fewest: how many lines are named together at least.
    """
    lines, made, at = text.split("\n"), [], 0
    while at < len(lines):
        is_named = not lines[at] or lines[at].startswith("…")
        count, said = (0, "") if is_named else found(lines, at)
        count -= at + count == len(lines)
        if sum(map(bool, lines[at : at + count])) >= fewest:
            made.append(f"… {count} lines {said}: {lines[at].strip()}")
        else:
            count = 1
            made.append(lines[at])
        for number in range(at, at + count):
            passed(number)
        at += count
    return "\n".join(made)


def _alike(lines: Sequence[str], at: int, others: Sequence[str], start: int) -> int:
    """Return how many lines from one on are those of others, from another one on."""
    pairs = zip(
        itertools.islice(lines, at, None), itertools.islice(others, start, None), strict=False
    )
    return sum(1 for _ in itertools.takewhile(lambda pair: pair[0] == pair[1], pairs))


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
