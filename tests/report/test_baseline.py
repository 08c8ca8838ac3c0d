"""``deros check --baseline``: only new findings are reported, and absent ones are noted."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import pytest

from deros import codes
from tests.support.cli import deros

UNUSED = "system Lone\ntopics\n  topic /a\n  topic /b\n"
FILE = "baseline.json"


@pytest.fixture(autouse=True)
def _in_own_directory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("lone.system").write_text(UNUSED)


def _write(*files: str) -> None:
    outcome = deros("check", *files, "--baseline", FILE, "--write-baseline")
    assert outcome.code == 0, outcome


def _found(*more: str, files: tuple[str, ...] = ("lone.system",)) -> list[tuple[str, int]]:
    outcome = deros("check", *files, "--baseline", FILE, "--format", "json", *more)
    return [(d["code"], d["line"]) for d in json.loads(outcome.out)]


def test_findings_in_the_baseline_are_not_reported() -> None:
    """The summary counts the known findings."""
    assert deros("check", "--strict", "lone.system").code == 1
    _write("lone.system")
    outcome = deros("check", "--strict", "lone.system", "--baseline", FILE)
    assert outcome.code == 0
    assert outcome.out == "1 file checked, no findings, 2 in the baseline\n"


def test_findings_are_recognised_when_lines_move() -> None:
    """New lines and spaces around a finding do not matter."""
    _write("lone.system")
    Path("lone.system").write_text("// new\n\nsystem Lone\ntopics\n     topic /b\n\n topic /a\n")
    assert _found() == []


def test_new_finding_is_reported() -> None:
    """A finding is new even if the baseline has its code in the same file."""
    _write("lone.system")
    Path("lone.system").write_text(UNUSED + "  topic /c\n")
    assert _found() == [("DRS212", 5)]
    assert _found("--strict") == [("DRS212", 5)]


def test_additional_equal_finding_is_new() -> None:
    """Equal findings are counted: of three, if two were listed, one is new."""
    rules = "const a = 1  /* deros: allow */\n"
    Path("r.deros").write_text(rules * 2)
    before = json.loads(deros("check", "--format", "json", "r.deros").out)
    equal = [d for d in before if d["code"] == "DRS020"]
    assert len(equal) == 2
    Path("r.deros").write_text("const a = 1  /* deros: allow */\n/* deros: allow */\n")
    _write("r.deros")
    Path("r.deros").write_text("const a = 1  /* deros: allow */\n" + "/* deros: allow */\n" * 2)
    assert _found(files=("r.deros",)) == [("DRS020", 3)]


def test_errors_are_always_reported() -> None:
    """An error is not written to the baseline."""
    Path("bad.rnd").write_text("node bad : demo\nparameters\n  name a : int = 0.5\n")
    outcome = deros("check", "bad.rnd", "--baseline", FILE, "--write-baseline")
    assert outcome.code == 1
    assert json.loads(Path(FILE).read_text())["findings"] == []
    assert _found(files=("bad.rnd",)) == [("DRS103", 3)]


def test_absent_finding_is_a_note() -> None:
    """It points into the baseline, and does not fail the run."""
    _write("lone.system")
    Path("lone.system").write_text("system Lone\ntopics\n  topic /b\n")
    outcome = deros("check", "--strict", "lone.system", "--baseline", FILE)
    assert outcome.code == 0
    assert f"{FILE}:" in outcome.out
    assert codes.ABSENT_FINDING.name in outcome.out
    assert "lone.system: DRS212 no longer occurs" in outcome.out
    _write("lone.system")
    assert _found() == []


def test_entry_may_have_the_slug_as_its_code() -> None:
    """A slug in place of the code is read like the code, and both are written."""
    _write("lone.system")
    written = json.loads(Path(FILE).read_text())
    assert {(each["code"], each["slug"]) for each in written["findings"]} == {
        ("DRS212", "unused-topic")
    }
    Path(FILE).write_text(Path(FILE).read_text().replace("DRS212", "unused-topic"))
    assert _found() == []
    Path("lone.system").write_text("system Lone\ntopics\n  topic /b\n")
    outcome = deros("check", "lone.system", "--baseline", FILE)
    assert "lone.system: DRS212 no longer occurs" in outcome.out


def test_absent_entry_with_an_unknown_code_gets_suggestions() -> None:
    """A mistyped slug is named, with the nearest one."""
    _write("lone.system")
    text = Path(FILE).read_text()
    Path(FILE).write_text(text.replace('"code": "DRS212"', '"code": "unused-topik"'))
    Path("lone.system").write_text("system Lone\ntopics\n  topic /b\n")
    outcome = deros("check", "lone.system", "--baseline", FILE)
    assert "there is no diagnostic 'unused-topik': did you mean 'unused-topic'" in outcome.out, (
        outcome.out
    )


def test_unchecked_entries_are_not_called_absent() -> None:
    """With fewer files than in the baseline, or after an error, an entry may still apply."""
    Path("other.system").write_text(UNUSED)
    _write("lone.system", "other.system")
    assert _found(files=("other.system",)) == []
    Path("lone.system").write_text('system Lone\nimports import "nowhere.rnd"\n')
    assert _found(files=("lone.system", "other.system")) == [("DRS201", 2)]
    Path("lone.system").unlink()
    assert _found(files=("other.system",)) == [("DRS023", 13), ("DRS023", 20)]


def test_baseline_is_independent_of_the_working_directory(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its paths are relative to its own folder, so that it can be committed."""
    _write("lone.system")
    assert str(tmp_path) not in Path(FILE).read_text()
    (tmp_path / "sub").mkdir()
    monkeypatch.chdir(tmp_path / "sub")
    outcome = deros("check", "--strict", "../lone.system", "--baseline", f"../{FILE}")
    assert outcome.code == 0


