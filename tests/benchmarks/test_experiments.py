"""The paper's experiments, repeated: what is found in recordings, and a short run."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from benchmarks.support.experiments.analysis import APART, TRACE, Analysis, Series, analyse
from benchmarks.support.experiments.recording import NODE, RECORDER
from benchmarks.support.experiments.report import page, write_parquet
from benchmarks.support.experiments.results import Results, Row, Run
from benchmarks.support.experiments.robots import REAL, ROBOTS, SIMULATED, Times
from benchmarks.support.experiments.session import EXAMPLES, Measured
from deros.importers.recordings.opened import opened
from tests.support.cpp import BUILD_LIMIT
from tests.support.needs import needs
from tests.support.recorded_runs import (
    DUE,
    EVENTS,
    FAULT,
    INTELLIGENT_ONE,
    MS,
    RESET,
    SIMULATED_START,
    START,
    TRAVEL,
    Reported,
    write_run,
)

ROOT = Path(__file__).resolve().parents[2]
EXPERIMENTS = ROOT / "benchmarks" / "experiments.py"
RULES = EXAMPLES / "intelligent_one" / "intelligent_one.deros"


def _analysed(folder: Path) -> Analysis:
    return analyse(INTELLIGENT_ONE, RULES, folder)


def _program(*arguments: str, limit: float = 60.0) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, str(EXPERIMENTS), *arguments]
    return subprocess.run(command, capture_output=True, text=True, timeout=limit)


# A recording whose delays are known --------------------------------------------------------------


def test_delay_is_counted_from_sending_to_receipt(tmp_path: Path) -> None:
    """The condition is fulfilled when the first such message is sent; other faults are none."""
    found = _analysed(write_run(tmp_path / "run", delay=3 * MS))
    too_fast, tilted = found.series
    assert tilted.times == ((400 * MS + TRAVEL + 3 * MS) / 1e9,)
    assert (tilted.lost, too_fast.times, too_fast.lost) == (0, (), 0)


def test_rules_explain_the_events_of_the_node(tmp_path: Path) -> None:
    """All events of the node are the player's, at the same nanosecond."""
    found = _analysed(write_run(tmp_path / "run"))
    assert (found.events, found.differences) == (3, ())


@pytest.mark.parametrize(
    ("events", "expected"),
    [
        (
            [*EVENTS, Reported(DUE + MS, "trigger", "stop", "too_fast")],
            ["only the safety node has: 6.401500000 trigger stop by too_fast"],
        ),
        (EVENTS[1:], ["only the player has: 6.400500000 trigger stop by tilted"]),
        (
            [replace(EVENTS[0], at=DUE + 1), *EVENTS[1:]],
            [
                "only the safety node has: 6.400500001 trigger stop by tilted",
                "only the player has: 6.400500000 trigger stop by tilted",
            ],
        ),
        (
            [EVENTS[1], EVENTS[0], EVENTS[2]],
            ["the safety node has the same events in another order"],
        ),
        (
            [EVENTS[0], *EVENTS],
            ["only the safety node has: 6.400500000 trigger stop by tilted"],
        ),
    ],
    ids=["one more", "one less", "a nanosecond later", "another order", "twice"],
)
def test_event_that_the_rules_do_not_explain_is_named(
    tmp_path: Path, events: Sequence[Reported], expected: Sequence[str]
) -> None:
    """An event more or less, a nanosecond or the order is a difference."""
    assert list(_analysed(write_run(tmp_path / "run", events=events)).differences) == expected


