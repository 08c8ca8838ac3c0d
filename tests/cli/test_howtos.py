"""The pages in ``docs/howto`` that need no robot are played word for word.

They are scaffold.md, wire-a-system.md, timeouts.md, write-an-action.md and certify.md. The page
existing-robot.md has a robot, and a test of its own in ``tests/e2e``.
"""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

from tests.support.page_reader import Reader, blocks_of
from tests.support.pages import ROOT, Block

PAGES = ("scaffold", "wire-a-system", "timeouts", "write-an-action", "certify")


@pytest.mark.parametrize("name", PAGES)
def test_page_is_true_word_for_word(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each file is written, each command typed, and what it prints compared."""
    monkeypatch.chdir(tmp_path)
    reader = Reader(tmp_path)
    for block in blocks_of(f"docs/howto/{name}.md"):
        reader.play(block)
    assert reader.commands > 1
    for path in tmp_path.rglob("*.py"):
        ast.parse(path.read_text(encoding="utf-8"))


def test_every_page_without_a_robot_is_played() -> None:
    """A page that is added is played too."""
    found = {path.stem for path in (ROOT / "docs/howto").glob("*.md")}
    assert found == {*PAGES, "existing-robot"}


@pytest.mark.parametrize(
    ("language", "title", "text", "error"),
    [
        ("console", "", "$ deros check a.rnd\n2 files checked, no findings\n", "1 file checked"),
        ("console", "", "$ deros check b.rnd\n…\n", "b.rnd: 2"),
        ("diff", "a.rnd", "-node b : pkg\n+node c : pkg\n", "changes what is 0 times there"),
    ],
    ids=["other output", "exit code of a failure", "change of what is not there"],
)
def test_page_that_is_not_true_is_detected(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    language: str,
    title: str,
    text: str,
    error: str,
) -> None:
    """What differs from the page, or fails unsaid, ends the play with its command."""
    monkeypatch.chdir(tmp_path)
    reader = Reader(tmp_path)
    reader.play(Block("page.md", 1, "rosnode", "node a : pkg\n", "", "a.rnd"))
    with pytest.raises(AssertionError, match=error):
        reader.play(Block("page.md", 5, language, text, "", title))
