"""The benchmark of the safety node's reaction: its arithmetic, and a short run."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from benchmarks.support.samples import ReportedSample, Sample, Trigger, match
from benchmarks.support.schedule import Schedule
from benchmarks.support.summary import summarize
from tests.support.cpp import BUILD_LIMIT
from tests.support.needs import needs

REACTION = Path(__file__).resolve().parents[2] / "benchmarks" / "reaction.py"
MS = 1_000_000


def test_nothing_is_scheduled_near_a_due_reaction() -> None:
    """An event too close is moved to the end of the quiet period, also across adjacent periods."""
    schedule = Schedule(3)
    for due in (10, 14, 30):
        schedule.add(due)
    assert [schedule.first_free(at) for at in (7, 8, 13, 16, 17, 28, 33)] == [
        7,
        17,
        17,
        17,
        17,
        33,
        33,
    ]


def test_reactions_are_not_due_at_the_same_time() -> None:
    """They keep the distance of all events from each other; past ones no longer count."""
    schedule = Schedule(3)
    schedule.add(10)
    assert [due for due in range(5, 16) if schedule.admits(due)] == [5, 6, 7, 13, 14, 15]
    schedule.forget_before(13)
    assert not schedule.admits(12)
    schedule.forget_before(14)
    assert schedule.admits(12)


def test_summary_interpolates_percentiles() -> None:
    """Times are in nanoseconds, the summary in milliseconds."""
    summary = summarize([4 * MS, 1 * MS, 3 * MS, 2 * MS])
    assert (summary.count, summary.mean, summary.least, summary.greatest) == (4, 2.5, 1.0, 4.0)
    assert summary.median == 2.5
    assert summary.percent_99 == pytest.approx(3.97)
    assert summary.deviation == pytest.approx(1.29099, abs=1e-5)


def test_sample_is_matched_with_the_trigger_of_its_own_tilt() -> None:
    """The trigger of the same lane between tilt and answer matches, if there is one."""
    first, second = Sample("a", 0.0, 100, 200), Sample("a", 0.0, 300, 400)
    other = Sample("b", 0.0, 100, 200)
    trigger = Trigger("a", 350, 360)
    assert match([first, second, other], [trigger]) == [ReportedSample(second, trigger)]


@pytest.mark.parametrize(
    ("due", "published", "received", "early"),
    [
        (2_000_000_100, 2_000_000_100, 2_000_000_100, False),
        (2_000_000_099, 2_000_000_200, 2_000_000_300, True),
        (2_000_000_150, 2_000_000_149, 2_000_000_300, True),
        (2_000_000_100, 2_000_000_100, 2_000_000_099, True),
    ],
)
def test_one_nanosecond_too_early_is_early(
    due: int, published: int, received: int, early: bool
) -> None:
    """This applies to the rule, the publication and the receipt."""
    sample = Sample("a", 2.0, 100, received)
    assert ReportedSample(sample, Trigger("a", due, published)).is_early is early


SECTIONS = {"immediate rule", "for 0.4 sec", "for 2 sec", "for 4 sec", "all of them"}


def _run(file: Path, *options: str, env: Mapping[str, str], limit: float) -> dict[str, Any]:
    """Return the result of a short run: complete series, without lost or early samples."""
    command = [sys.executable, str(REACTION), "--repeat", "2", "--immediate", "2", *options]
    result = subprocess.run(
        [*command, "--json", str(file)], capture_output=True, text=True, timeout=limit, env=env
    )
    assert result.returncode == 0, result.stderr
    results: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
    assert {each["section"] for each in results["series"]} == SECTIONS
    assert all(each["ms"]["count"] >= 2 for each in results["series"])
    counted = {bar["what"]: bar["held"] for bar in results["bars"] if bar["allowed"] == "none"}
    assert len(counted) == 3
    assert all(counted.values()), counted
    assert all(0 <= percent < 100 for percent in results["stolen_percent"].values())
    return results


@pytest.mark.ros
@pytest.mark.slow
def test_short_run_measures_rclpy(tmp_path: Path) -> None:
    """Without rclcpp it says so, and measures only rclpy."""
    env = {**os.environ, "AMENT_PREFIX_PATH": sys.prefix}
    results = _run(tmp_path / "found.json", env=env, limit=120)
    assert {result["client"] for result in results["series"]} == {"rclpy"}
    assert results["not_measured"] == {"rclcpp": "no rclcpp in AMENT_PREFIX_PATH"}


@pytest.mark.ros
@needs("rclcpp")
def test_short_run_measures_rclcpp(tmp_path: Path) -> None:
    """Nodes, relays and a driver are built for it."""
    results = _run(
        tmp_path / "found.json", "--only", "rclcpp", env=os.environ, limit=BUILD_LIMIT + 120
    )
    assert {result["client"] for result in results["series"]} == {"rclcpp"}
    asked = {bar["what"]: bar["allowed"] for bar in results["bars"]}
    assert asked["rclcpp, immediate, median / fastest relay's"] == "<= 1.1"
    assert asked["rclcpp, for T, 99 % late / thread on a condition variable's"] == "<= 1.5"
