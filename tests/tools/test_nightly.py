"""The nightly run: one table of all steps, and what it goes on with."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from tests.support.needs import needs
from tools import nightly
from tools.nightly import STEPS, Outcome, Step

ROOT = Path(__file__).resolve().parents[2]


def test_every_step_is_a_documented_target() -> None:
    """``make help`` lists the targets that the night consists of."""
    listed = re.findall(r"^([a-z-]+):.*## ", (ROOT / "Makefile").read_text("utf-8"), re.MULTILINE)
    assert {step.target.split()[0] for step in STEPS} <= set(listed)


def test_integration_runs_documented_targets() -> None:
    """What the integration server draws a part of, the night runs whole."""
    script = (ROOT / ".ci/run").read_text("utf-8")
    steps = {target for line in re.findall(r"^step (.*)", script, re.M) for target in line.split()}
    makefile = (ROOT / "Makefile").read_text("utf-8")
    targets = {step for step in steps if re.fullmatch("[a-z-]+", step) and step != "-j"}
    assert all(f"\n{target}: " in makefile for target in targets)
    assert {"test", "test-rest", "misra", "sanitize", "prove"} <= targets


def test_options_of_pytest_are_single_words() -> None:
    """A value that is a word of its own, and exists, would be taken for the tests to run."""
    makefile = (ROOT / "Makefile").read_text("utf-8").replace("\\\n", "")
    runs = [line for line in makefile.splitlines() if line.startswith("\t@$(TESTS)")]
    assert len(runs) == 3
    for line in runs:
        assert all(word.startswith("--") for word in re.sub(r"\$\$\(.*?\)", "", line).split()[1:])


@pytest.fixture
def steps(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """Let the night have two steps of which one fails; return the folder of its output."""
    made = (Step("good", "x", r"(\d+ passed)"), Step("bad", "y", r"(\d+ failed)"))
    monkeypatch.setattr(nightly, "STEPS", made)
    monkeypatch.setattr(nightly, "REPOSITORY", tmp_path)
    monkeypatch.setattr(nightly, "_commit", lambda: "abc")
    text = (
        "x:\n\t@echo 7 passed; echo 7 passed; echo x >> ran\ny:\n\t@echo 1 failed; test -e mended\n"
    )
    (tmp_path / "Makefile").write_text(text, encoding="utf-8")
    return tmp_path


@needs("git", "make")
def test_table_has_every_step(steps: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A failure does not end the night; its figures and exit code are in the table."""
    assert nightly.main(["--output", str(steps / "out")]) == 1
    rows = [line for line in capsys.readouterr().out.splitlines() if "│" in line]
    assert re.search(r"good +│ passed +│ 0.0 +│ 7 passed ", rows[0])
    assert re.search(r"bad +│ failed \(2\) +│ 0.0 +│ 1 failed", rows[1])
    assert "1 failed" in (steps / "out/bad.log").read_text("utf-8")


@needs("git", "make")
def test_interrupted_night_goes_on(steps: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Only steps that have not passed on this commit are run; all are in the table."""
    arguments = ["--output", str(steps / "out")]
    assert nightly.main(arguments) == 1
    (steps / "mended").touch()
    assert nightly.main(arguments) == 0
    assert (steps / "ran").read_text() == "x\n"
    assert "7 passed" in capsys.readouterr().out


@needs("git", "make")
def test_other_commit_does_not_count(steps: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """What has passed on another commit says nothing."""
    (steps / "out").mkdir()
    passed = {"good": vars(Outcome("older", 0, 1.0, "")), "bad": vars(Outcome("abc", 0, 1.0, ""))}
    (steps / "out/outcomes.json").write_text(json.dumps(passed), encoding="utf-8")
    assert nightly.main(["--output", str(steps / "out"), "--steps", "bad"]) == 1
    assert re.search(r"good +│ not run", capsys.readouterr().out)
