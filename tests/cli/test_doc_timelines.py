"""The page about tests of rules, and DRS506.md: what they print is played as it stands."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.support import pages
from tests.support.cli import deros

SYSTEM = """system Robot
topics
  external topic /odom : nav_msgs.Odometry
  external topic /stop : std_msgs.Bool
"""
BLOCKS = pages.blocks()
ON_PAGE = [each for each in BLOCKS if each.page == "docs/testing.md"]
BY_LANGUAGE = {
    language: [each.text for each in ON_PAGE if each.language == language]
    for language in ("deros", "markdown", "console")
}


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Enter a folder with the rules and the timeline of the page."""
    monkeypatch.chdir(tmp_path)
    (rules,) = BY_LANGUAGE["deros"]
    (timeline,) = BY_LANGUAGE["markdown"]
    Path("robot.system").write_text(SYSTEM, encoding="utf-8")
    Path("drive.deros").write_text(rules, encoding="utf-8")
    Path("drive.md").write_text(timeline, encoding="utf-8")
    return tmp_path


def test_rules_of_the_page_have_no_findings() -> None:
    """They may be copied."""
    assert deros("check", "--strict", "drive.deros").code == 0


def test_timeline_differs_as_printed() -> None:
    """The output on the page is that of the command, and the time that it names passes."""
    command, _, shown = BY_LANGUAGE["console"][1].partition("\n")
    assert command == "$ deros test ."
    outcome = deros("test", ".")
    assert (outcome.code, outcome.out, outcome.err) == (1, shown, "")
    right = Path("drive.md").read_text(encoding="utf-8").replace("| 1.3 s ", "| 1.42 s ")
    Path("drive.md").write_text(right, encoding="utf-8")
    assert deros("test", ".").code == 0


def test_first_commands_run() -> None:
    """A new model has tests that pass."""
    lines = [line.split("#")[0].split() for line in BY_LANGUAGE["console"][0].splitlines()]
    for path in ("drive.md", "drive.deros", "robot.system"):
        Path(path).unlink()
    for words in lines:
        assert words[:2] == ["$", "deros"]
        assert deros(*words[2:]).code == 0


@pytest.mark.parametrize(
    "block", [each for each in BLOCKS if (each.code, each.language) == ("DRS506", "markdown")]
)
def test_examples_of_the_finding(block: pages.Block) -> None:
    """The bad table has it, and the good one does not."""
    Path("drive.md").write_text(f"# Title\n\n{block.text}", encoding="utf-8")
    outcome = deros("test", "drive.md")
    assert ("error[DRS506 bad-timeline]" in outcome.err) == block.is_bad
    assert (outcome.code == 2) == block.is_bad
