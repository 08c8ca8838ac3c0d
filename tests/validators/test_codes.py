"""Each diagnostic code has a case or a test, a page, and the properties of its kind."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

import pytest

from deros import codes
from deros.codes import ALL_CODES, OF_MODELS
from deros.diagnostics import Code, Severity, SourceFile, Span
from deros.validators.findings.allowances import ABOUT_ALLOWANCES, allowable
from tests.support import cases
from tests.support.cli import deros

ROOT = Path(__file__).resolve().parents[2]
HEADINGS = ["What it does", "Why it is bad", "Example", "Use instead"]
CONSTANTS = {each.name: name for name, each in vars(codes).items() if isinstance(each, Code)}


@cache
def _expected_in_cases() -> frozenset[str]:
    names = ("support", "support/parameters", "support/launch", "support/below")
    folders = (cases.DIRECTORY / name for name in names)
    found = (each for folder in folders for each in folder.iterdir() if each.is_file())
    support = [each.relative_to(cases.DIRECTORY).as_posix() for each in found]
    files = [*cases.all_cases(), *support]
    return frozenset(each.code for file in files for each in cases.expectations(file))


@cache
def _words_of_tests() -> frozenset[str]:
    texts = [path.read_text() for path in (ROOT / "tests").rglob("test_*.py")]
    return frozenset(word for text in texts for word in re.findall(r"\w+", text))


@pytest.mark.parametrize("code", ALL_CODES.values(), ids=str)
def test_code_is_tested_documented_and_explained(code: Code) -> None:
    """A case or a test expects it; it has its page; only warnings about models are allowable."""
    if (code in OF_MODELS or code in ABOUT_ALLOWANCES) and code.name != "DRS008":  # needs 4 MB
        assert code.name in _expected_in_cases(), "no case expects it"
    else:
        assert {code.name, CONSTANTS[code.name]} & _words_of_tests(), "no test names it"

    text = (ROOT / "docs" / "diagnostics" / f"{code.name}.md").read_text(encoding="utf-8")
    assert text.startswith(f"# {code.name}: {code.title}\n\n`{code.slug}`, a"), (
        "its page begins wrongly"
    )
    assert re.findall(r"^## (.*)$", text, re.MULTILINE) == HEADINGS, "its page has other sections"
    sections = re.split(r"^## .*$", text, flags=re.MULTILINE)[1:]
    assert all(len(each.strip()) > 20 for each in sections), "a section of its page is empty"
    explained = deros("explain", code.name).out
    assert explained.startswith(f"# {code.name}: {code.title}\n"), (
        "'deros explain' has no page of it"
    )

    is_allowable = allowable(code.name, Span(SourceFile("x.rnd", ""), 0, 0)) is code
    expected = code.severity is not Severity.ERROR and code in OF_MODELS
    assert is_allowable == expected, "it is allowable although it should not be, or the reverse"


def test_index_lists_all_codes() -> None:
    """The index lists code, slug, title and severity of each diagnostic once, in order."""
    text = (ROOT / "docs" / "diagnostics" / "index.md").read_text(encoding="utf-8")
    listed = re.findall(
        r"^\| \[(DRS\d+)\]\(\1\.md\) \| `(.*?)` \| (.*?) \| (\w+) \|$", text, re.MULTILINE
    )
    assert listed == [(c.name, c.slug, c.title, c.severity.value) for c in ALL_CODES.values()]
