"""The program that repeats tests: it reports failures, and leaves no process running."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

REPEAT = Path(__file__).resolve().parents[2] / "tools" / "repeat.py"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("body", "code", "expected_output"),
    [
        ("pass", 0, ["round 2 of 2: 1 passed, ", "2 of 2 rounds passed"]),
        ("raise ValueError", 1, ["round 1 of 2: 1 failed, ", "::test_it", "0 of 2 rounds passed"]),
    ],
)
def test_each_round_is_reported(
    tmp_path: Path, body: str, code: int, expected_output: list[str]
) -> None:
    """A failure is named, stored and counted, and does not end the round."""
    test = tmp_path / "test_one.py"
    test.write_text(f"def test_it():\n    {body}\n", encoding="utf-8")
    options = ["--rounds", "2", "--busy", "1", "--jobs", "1", "--output", str(tmp_path / "logs")]
    run = subprocess.run(
        [sys.executable, str(REPEAT), *options, str(test)], capture_output=True, text=True
    )
    assert run.returncode == code, run.stderr
    assert all(each in run.stdout for each in expected_output), run.stdout
    assert ("ValueError" in (tmp_path / "logs" / "2.log").read_text(encoding="utf-8")) is bool(code)
