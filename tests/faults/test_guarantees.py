"""The documentation page that lists how each guarantee is tested."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs/guarantees.md").read_text(encoding="utf-8")
_TEST = re.compile(r"^def (test_\w+)", re.MULTILINE)
_NAMED = re.compile(r"`(test_\w+)`(?: in `(tests/[\w/.]+)`)?")

TABLES = {
    "## What the safety node depends on": "tests/faults",
    "### What it depends on": "tests/generators/gate/python",
}
"""The headings above the tables, and the folder or file of tests for cells that name none."""

FAILURES = ["wrong data", "duplicated", "stops", "late", "from a foreign node"]


def named_in(path: Path) -> set[str]:
    """Return the names of the tests in a file, or in the files of a folder."""
    files = [path] if path.is_file() else sorted(path.glob("*.py"))
    return {name for file in files for name in _TEST.findall(file.read_text(encoding="utf-8"))}


def rows(heading: str, page: str = PAGE) -> list[list[str]]:
    """Return the cells of the first table below a heading, row by row, without the separator."""
    below = page.partition(f"\n{heading}\n")[2].splitlines()
    first = next(number for number, line in enumerate(below) if line.startswith("|"))
    table = []
    for line in below[first:]:
        if not line.startswith("|"):
            break
        table.append([cell.strip() for cell in line.strip("|").split("|")])
    return [row for row in table if not set(row[0]) <= {"-"}]


def cells_without_test(heading: str, folder: str, page: str = PAGE) -> Iterator[str]:
    """Yield the cells that name no test, or a test that does not exist there."""
    header, *body = rows(heading, page)
    for row in body:
        if len(row) != len(header):
            yield f"{row[0]}: {len(row)} cells, not {len(header)}"
        for column, cell in zip(header[1:], row[1:], strict=False):
            named = _NAMED.findall(cell)
            if not named:
                yield f"{row[0]}, {column}: names no test"
            for name, path in named:
                if name not in named_in(ROOT / (path or folder)):
                    yield f"{row[0]}, {column}: {name} is not in {path or folder}"


@pytest.mark.parametrize("heading", TABLES)
def test_every_cell_names_an_existing_test(heading: str) -> None:
    """Each way to fail of each dependency of a node has a test."""
    assert rows(heading)[0][1:] == FAILURES
    assert len(rows(heading)) > 5
    assert list(cells_without_test(heading, TABLES[heading])) == []


@pytest.mark.parametrize(
    ("cell", "why"),
    [
        ("it is believed", "a, c: names no test"),
        ("", "a, c: names no test"),
        ("well: `test_of_nothing`", "a, c: test_of_nothing is not in tests/faults"),
        (
            "well: `test_killed_node_falls_silent` in `tests/faults/test_gate.py`",
            "a, c: test_killed_node_falls_silent is not in tests/faults/test_gate.py",
        ),
    ],
)
def test_cell_without_a_test_is_detected(cell: str, why: str) -> None:
    """An empty cell, one without a test name, and one whose test does not exist are detected."""
    held = "well: `test_killed_node_falls_silent`"
    page = f"\n## T\n\n| x | b | c |\n|---|---|---|\n| a | {held} | {cell} |\n"
    assert list(cells_without_test("## T", "tests/faults", page)) == [why]


def test_every_named_test_exists() -> None:
    """No guarantee refers to a test that has been renamed or removed."""
    paths = {ROOT / path for path in re.findall(r"`(tests/[\w/.]+)`", PAGE)}
    assert paths
    assert all(path.exists() for path in paths)
    named = set(re.findall(r"`(test_\w+)`", PAGE))
    assert named <= set().union(*map(named_in, paths))


def test_every_fault_test_is_on_the_page() -> None:
    """A fault test that is not on the page would belong to no guarantee."""
    faults = named_in(ROOT / "tests/faults") - named_in(Path(__file__))
    assert sorted(name for name in faults if f"`{name}`" not in PAGE) == []
