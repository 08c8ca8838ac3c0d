"""Tables in Markdown under ``tests/data``, each row of which is a case."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

DATA = Path(__file__).resolve().parents[1] / "data"


def rows(name: str, heading: str = "") -> Iterator[dict[str, str]]:
    r"""Yield the rows of the tables of ``tests/data/NAME.md``, by the names of their columns.

    In a cell, ``\|`` is a bar and ``\n`` the end of a line; code stands between backticks, and
    between spaces if it begins or ends with one.

    Args:
        name: of the file.
        heading: that of level 2 above the tables; any if empty.

    Raises:
        ValueError: a row has more or fewer cells than its table has columns.
    """
    columns: list[str] = []
    above = ""
    for line in (DATA / f"{name}.md").read_text(encoding="utf-8").splitlines():
        if line.startswith("## "):
            above = line.removeprefix("## ")
        if not line.startswith("|"):
            columns = []
        elif not columns:
            columns = _cells(line)
        elif set(line) != {"|", "-"} and heading in ("", above):
            yield dict(zip(columns, _cells(line), strict=True))


def _cells(line: str) -> list[str]:
    return [_text(each.strip()) for each in re.split(r"(?<!\\)\|", line)[1:-1]]


def _text(cell: str) -> str:
    code = re.fullmatch(r"`( ?)(.*)\1`", cell)
    text = code[2] if code else cell
    return text.replace(r"\|", "|").replace(r"\n", "\n")
