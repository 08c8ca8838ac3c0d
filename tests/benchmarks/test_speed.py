"""The comparison of the speed of monitors with that of another version."""

from __future__ import annotations

import subprocess
import sys
from datetime import datetime, timedelta, timezone
from pathlib import Path

import pytest

from benchmarks.support.speed_results import earlier, medians
from tests.support.git import git
from tests.support.needs import needs

SPEED = Path(__file__).resolve().parents[2] / "benchmarks" / "speed.py"


@pytest.mark.parametrize(
    ("now", "before", "is_slower"),
    [
        ([1.0, 1.0, 9.0], [1.0, 1.05, 1.04], False),
        ([1.0, 0.9, 0.98], [1.04, 1.04, 0.1], True),
        ([0.98, 0.99, 0.97], [1.03, 1.02, 1.05], False),
        ([0.5, 0.5, 0.5], [], False),
    ],
)
def test_medians_are_compared(now: list[float], before: list[float], is_slower: bool) -> None:
    """Five percent of the median are allowed; without another version nothing is slower."""
    rounds = {"now": [{"C": each} for each in now]}
    rounds |= {"before": [{"C": each} for each in before]} if before else {}
    (found,) = medians(rounds)
    assert found.is_slower is is_slower


@needs("git")
def test_version_before_is_the_last_tag_or_a_week_old(tmp_path: Path) -> None:
    """So there is one before the first tag, too, though not in the first week."""

    def commit(days: int) -> str:
        when = datetime.now(timezone.utc) - timedelta(days=days)
        words = "commit", "--allow-empty", "-m", f"{days} days old"
        git(tmp_path, *words, GIT_COMMITTER_DATE=when.isoformat())
        return git(tmp_path, "log", "-1", "--format=%h").strip()

    git(tmp_path, "init")
    assert earlier(tmp_path) == ""
    commit(9)
    old = commit(8)
    commit(6)
    assert earlier(tmp_path) == old
    git(tmp_path, "tag", "v1")
    commit(0)
    assert earlier(tmp_path) == "v1"


@needs("gcc", "git")
@pytest.mark.slow
def test_versions_are_measured_in_turns() -> None:
    """Both languages stand in the table, each with its speed now and at the other commit."""
    command = [sys.executable, str(SPEED), "--rounds=1", "--against=HEAD"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode in (0, 1), done.stderr  # a single round under load says little
    lines = [line for line in done.stdout.splitlines() if "was" in line]
    assert [line.partition(":")[0] for line in lines] == ["Python", "C"]
