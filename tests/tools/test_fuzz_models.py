"""The fuzzer as a command."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def fuzz(*options: str) -> subprocess.CompletedProcess[str]:
    """Run the fuzzer with one worker."""
    command = [sys.executable, "-m", "tools.fuzz_models", "--jobs", "1", *options]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=400)


@pytest.mark.slow
def test_run_prints_seed_and_number() -> None:
    """The output suffices to reproduce the mutants."""
    run = fuzz("--mutants", "60", "--seed", "3")
    assert run.returncode == 0, run.stdout + run.stderr
    assert run.stdout.startswith("seed 3\n")
    assert "60 mutants in " in run.stdout
    assert run.stdout.endswith("no findings\n")


@pytest.mark.slow
def test_finding_sets_the_exit_code() -> None:
    """With a tiny time limit everything is a finding, stored in a folder."""
    run = fuzz("--mutants", "2", "--seed", "3", "--limit", "0.00001", "--kind", "model")
    assert run.returncode == 1, run.stdout + run.stderr
    assert "FINDING" in run.stdout
    assert re.search(r"kept in \.tmp/fuzz-models/\w+", run.stdout)


@pytest.mark.slow
def test_run_ends_at_its_time_limit() -> None:
    """It accepts seconds instead of a number."""
    run = fuzz("--seconds", "1")
    assert run.returncode == 0, run.stdout + run.stderr
    assert re.match(r"seed \d+\n[\d,]+ mutants in ", run.stdout)
