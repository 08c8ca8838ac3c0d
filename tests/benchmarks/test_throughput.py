"""The benchmark of the monitors' throughput: agreement of all monitors, and a short run."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from tests.support.needs import needs

THROUGHPUT = Path(__file__).resolve().parents[2] / "benchmarks" / "throughput.py"


def _run(folder: Path, **env: str) -> dict[str, Any]:
    """Return the result of a short run, which fails if two monitors disagree."""
    output = folder / "throughput.json"
    short = ["--rules", "1", "14", "--repeat", "1", "--seconds", "15", "--json", str(output)]
    result = subprocess.run(
        [sys.executable, str(THROUGHPUT), *short],
        capture_output=True,
        text=True,
        timeout=120,
        env={**os.environ, **env},
    )
    assert result.returncode == 0, result.stderr
    results: dict[str, Any] = json.loads(output.read_text(encoding="utf-8"))
    return results


@needs("gcc")
@pytest.mark.slow
def test_c_monitors_are_compared(tmp_path: Path) -> None:
    """Generated and hand-written have times above those of empty calls, a size, and a ratio."""
    results = _run(tmp_path)
    rows = {row["monitor"]: row for row in results["rows"] if row["rules"] == 14}
    ours, hand = rows["generated, in C"], rows["by hand, in C"]
    for row in (ours, hand):
        assert row["above_nothing_ns"] > 0.0
        assert row["above_nothing_ns"] == pytest.approx(
            row["timing_ns"]["cost"] - rows["nothing, in C"]["timing_ns"]["cost"]
        )
        assert row["memory_bytes"]["state"] > 100
        assert row["memory_bytes"]["sections"]["text"] > 1000
        assert row["memory_bytes"]["sections"]["bss"] == 0
    (bar,) = [each for each in results["bars"] if each["what"] == "the time of by hand, in C"]
    assert bar["found"] == pytest.approx(ours["above_nothing_ns"] / hand["above_nothing_ns"])
    assert bar["held"] is (bar["found"] <= 1.25)


def test_missing_c_compiler_is_reported(tmp_path: Path) -> None:
    """The other monitors are still measured."""
    results = _run(tmp_path, PATH=str(tmp_path), CC="")
    rows = {row["monitor"]: row for row in results["rows"] if row["rules"] == 14}
    assert rows["generated, in C"]["why"] == rows["by hand, in C"]["why"] == "no C compiler"
    assert rows["generated"]["timing_ns"]["cost"] > 0.0
    assert all("in C" not in bar["what"] for bar in results["bars"])
