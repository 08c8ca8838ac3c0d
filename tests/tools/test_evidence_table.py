"""The evidence table: each claim of the documentation names tests, and they exist."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tools import evidence_table
from tools.evidence_table import ROOT

GUARANTEES = (ROOT / "docs/guarantees.md").read_text(encoding="utf-8")
EVIDENCE = (ROOT / "docs/evidence.md").read_text(encoding="utf-8")
TABLES = {
    "safety-node": "## What the safety node depends on",
    "gate": "### What it depends on",
}
FAILURES = ["wrong data", "duplicated", "stops", "late", "from a foreign node"]


def _rows(heading: str, page: str) -> list[list[str]]:
    """Return the cells of the first table below a heading, without the separator."""
    below = page.partition(f"\n{heading}\n")[2]
    table = re.search(r"^\|.*?(?=^[^|]|\Z)", below, re.MULTILINE | re.DOTALL)
    assert table is not None, heading
    lines = [line.strip().strip("|") for line in table[0].splitlines() if line.strip()]
    rows = [[cell.strip() for cell in line.split("|")] for line in lines]
    return [row for row in rows if not set(row[0]) <= {"-"}]


def _anchor(heading: str) -> str:
    return re.sub(r" ", "-", re.sub(r"[^\w\- ]", "", heading.lower()))


@pytest.mark.essential
def test_page_is_what_the_source_says() -> None:
    """Each named test exists, and the table says of it what its docstring says today."""
    written = evidence_table.PAGE.read_text(encoding="utf-8")
    assert written == evidence_table.page(), "run: python -m tools.evidence_table"


@pytest.mark.parametrize("key", TABLES)
def test_every_cell_has_a_test(key: str) -> None:
    """Each way to fail of each dependency of a node has a test, and no other way is listed."""
    header, *body = _rows(TABLES[key], GUARANTEES)
    assert header[1:] == FAILURES
    assert len(body) > 5
    assert all(len(row) == len(header) and all(row) for row in body)
    named = evidence_table.claims()[key]
    assert [row[0] for row in body] == [*named]
    for failures in named.values():
        assert [*failures] == FAILURES
        assert all(failures.values())


def test_every_guarantee_leads_to_its_tests() -> None:
    """Each link behind a guarantee is that of its heading, and each entry has such a link."""
    linked = re.findall(r"evidence-table\.md#([\w-]+)", GUARANTEES)
    named = evidence_table.claims()["guarantees"]
    headings = {_anchor(each) for each in evidence_table.SECTIONS.values()}
    assert set(linked) - headings == {_anchor(each) for each in named}
    assert all(named.values())
    sections = re.split(r"^#{2,3} (.*)$", GUARANTEES, flags=re.MULTILINE)
    for heading, text in zip(sections[1::2], sections[2::2], strict=True):
        if "* *Limits.*" in text:
            assert f"(evidence-table.md#{_anchor(heading)})" in text, heading


def test_every_claim_of_the_evidence_page_names_tests() -> None:
    """The claims are those of the page, in its order."""
    claimed = [row[0] for row in _rows("# Evidence", f"\n{EVIDENCE}")[1:]]
    plain = [re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", claim) for claim in claimed]
    named = evidence_table.claims()["evidence"]
    assert plain == [*named]
    assert all(named.values())


def test_pages_leave_the_names_of_tests_to_the_table() -> None:
    """There is one place to change when a test is renamed."""
    assert re.findall(r"\btest_\w+", GUARANTEES + EVIDENCE) == []


def test_every_fault_test_is_in_the_table() -> None:
    """A fault test that is not in it would belong to no guarantee."""
    named = {*evidence_table.tests_named(evidence_table.claims())}
    faults = {
        f"tests/faults/{path.name}::{name}"
        for path in (ROOT / "tests/faults").glob("*.py")
        for name in evidence_table.tests_in(path)
    }
    whole = {each for each in faults if each.partition("::")[0] in named}
    assert faults - whole - named == set()


@pytest.mark.parametrize(
    ("test", "shown"),
    [
        ("tests", "All tests of the folder"),
        ("tests/test_a.py", "Some tests of `a`"),
        ("tests/test_a.py::test_one", "One \\| two, e.g. this, is shown"),
    ],
)
def test_words_of_a_test_are_its_first_sentence(tmp_path: Path, test: str, shown: str) -> None:
    """Marks of reStructuredText and what would end a cell are rewritten."""
    _write(tmp_path)
    assert evidence_table.shown_by(test, tmp_path) == shown


@pytest.mark.parametrize(
    "test",
    [
        "tests/test_a.py::test_two",
        "tests/test_b.py",
        "tests/test_b.py::test_one",
        "tests::test_one",
    ],
)
def test_test_that_does_not_exist_is_refused(tmp_path: Path, test: str) -> None:
    """One that has been renamed or removed, alone or with its file."""
    _write(tmp_path)
    with pytest.raises(LookupError, match=f"{test} does not exist"):
        evidence_table.shown_by(test, tmp_path)


def _write(root: Path) -> None:
    (root / "tests").mkdir()
    (root / "tests/test_a.py").write_text(
        '"""Some tests of ``a``."""\n\n\ndef test_one() -> None:\n'
        '    """One | two, e.g. this, is shown. Not that."""\n',
        encoding="utf-8",
    )