def test_baseline_is_deterministic() -> None:
    """Writing the same findings again gives the same bytes."""
    _write("lone.system")
    first = Path(FILE).read_bytes()
    _write("lone.system")
    assert Path(FILE).read_bytes() == first


@pytest.mark.parametrize(
    "text",
    [
        None,
        "",
        "{",
        "[]",
        '{"kind": "deros baseline"}',
        '{"kind": "deros baseline", "version": 2}',
        '{"kind": "deros baseline", "version": 1, "checked": [], "findings": [1]}',
        UNUSED,
        "[" * 100_000,
    ],
)
def test_invalid_baseline_is_an_error(text: str | None) -> None:
    """All findings are reported, and the exit code is 2."""
    if text is not None:
        Path(FILE).write_text(text)
    outcome = deros("check", "lone.system", "--baseline", FILE)
    assert outcome.code == 2
    assert codes.UNUSABLE_BASELINE.name in outcome.out
    assert outcome.out.count("DRS212") == 2


def test_other_file_is_never_overwritten() -> None:
    """A wrong command line cannot overwrite a model."""
    outcome = deros("check", "lone.system", "--baseline", "lone.system", "--write-baseline")
    assert outcome.code == 2
    assert Path("lone.system").read_text() == UNUSED


def test_write_baseline_needs_a_file() -> None:
    """``--write-baseline`` alone is a usage error."""
    assert deros("check", "lone.system", "--write-baseline").code == 2


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_unwritable_folder_is_an_error() -> None:
    """The exit code is 2."""
    Path("closed").mkdir(mode=0o500)
    outcome = deros("check", "lone.system", "--baseline", "closed/b.json", "--write-baseline")
    assert outcome.code == 2


def _sarif(*more: str) -> list[dict[str, Any]]:
    log = json.loads(deros("check", "lone.system", "--format", "sarif", *more).out)
    results: list[dict[str, Any]] = log["runs"][0]["results"]
    return results


def test_sarif_distinguishes_new_known_and_absent_findings() -> None:
    """``baselineState`` follows SARIF 2.1.0, 3.27.24; fingerprints are stable when lines move."""
    plain = _sarif()
    assert "baselineState" not in plain[0]
    _write("lone.system")
    Path("lone.system").write_text("\nsystem Lone\ntopics\n  topic /b\n  topic /c\n")
    results = _sarif("--baseline", FILE)
    states = [(r["baselineState"], r["message"]["text"].split("'")[1]) for r in results]
    assert states == [("unchanged", "/b"), ("new", "/c"), ("absent", "/a")]
    assert results[0]["partialFingerprints"] == plain[1]["partialFingerprints"]
    assert results[2]["partialFingerprints"] == plain[0]["partialFingerprints"]


def test_allowed_findings_are_not_in_the_baseline() -> None:
    """An allowed finding needs no entry."""
    Path("lone.system").write_text(UNUSED.replace("/a", "/a  // deros: allow DRS212 by hand"))
    _write("lone.system")
    assert [e["message"].split("'")[1] for e in json.loads(Path(FILE).read_text())["findings"]] == [
        "/b"
    ]
