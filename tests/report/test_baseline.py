"""``deros check --baseline``: only what is new is reported, and what is gone is said."""

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


def test_what_is_listed_is_not_reported() -> None:
    """The findings at the time of writing are known; the last line counts them."""
    assert deros("check", "--strict", "lone.system").code == 1
    _write("lone.system")
    outcome = deros("check", "--strict", "lone.system", "--baseline", FILE)
    assert outcome.code == 0
    assert outcome.out == "1 file checked, no findings, 2 in the baseline\n"


def test_findings_are_recognized_when_lines_move() -> None:
    """Lines before, behind and between change nothing, nor do blanks."""
    _write("lone.system")
    Path("lone.system").write_text("// new\n\nsystem Lone\ntopics\n     topic /b\n\n topic /a\n")
    assert _found() == []


def test_a_new_finding_is_reported() -> None:
    """Also one of a code that the baseline has, in the same file."""
    _write("lone.system")
    Path("lone.system").write_text(UNUSED + "  topic /c\n")
    assert _found() == [("DRS212", 5)]
    assert _found("--strict") == [("DRS212", 5)]


def test_one_more_of_equal_findings_is_new() -> None:
    """Equal findings count: of three where two were listed, one is new."""
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
    """An error is not written, and stays one."""
    Path("bad.rnd").write_text("node bad : demo\nparameters\n  name a : int = 0.5\n")
    outcome = deros("check", "bad.rnd", "--baseline", FILE, "--write-baseline")
    assert outcome.code == 1
    assert json.loads(Path(FILE).read_text())["findings"] == []
    assert _found(files=("bad.rnd",)) == [("DRS103", 3)]


def test_an_entry_that_is_gone_is_a_remark() -> None:
    """It points into the baseline, and fails nothing."""
    _write("lone.system")
    Path("lone.system").write_text("system Lone\ntopics\n  topic /b\n")
    outcome = deros("check", "--strict", "lone.system", "--baseline", FILE)
    assert outcome.code == 0
    assert f"{FILE}:" in outcome.out
    assert codes.ABSENT_FINDING.name in outcome.out
    assert "lone.system: DRS212 does not occur any more" in outcome.out
    _write("lone.system")
    assert _found() == []


def test_nothing_is_called_gone_that_was_not_looked_for() -> None:
    """With fewer files than the baseline has, or behind an error, an entry may well be there."""
    Path("other.system").write_text(UNUSED)
    _write("lone.system", "other.system")
    assert _found(files=("other.system",)) == []
    Path("lone.system").write_text('system Lone\nimports import "nowhere.rnd"\n')
    assert _found(files=("lone.system", "other.system")) == [("DRS201", 2)]
    Path("lone.system").unlink()
    assert _found(files=("other.system",)) == [("DRS023", 12), ("DRS023", 18)]


def test_it_is_the_same_from_another_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Paths in it are relative to its own folder, so that it can be checked in."""
    _write("lone.system")
    assert str(tmp_path) not in Path(FILE).read_text()
    (tmp_path / "sub").mkdir()
    monkeypatch.chdir(tmp_path / "sub")
    outcome = deros("check", "--strict", "../lone.system", "--baseline", f"../{FILE}")
    assert outcome.code == 0


def test_the_same_findings_give_the_same_bytes() -> None:
    """A baseline that is written again is the same file."""
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
def test_what_is_no_baseline_is_an_error(text: str | None) -> None:
    """Then every finding is reported, and the run fails with 2."""
    if text is not None:
        Path(FILE).write_text(text)
    outcome = deros("check", "lone.system", "--baseline", FILE)
    assert outcome.code == 2
    assert codes.UNUSABLE_BASELINE.name in outcome.out
    assert outcome.out.count("DRS212") == 2


def test_another_file_is_never_replaced() -> None:
    """A slip on the command line does not cost a model."""
    outcome = deros("check", "lone.system", "--baseline", "lone.system", "--write-baseline")
    assert outcome.code == 2
    assert Path("lone.system").read_text() == UNUSED


def test_a_baseline_has_to_be_named() -> None:
    """``--write-baseline`` alone is a mistake on the command line."""
    assert deros("check", "lone.system", "--write-baseline").code == 2


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_a_folder_that_cannot_be_written_is_an_error() -> None:
    """The reason is said."""
    Path("closed").mkdir(mode=0o500)
    outcome = deros("check", "lone.system", "--baseline", "closed/b.json", "--write-baseline")
    assert outcome.code == 2


def _sarif(*more: str) -> list[dict[str, Any]]:
    log = json.loads(deros("check", "lone.system", "--format", "sarif", *more).out)
    results: list[dict[str, Any]] = log["runs"][0]["results"]
    return results


def test_sarif_tells_new_known_and_absent_apart() -> None:
    """``baselineState`` is that of SARIF 2.1.0, 3.27.24; fingerprints stay when lines move."""
    plain = _sarif()
    assert "baselineState" not in plain[0]
    _write("lone.system")
    Path("lone.system").write_text("\nsystem Lone\ntopics\n  topic /b\n  topic /c\n")
    results = _sarif("--baseline", FILE)
    states = [(r["baselineState"], r["message"]["text"].split("'")[1]) for r in results]
    assert states == [("unchanged", "/b"), ("new", "/c"), ("absent", "/a")]
    assert results[0]["partialFingerprints"] == plain[1]["partialFingerprints"]
    assert results[2]["partialFingerprints"] == plain[0]["partialFingerprints"]


def test_allowed_findings_are_not_in_a_baseline() -> None:
    """What is allowed needs no entry."""
    Path("lone.system").write_text(UNUSED.replace("/a", "/a  // deros: allow DRS212 by hand"))
    _write("lone.system")
    assert [e["message"].split("'")[1] for e in json.loads(Path(FILE).read_text())["findings"]] == [
        "/b"
    ]
