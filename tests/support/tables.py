"""Tables in Markdown under ``tests/data``, each row of which is a case."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

DATA = Path(__file__).resolve().parents[1] / "data"


def rows(name: str) -> Iterator[dict[str, str]]:
    r"""Yield the rows of all tables of ``tests/data/NAME.md``, by the names of their columns.

    In a cell, ``\|`` is a bar and ``\n`` the end of a line; code stands between backticks.

    Raises:
        ValueError: a row has more or fewer cells than its table has columns.
    """
    columns: list[str] = []
    for line in (DATA / f"{name}.md").read_text(encoding="utf-8").splitlines():
        if not line.startswith("|"):
            columns = []
        elif not columns:
            columns = _cells(line)
        elif set(line) != {"|", "-"}:
            yield dict(zip(columns, _cells(line), strict=True))


def _cells(line: str) -> list[str]:
    cells = (each.strip() for each in re.split(r"(?<!\\)\|", line)[1:-1])
    bare = (re.sub(r"^`` ?(.*?) ?``$|^`(.*)`$", r"\1\2", each) for each in cells)
    return [each.replace(r"\|", "|").replace(r"\n", "\n") for each in bare]
