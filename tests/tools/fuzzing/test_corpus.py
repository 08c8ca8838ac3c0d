"""Minimised former failures of the fuzzer, which must pass now."""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path

import pytest

from tools.fuzzing.findings import CORPUS, Finding, keep, kept, signature
from tools.fuzzing.limits import Limits, limited
from tools.fuzzing.mutants import Mutant
from tools.fuzzing.running import Runner, Wrong

KEPT = sorted(path for path in CORPUS.iterdir() if path.is_dir())


@pytest.mark.parametrize("folder", KEPT, ids=lambda folder: folder.name)
def test_former_failure_passes(tmp_path: Path, folder: Path) -> None:
    """Load, check, generate, simulate or decode: no exception, hang, growth or wrong result.

    The run reaches the recorded stages with exactly the recorded errors: this ensures that it tests
    its subject, instead of being rejected earlier for another mistake.
    """
    expected = json.loads((folder / "mutant.json").read_text(encoding="utf-8"))
    runner, mutant = Runner(tmp_path), kept(folder)
    with limited(Limits()):
        runner.run(mutant)
    assert sorted(runner.ends) == expected["ends"]
    errors = Counter(finding.code.name for finding in runner.findings(mutant) if finding.is_error)
    assert errors == expected["errors"]


def test_saved_mutant_round_trips(tmp_path: Path) -> None:
    """Files, kind and entry are read back from the folder."""
    mutant = Mutant("trace", "p", {"a/b.rnd": b"\xff\0", "trace.jsonl": b"{}"}, "a/b.rnd")
    keep(tmp_path / "one", mutant)
    again = kept(tmp_path / "one")
    assert (again.kind, again.files, again.entry) == (mutant.kind, mutant.files, mutant.entry)


def test_findings_are_identified_by_place_and_kind() -> None:
    """Two exceptions from one place are one finding, whatever names they contain."""
    assert signature(Wrong("'a' is not Python")) == signature(Wrong("'b' is not Python"))
    assert signature(Wrong("one")) != signature(Wrong("another"))
    assert Finding("Wrong: a/b 'c'", "", 0).file_name == "Wrong_a_b_c"
