"""Each bad model under ``tests/cases`` gives exactly the findings that it declares."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.support import cases
from tests.support.cli import deros


@pytest.mark.parametrize("name", [*cases.all_cases(), *cases.robots()])
def test_case_has_exactly_its_declared_findings(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each expectation matches one finding, and no finding is left over.

    ``deros check`` exits accordingly, from any working directory.
    """
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
    monkeypatch.chdir(tmp_path)
    outcome = deros("check", "--format", "json", cases.DIRECTORY / name)
    assert outcome.code in (0, 1, 2), outcome.err
    is_bad = any(finding["severity"] == "error" for finding in json.loads(outcome.out))
    assert outcome.code >= is_bad, "the exit code hides an error"
    assert "bug in deros" not in outcome.err, outcome.err
