"""Write ``docs/evidence-table.md``: each claim of the documentation, with the tests that verify it.

``tests/evidence.toml`` is the one place where a claim names its tests. What a test shows is the
first sentence of its docstring, so the table says it in the words of the test.
"""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ROOT = Path(__file__).resolve().parents[1]
SOURCE = ROOT / "tests/evidence.toml"
PAGE = ROOT / "docs/evidence-table.md"

HEAD = """\
# Evidence table

The tests that verify each claim of [guarantees](guarantees.md) and [evidence](evidence.md), with
what each test shows, in its own words. `pytest` runs a test by its path and name, as in
`pytest tests/faults/test_process.py -k test_latched_stop_survives_kill`.

`python -m tools.evidence_table` writes this page from `tests/evidence.toml`. A test fails where the
page is out of date, a claim has no test, or a test that is named does not exist.

"""

SECTIONS = {
    "guarantees": "Guarantees",
    "safety-node": "What the safety node depends on",
    "gate": "What the gate depends on",
    "evidence": "Claims about deros itself",
}
"""The tables of the source, and their headings on the page."""


def claims(source: Path = SOURCE) -> dict[str, Any]:
    """Read which tests verify which claim: by table, claim, and failure where it has several."""
    read: dict[str, Any] = tomllib.loads(source.read_text(encoding="utf-8"))
    return read


def tests_named(table: Mapping[str, Any]) -> Iterator[str]:
    """Yield the tests of all claims below a table."""
    for value in table.values():
        yield from value if isinstance(value, list) else tests_named(value)


@cache
def tests_in(path: Path) -> dict[str, str]:
    """Return the tests of a file with the first sentences of their docstrings."""
    nodes = ast.walk(ast.parse(path.read_text(encoding="utf-8")))
    functions = (node for node in nodes if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef))
    return {node.name: _first_sentence(node) for node in functions if node.name.startswith("test_")}


def shown_by(test: str, root: Path = ROOT) -> str:
    """Say what a test shows.

    Args:
        test: the path of a folder or of a file, or a test, ``file.py::test_name``.
        root: the folder that paths begin in.

    Raises:
        LookupError: if there is no such test, file or folder.
    """
    name, _, function = test.partition("::")
    path = root / name
    if function:
        found = tests_in(path).get(function) if path.is_file() else None
    elif path.is_dir():
        found = "All tests of the folder"
    else:
        found = (
            _first_sentence(ast.parse(path.read_text(encoding="utf-8"))) if path.is_file() else None
        )
    if found is None:
        raise LookupError(f"{test} does not exist")
    return found


def page() -> str:
    """Return the text of the page.

    Raises:
        LookupError: if a claim names a test that does not exist.
    """
    return HEAD + "\n".join(
        line for key, table in claims().items() for line in _section(SECTIONS[key], table)
    )


def _section(heading: str, table: Mapping[str, Any]) -> Iterator[str]:
    yield from (f"## {heading}", "")
    for claim, tests in table.items():
        yield from (f"### {claim}", "")
        if isinstance(tests, list):
            yield from ("| test | what it shows |", "|---|---|")
            yield from (_row(test) for test in tests)
        else:
            yield from ("| failure | test | what it shows |", "|---|---|---|")
            yield from (f"| {failure} {_row(test)}" for failure in tests for test in tests[failure])
        yield ""


def _row(test: str) -> str:
    path, _, name = test.partition("::")
    where = f"`{name}` in `{path}`" if name else f"`{path}`"
    return f"| {where} | {shown_by(test)} |"


def _first_sentence(node: ast.FunctionDef | ast.AsyncFunctionDef | ast.Module) -> str:
    text = " ".join((ast.get_docstring(node) or "").split("\n\n")[0].split())
    sentence = re.split(r"(?<=[^.]{3})\.(?:\s+(?=[A-Z`])|$)", text)[0].rstrip(".")
    return sentence.replace("``", "`").replace("|", "\\|").replace("<", "&lt;")


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
