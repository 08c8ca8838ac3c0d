"""The fuzzer as a command."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def fuzz(*options: str) -> subprocess.CompletedProcess[str]:
    """Run it in one worker."""
    command = [sys.executable, str(ROOT / "tools" / "fuzz_models.py"), "--jobs", "1", *options]
    return subprocess.run(command, capture_output=True, text=True, timeout=400)


def test_a_run_tells_seed_and_number_and_ends_well() -> None:
    """What it prints is enough to have the same mutants again."""
    run = fuzz("--mutants", "60", "--seed", "3")
    assert run.returncode == 0, run.stdout + run.stderr
    assert run.stdout.startswith("seed 3\n")
    assert "60 mutants in " in run.stdout
    assert run.stdout.endswith("no findings\n")


def test_a_finding_is_the_exit_code() -> None:
    """Nothing is done within no time, so everything is a finding, kept in a folder."""
    run = fuzz("--mutants", "2", "--seed", "3", "--limit", "0.00001", "--kind", "model")
    assert run.returncode == 1, run.stdout + run.stderr
    assert "FINDING" in run.stdout
    assert re.search(r"kept in \.tmp/fuzz-models/\w+", run.stdout)


def test_a_run_ends_when_its_time_is_up() -> None:
    """It takes seconds instead of a number."""
    run = fuzz("--seconds", "1")
    assert run.returncode == 0, run.stdout + run.stderr
    assert re.match(r"seed \d+\n[\d,]+ mutants in ", run.stdout)
