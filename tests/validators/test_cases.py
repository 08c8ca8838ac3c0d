"""Each bad model under ``tests/cases`` gives exactly the findings that it declares."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from deros.codes import ALL_CODES, OF_MODELS
from deros.diagnostics import Code
from deros.validators.allowances import ABOUT_ALLOWANCES
from tests.support import cases

ROOT = Path(__file__).resolve().parents[2]
HEADINGS = ["What it does", "Why it is bad", "Example", "Use instead"]


@pytest.mark.parametrize("name", cases.all_cases())
def test_case_has_exactly_its_declared_findings(name: str) -> None:
    """Each expectation matches one finding, and no finding is left over."""
    findings, files = cases.run(name)
    left = list(findings)
    missing = []
    for expected in (e for file in files for e in cases.expectations(file)):
        match = next((finding for finding in left if expected.met_by(finding)), None)
        if match is None:
            missing.append(expected)
        else:
            left.remove(match)
    surprising = [f"{d.span.file}:{d.span.line}: {d.code.name} {cases.words(d)}" for d in left]
    assert (missing, surprising) == ([], [])


@pytest.mark.parametrize("code", ALL_CODES)
def test_every_code_has_a_case(code: str) -> None:
    """Each code is expected by a case, or named in a test if no model alone can cause it."""
    about_models = ALL_CODES[code] in OF_MODELS or ALL_CODES[code] in ABOUT_ALLOWANCES
    if not about_models or code == "DRS008":  # needs a file of 4 MB
        tests = (ROOT / "tests").rglob("test_*.py")
        name = next(n for n, c in _constants().items() if c == code)
        assert any(re.search(rf"\b({code}|{name})\b", test.read_text()) for test in tests)
        return
    files = [
        *cases.all_cases(),
        *(f"support/{p.name}" for p in (cases.DIRECTORY / "support").iterdir() if p.is_file()),
    ]
    assert any(code == expected.code for file in files for expected in cases.expectations(file))


def _constants() -> dict[str, str]:
    import deros.codes

    return {n: c.name for n, c in vars(deros.codes).items() if isinstance(c, Code)}


@pytest.mark.parametrize("code", ALL_CODES)
def test_every_code_has_a_page(code: str) -> None:
    """The page has title and slug of the code and all four sections."""
    text = (ROOT / "docs" / "diagnostics" / f"{code}.md").read_text(encoding="utf-8")
    start = f"# {code}: {ALL_CODES[code].title}\n\n`{ALL_CODES[code].slug}`, a"
    assert text.startswith(start)
    assert re.findall(r"^## (.*)$", text, re.MULTILINE) == HEADINGS
    sections = re.split(r"^## .*$", text, flags=re.MULTILINE)[1:]
    assert all(len(section.strip()) > 20 for section in sections)


def test_index_lists_all_codes() -> None:
    """The index lists code, slug, title and severity of each diagnostic once, in order."""
    text = (ROOT / "docs" / "diagnostics" / "index.md").read_text(encoding="utf-8")
    listed = re.findall(
        r"^\| \[(DRS\d+)\]\(\1\.md\) \| `(.*?)` \| (.*?) \| (\w+) \|$", text, re.MULTILINE
    )
    assert listed == [(c.name, c.slug, c.title, c.severity.value) for c in ALL_CODES.values()]
