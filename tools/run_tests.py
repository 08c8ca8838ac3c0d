"""Run the tests in stages: without ROS, those that need compilers and their like last; then on ROS.

Nothing else runs beside the tests on ROS. Those of them that fail are run once more, alone; the run
fails if one fails again, or if more than three needed that. What passed the second time is printed
and kept (:mod:`tools.reruns`). The end names the slowest tests, those that are slow and not listed
so, and what the stages took.

Exit code 0 says that all passed, 1 that something failed.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from tests.support.record import RECORD, Result, read, read_slow, write
from tools import reruns
from tools.reruns import Rerun
from tools.slow_tests import unlisted

REPOSITORY = Path(__file__).resolve().parents[1]
MOST_RERUNS = 3
MOST_MORE = 4
"""By so many more processes than on an idle machine the tests run beside other work."""
MOST_NAMED = 5
"""So many slow tests that are not listed are named; beside other work, hundreds seem slow."""

NO_TESTS = 5
"""The exit code of pytest that says that no test was selected."""


@dataclass(frozen=True)
class Stage:
    """A run of pytest.

    Attributes:
        title: what it is called.
        marks: a test with these is run.
        jobs: in as many processes, and one more for each that the machine runs already.
        order: how they share the tests: ``load`` keeps the order, ``worksteal`` gives each process
            a part and moves tests at the end.
    """

    title: str
    marks: str
    jobs: int
    order: str


STAGES = (
    Stage("without ROS, compilers last", "not ros", 2, "load"),
    Stage("on ROS", "ros", 4, "worksteal"),
)


@dataclass
class Options:
    """What all stages share: arguments of pytest, and the files that are written."""

    arguments: Sequence[str]
    record: Path
    reruns: Path


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the stages; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, allow_abbrev=False)
    parser.add_argument("--record", type=Path, default=RECORD)
    parser.add_argument("--reruns", type=Path, default=reruns.default_path())
    parser.add_argument("--slowest", type=int, default=20, help="how many tests are listed")
    parser.add_argument("--began", type=float, default=time.time(), help="when make began")
    parser.add_argument("--ready", type=Path, help="a file that the set-up of the machine wrote")
    parser.add_argument("--only", choices=["ros", "rest"], help="only these stages")
    known, for_pytest = parser.parse_known_args(arguments)
    options = Options(for_pytest, known.record, known.reruns)
    results: dict[str, Result] = {}
    rows: list[tuple[str, float]] = []
    is_good = True
    for stage in STAGES:
        is_ros = stage.marks == "ros"
        if known.only is not None and is_ros != (known.only == "ros"):
            continue
        print(f"--- {stage.title}", flush=True)
        start = time.monotonic()
        code, found = _run(stage, options)
        if code == 1 and is_ros:
            code = 0 if _again(found, options) else 1
        is_good = is_good and code in (0, NO_TESTS)
        results |= found
        rows.append((stage.title, time.monotonic() - start))
    write(options.record, results)
    set_up = known.ready.stat().st_mtime - known.began if known.ready else 0.0
    _report(rows, results, known.slowest, known.began, set_up)
    return 0 if is_good else 1


def _run(stage: Stage, options: Options) -> tuple[int, dict[str, Result]]:
    """Run a stage; return pytest's exit code, and what became of each test."""
    count = stage.jobs + min(_running(), MOST_MORE)
    jobs = ["-n", str(count), "--dist", stage.order, "-m", stage.marks]
    return _pytest([*jobs, *options.arguments])


def _running() -> int:
    """Return how many other processes run or wait for a processor, which all get equal shares."""
    text = Path("/proc/loadavg").read_text(encoding="ascii")
    return int(text.split()[3].partition("/")[0]) - 1


def _pytest(arguments: Sequence[str]) -> tuple[int, dict[str, Result]]:
    with tempfile.TemporaryDirectory(prefix="deros-tests-") as folder:
        record = Path(folder) / "record.json"
        command = [sys.executable, "-m", "pytest", f"--record={record}", *arguments]
        code = subprocess.run(command, check=False).returncode
        return code, read(record) if record.exists() else {}


def _again(results: dict[str, Result], options: Options) -> bool:
    """Run the tests that failed once more, alone; return whether all is well.

    Args:
        results: of the tests on ROS; those of the second time take their place.
        options: those of the run.
    """
    failed = {test: result for test, result in results.items() if result.outcome == "failed"}
    if not failed or len(failed) > MOST_RERUNS:
        print(f"{len(failed)} tests on ROS failed; at most {MOST_RERUNS} are run once more")
        return False
    load = os.getloadavg()[0] / (os.cpu_count() or 1)
    print(f"--- once more, alone: {', '.join(failed)}", flush=True)
    alone = [each for each in options.arguments if not each.startswith("tests")]
    code, second = _pytest(["-n", "0", *alone, *failed])
    passed = [
        Rerun(test, first.text, first.seconds, second[test].seconds, load)
        for test, first in failed.items()
        if test in second and second[test].outcome == "passed"
    ]
    reruns.keep(passed, options.reruns)
    for rerun in passed:
        print(f"rerun: {rerun}", flush=True)
    results.update(second)
    return code == 0 and len(passed) == len(failed)


def _report(
    rows: Sequence[tuple[str, float]],
    results: Mapping[str, Result],
    slowest: int,
    began: float,
    set_up: float,
) -> None:
    """Print the slowest tests, those that are slow and not listed so, and where the time went."""
    by_time = sorted(results.items(), key=lambda each: -each[1].seconds)
    print(f"--- the {slowest} slowest of {len(results)} tests")
    for test, result in by_time[:slowest]:
        print(f"{result.seconds:8.1f} s  {test}")
    slow = unlisted(results, read_slow(REPOSITORY))
    if slow:
        worst = sorted(slow.items(), key=lambda each: -each[1])[:MOST_NAMED]
        named = ", ".join(f"{test} ({seconds:.1f} s)" for test, seconds in worst)
        more = f" and {len(slow) - MOST_NAMED} more" if len(slow) > MOST_NAMED else ""
        print(f"--- slow and not listed: {named}{more}, {sum(slow.values()):.0f} s in all")
        print("    if nothing ran beside the tests, python -m tools.slow_tests lists them")
    counts = Counter(result.outcome for result in results.values())
    parts = ", ".join(f"{title} {_minutes(seconds)}" for title, seconds in rows)
    state = f"cold, {_minutes(set_up)} of it for the set-up" if set_up > 0 else "warm"
    total = ", ".join(f"{counts[kind]} {kind}" for kind in ("passed", "failed", "skipped"))
    print(f"--- {total} in {_minutes(time.time() - began)} ({state}): {parts}", flush=True)


def _minutes(seconds: float) -> str:
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes} min {rest} s" if minutes else f"{rest} s"


if __name__ == "__main__":
    sys.exit(main())
