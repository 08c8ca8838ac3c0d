"""The benchmark of the safety node's cost: its arithmetic, and a short run."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from benchmarks.support.cost_results import FASTEST, NODES, SAFETY, USUAL, Memory, Results, Use
from benchmarks.support.usage import Meter, memory_mib, processor_time_ns

COST = Path(__file__).resolve().parents[2] / "benchmarks" / "cost.py"


def _results(percents: dict[tuple[str, str], tuple[float, float]]) -> Results:
    uses = tuple(Use(load, node, each) for (load, node), each in percents.items())
    memory = (Memory(SAFETY, 70.0, 70.5), Memory(USUAL, 70.0, 90.0))
    return Results({"paper": 170.0, "scan": 210.0}, uses, memory, 2.0, {}, stopped=True)


def test_safety_node_is_compared_with_both_receivers() -> None:
    """The result is the difference of means; a scan counts the cost of the safety node alone."""
    results = _results(
        {
            ("paper", SAFETY): (3.0, 5.0),
            ("paper", USUAL): (7.0, 8.0),
            ("paper", FASTEST): (1.0, 2.0),
            ("scan", SAFETY): (5.5, 6.5),
        }
    )
    verdicts = list(results.verdicts("paper", "scan"))
    assert [verdict.found for verdict in verdicts] == [-3.5, 2.5, 2.0, 0.5]
    assert [verdict.held for verdict in verdicts] == [True, False, False, True]


def test_processor_time_covers_all_threads() -> None:
    """It agrees with the value of the process itself, and does not grow while it sleeps."""
    before = processor_time_ns(os.getpid())
    own = time.process_time_ns()
    after = processor_time_ns(os.getpid())
    assert before <= own <= after
    with subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE) as child:
        while memory_mib(child.pid) < 5.0:  # until the interpreter has started
            assert child.poll() is None
        meter = Meter.start(lambda: processor_time_ns(os.getpid()))
        while time.process_time_ns() < own + 20_000_000:
            pass
        assert 0.0 < meter.percent() <= 100.0 * (os.cpu_count() or 1)
        assert processor_time_ns(child.pid) > 0
        child.communicate(b"\n")
    with pytest.raises(OSError, match="Invalid argument"):
        processor_time_ns(child.pid)


@pytest.mark.slow
@pytest.mark.ros
def test_short_run_measures_every_node_and_load(tmp_path: Path) -> None:
    """The safety node still stops under every load."""
    output = tmp_path / "cost.json"
    short = ["--turns", "2", "--seconds", "0.1", "--settle", "0.1"]
    command = [sys.executable, str(COST), *short, "--json", str(output)]
    result = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert result.returncode == 0, result.stderr
    found = json.loads(output.read_text())
    assert found["stopped"]
    assert len(found["verdicts"]) == 4
    for load in found["loads"]:
        assert set(load["percent_of_one_core"]) == set(NODES)
    kilohertz = found["loads"][-1]["percent_of_one_core"]
    assert all(kilohertz[node]["mean"] > 0.5 for node in NODES)
    assert min(found["received"].values()) > 0.5
