"""Each bad model under ``tests/cases`` gives exactly the findings that it declares."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from deros.diagnostics import Diagnostic
from tests.support import cases
from tests.support.cli import deros


def _found(finding: Diagnostic) -> tuple[str, int, int, str, str]:
    """Return where a finding is, whatever the working directory, and what it is."""
    span = finding.span
    place = Path(span.file).name, span.line, span.column
    return *place, finding.severity.value, finding.code.name


def _reported(finding: Mapping[str, Any]) -> tuple[str, int, int, str, str]:
    """Return the same of a finding in the output of the command."""
    place = Path(finding["file"]).name, finding["line"], finding["column"]
    return *place, finding["severity"], finding["code"]


@pytest.mark.parametrize("name", [*cases.all_cases(), *cases.robots()])
def test_case_has_exactly_its_declared_findings(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each expectation matches one finding, and no finding is left over.

    ``deros check`` reports the same findings from any working directory, and exits accordingly.
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
    own = ("--interfaces", cases.DIRECTORY / cases.interfaces(name))
    outcome = deros("check", "--format", "json", *own, cases.DIRECTORY / name)
    assert outcome.code in (0, 1, 2), outcome.err
    reported = json.loads(outcome.out)
    assert Counter(map(_reported, reported)) == Counter(map(_found, findings))
    is_bad = any(finding["severity"] == "error" for finding in reported)
    assert outcome.code >= is_bad, "the exit code hides an error"
    assert "bug in deros" not in outcome.err, outcome.err