@pytest.mark.parametrize(("delay", "time"), [(13 * MS, 0.41), (-TRAVEL // 2, 0.4)])
def test_simulated_times_are_those_of_the_recorded_clock(
    tmp_path: Path, delay: int, time: float
) -> None:
    """What counts is the last step that was sent, though the recorder may receive it later."""
    run = write_run(tmp_path / "run", delay=delay, clock_step=10 * MS)
    assert _analysed(run).series[1].times == (time,)


def test_stop_that_does_not_come_is_lost(tmp_path: Path) -> None:
    """It is counted, and has no time."""
    found = _analysed(write_run(tmp_path / "run", answers=False)).series[1]
    assert (found.times, found.lost) == ((), 1)


def test_recording_can_be_simulated_and_imported(tmp_path: Path) -> None:
    """``deros simulate`` plays the trace to the same events; other tools read the MCAP."""
    run = write_run(tmp_path / "run")
    _analysed(run)
    command = [sys.executable, "-m", "deros", "simulate", str(RULES), "--trace", str(run / TRACE)]
    result = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert result.returncode == 0, result.stderr
    events = [json.loads(line) for line in result.stdout.splitlines()]
    assert [(each["event"], each["action"]) for each in events] == [
        (each.kind, each.action) for each in EVENTS
    ]
    (recording,), missing = opened(run / RECORDER)
    assert {each.topic for each in recording.channels} >= {"/imu", "/odometry", "/stop"}
    assert not missing


# Where nothing says when the node took a message -------------------------------------------------


def _as_received(folder: Path) -> Analysis:
    return analyse(INTELLIGENT_ONE, RULES, folder, is_watched=False)


@pytest.mark.parametrize("clock_step", [0, 10 * MS], ids=[REAL, SIMULATED])
def test_events_are_compared_by_the_receipts_of_the_recorder(
    tmp_path: Path, clock_step: int
) -> None:
    """They are the same ones in the same order, and it is told how far they are apart."""
    run = write_run(
        tmp_path / "run", events=_taken_later(3 * MS, clock_step), clock_step=clock_step
    )
    (run / NODE).unlink()
    found = _as_received(run)
    assert (found.events, found.differences) == (3, ())
    assert found.apart == 3 * MS


@pytest.mark.parametrize(
    "events",
    [EVENTS[1:], [EVENTS[1], EVENTS[0], EVENTS[2]], [replace(EVENTS[0], behaviour="too_fast")]],
    ids=["one less", "another order", "another behaviour"],
)
def test_other_events_than_by_the_recorder_are_named(
    tmp_path: Path, events: Sequence[Reported]
) -> None:
    """Times may differ, what happens may not."""
    assert _as_received(write_run(tmp_path / "run", events=events)).differences


def test_only_events_of_latched_actions_tell_of_an_operator(tmp_path: Path) -> None:
    """Another action is reset by its rules: nobody has asked for that, and nothing is refused."""
    by_rules = replace(EVENTS[2], action="log_state", at=DUE + MS)
    run = write_run(tmp_path / "run", events=[*EVENTS[:2], by_rules, EVENTS[2]])
    differences = _as_received(run).differences
    assert any("reset log_state" in each for each in differences)
    assert not any("refused" in each for each in differences)


def test_event_far_from_its_time_is_named(tmp_path: Path) -> None:
    """A message takes no such time to a node."""
    run = write_run(tmp_path / "run", events=_taken_later(APART + 1, 0))
    assert any("only the player has" in each for each in _as_received(run).differences)


def _taken_later(by: int, clock_step: int) -> list[Reported]:
    """Return the events of a node that takes messages so much later than the recorder."""
    shift = SIMULATED_START - START if clock_step else 0
    # By a simulated clock the fault begins at a step, and lasts for whole ones.
    due = FAULT + 400 * MS if clock_step else DUE
    times = (due + by, due + by, RESET)
    return [replace(each, at=shift + at) for each, at in zip(EVENTS, times, strict=True)]


# The program on recordings -----------------------------------------------------------------------


def _recorded(output: Path, **options: Any) -> Path:
    """Write recordings of both clocks, the one by the machine's with options."""
    write_run(output / "recordings" / "intelligent_one_R_python", **options)
    write_run(output / "recordings" / "intelligent_one_S_python", clock_step=10 * MS)
    return output


def test_analysis_writes_everything(tmp_path: Path) -> None:
    """Recordings are enough for the table, the page and the JSON."""
    output = _recorded(tmp_path / "out")
    result = _program("--analyse", str(output), "--json", str(tmp_path / "found.json"))
    assert result.returncode == 0, result.stderr
    assert "R_T" in result.stdout
    assert "0.40635" in result.stdout
    found = json.loads((tmp_path / "found.json").read_text(encoding="utf-8"))
    times = {(each["experiment"]): each["times_s"] for each in found["rows"]}
    assert times == {"R_S": [], "R_T": [0.4035], "S_S": [], "S_T": [0.4]}
    assert (output / "experiments.html").exists()


def test_unexplained_event_fails_the_program(tmp_path: Path) -> None:
    """Even without ``--assert``: a safety node that does something else is no matter of speed."""
    output = _recorded(tmp_path / "out", events=EVENTS[:2])
    result = _program("--analyse", str(output))
    assert result.returncode == 1
    assert "only the player has: 7.000000000 reset stop" in result.stdout


@pytest.mark.parametrize("name", [RECORDER, NODE, "measured.json"])
def test_recording_that_cannot_be_read_is_named(tmp_path: Path, name: str) -> None:
    """Damage ends the program with a sentence, not with a traceback."""
    output = _recorded(tmp_path / "out")
    file = output / "recordings" / "intelligent_one_R_python" / name
    file.write_bytes(file.read_bytes()[: file.stat().st_size // 2])
    result = _program("--analyse", str(output))
    assert result.returncode == 2
    assert f"{file}: cannot be read" in result.stderr
    assert "Traceback" not in result.stderr


def test_missing_recordings_are_named(tmp_path: Path) -> None:
    """An empty folder has nothing to analyse."""
    result = _program("--analyse", str(tmp_path))
    assert (result.returncode, result.stderr) == (2, f"{tmp_path}: has no recordings\n")


# The table ---------------------------------------------------------------------------------------


def _results(times: tuple[float, ...], lost: int = 0, processor: float = 1.0) -> Results:
    experiment = INTELLIGENT_ONE.experiments[0]
    analysis = Analysis((Series(experiment, times, lost),), 8, ())
    measured = Measured([processor, processor], 1.5, 70.0, 0.5, [MS, 2 * MS, 6 * MS])
    return Results([Run(INTELLIGENT_ONE, REAL, "Python", analysis, measured)], [])


def test_row_has_the_figures_of_the_paper_beside_its_own() -> None:
    """Average, deviation of the sample, least and greatest in seconds, delay in milliseconds."""
    (row,) = _results((2.001, 2.003, 2.008)).rows
    times = row.times
    assert times is not None
    assert (times.least, times.greatest) == (2.001, 2.008)
    assert times.average == pytest.approx(2.004)
    assert times.deviation == pytest.approx(0.0036056, abs=1e-7)
    assert row.beyond_ms == pytest.approx([1.0, 3.0, 8.0])
    assert (row.label, row.paper) == ("R_S", Times(2.00271, 0.00461, 2.00006, 2.01374))


def test_ideal_and_rows_are_those_of_the_paper() -> None:
    """Its six rows are there, each with an ideal that its average does not undercut."""
    found = {
        (robot.title, f"{clock}_{each.key}"): (each.ideal, each.paper[clock])
        for robot in ROBOTS
        for each in robot.experiments
        for clock in robot.clocks
        if clock in each.paper
    }
    assert set(found) == {
        *(("Intelligent One", label) for label in ("R_S", "S_S", "R_T", "S_T")),
        *(("FIX-Robo", label) for label in ("R_S", "S_S")),
    }
    for ideal, paper in found.values():
        assert ideal <= paper.least <= paper.average <= paper.greatest
    assert {clock for robot in ROBOTS for clock in robot.clocks} == {REAL, SIMULATED}


@pytest.mark.parametrize(
    ("results", "failing"),
    [
        (_results((2.001, 2.002)), []),
        (_results((2.001, 2.002), lost=1), ["actions that have not come"]),
        (_results((1.999, 2.002)), ["actions before the ideal time"]),
        (
            _results((2.001, 2.002), processor=2.0),
            ["Intelligent One R, Python: processor of the safety node"],
        ),
    ],
    ids=["all well", "lost", "early", "processor"],
)
def test_bar_fails_for_its_fault(results: Results, failing: Sequence[str]) -> None:
    """Each of them, and no other."""
    assert [bar.what for bar in results.bars() if not bar.held] == failing


def test_row_with_one_time_has_no_deviation() -> None:
    """Its figures are left out."""
    (row,) = _results((2.001,)).rows
    assert isinstance(row, Row)
    assert row.times is None


def test_page_needs_nothing_else() -> None:
    """It has every row and a dot for each time, and refers to nothing outside."""
    text = page(_results((2.001, 2.002)))
    assert "R_S Python: faster than 0.5 m/s" in text
    assert text.count('class="dot"') == 2
    assert not re.findall(r"(?:src|href)=|url\(|@import|https?:", text)


def test_parquet_has_a_row_for_each_time(tmp_path: Path) -> None:
    """Columns have names and types, as any reader of Parquet finds them."""
    duckdb = pytest.importorskip("duckdb")
    path = tmp_path / "it's.parquet"
    assert write_parquet(_results((2.001, 2.002)), path)
    rows = duckdb.read_parquet(str(path)).fetchall()
    assert [(row[1], row[4], row[5], row[6]) for row in rows] == [
        ("R_S", 2.0, 1, 2.001),
        ("R_S", 2.0, 2, 2.002),
    ]


# On the real middleware --------------------------------------------------------------------------


@pytest.mark.ros
@pytest.mark.parametrize("robot", ["frobit", pytest.param("kobuki", marks=pytest.mark.slow)])
def test_short_run_is_explained_by_its_rules(tmp_path: Path, robot: str) -> None:
    """Each fault is answered, none early, and the node's events are those of the player."""
    run = _short_run(tmp_path, robot, "python", limit=240.0)
    assert run["apart_ns"] is None


@pytest.mark.ros
@pytest.mark.slow
@needs("rclcpp")
def test_short_run_on_rclcpp_is_explained_by_its_rules(tmp_path: Path) -> None:
    """The same of the node in C++, which is built for it; its times are near the player's."""
    run = _short_run(tmp_path, "frobit", "cpp", limit=BUILD_LIMIT + 240.0)
    assert 0 <= run["apart_ns"] <= APART


def _short_run(folder: Path, robot: str, target: str, limit: float) -> dict[str, Any]:
    output, found = folder / "out", folder / "found.json"
    options = ("--only", robot, "--target", target, "--repeat", "2", "--output", str(output))
    result = _program(*options, "--json", str(found), limit=limit)
    assert result.returncode == 0, result.stdout + result.stderr
    results = json.loads(found.read_text(encoding="utf-8"))
    assert all(len(row["times_s"]) == 2 and not row["lost"] for row in results["rows"])
    assert all(min(row["times_s"]) >= row["ideal_s"] for row in results["rows"])
    run: dict[str, Any]
    (run,) = results["runs"]
    # Each is answered by a stop, a text and a reset.
    assert run["events"] >= 3 * 2 * len(results["rows"])
    assert run["differences"] == []
    assert all(0.0 < percent < 100.0 for percent in run["processor_percent"])
    assert (output / "experiments.html").exists()
    return run
