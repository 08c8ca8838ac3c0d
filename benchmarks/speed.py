"""Whether the generated monitors have become slower since another version.

The throughput benchmark of this version and that of the other one measure the fourteen rules of the
paper's robot in turns, each with its own monitors beside those written by hand. What is compared
are the medians of the ratios to these, so that the machine cancels out. Exit code 1 says that a
monitor is more than 5 % slower than it was, beside what is written by hand.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console
from rich.table import Table
from support.progress import Line
from support.speed_results import Speed, earlier, medians, speeds_in
from support.throughput_rules import RULES_OF_A_ROBOT

REPOSITORY = Path(__file__).resolve().parents[1]
WANTED = {"Python": 1.05, "C": 1 / 1.25}
"""How many times as fast as a monitor by hand the generated one is to be."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure and print the table; return 1 if a monitor has become slower."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--against",
        help="a commit; by default the last tag, or else what was the newest a week ago",
    )
    parser.add_argument("--rounds", type=int, default=5, help="the medians of so many count")
    options = parser.parse_args(arguments)
    against = options.against or earlier(REPOSITORY)
    with tempfile.TemporaryDirectory(prefix="deros-speed-") as folder:
        trees = {"now": REPOSITORY}
        if against:
            trees["before"] = _tree(against, Path(folder) / "before")
        found: dict[str, list[dict[str, float]]] = {name: [] for name in trees}
        with Line(sys.stderr) as line:
            for number in range(1, options.rounds + 1):
                for name, tree in trees.items():
                    line.show(f"round {number} of {options.rounds}, {name}")
                    found[name].append(_measured(tree, Path(folder) / "rows.json"))
    speeds = medians(found)
    Console(width=None if sys.stdout.isatty() else 120).print(_table(speeds, against))
    for each in speeds:
        print(f"{each.language}: {_said(each)}")
    return 1 if any(each.is_slower for each in speeds) else 0


def _tree(commit: str, folder: Path) -> Path:
    """Return the files of a commit in a folder."""
    folder.mkdir()
    archive = subprocess.run(
        ["git", "archive", commit, "src", "benchmarks"],
        cwd=REPOSITORY,
        capture_output=True,
        check=False,
    )
    if archive.returncode:
        raise SystemExit(f"cannot compare with '{commit}': {archive.stderr.decode().strip()}")
    subprocess.run(["tar", "-x"], cwd=folder, input=archive.stdout, check=True)
    return folder


def _measured(tree: Path, results: Path) -> dict[str, float]:
    command = [sys.executable, str(tree / "benchmarks/throughput.py"), f"--json={results}"]
    command += [f"--rules={RULES_OF_A_ROBOT}", "--repeat=5"]
    path = {"PYTHONPATH": str(tree / "src")}
    done = subprocess.run(command, env={**os.environ, **path}, capture_output=True, check=False)
    if done.returncode:
        raise SystemExit(f"{' '.join(command)} failed:\n{done.stderr.decode()}")
    return speeds_in(json.loads(results.read_text(encoding="utf-8")))


def _table(speeds: Sequence[Speed], against: str) -> Table:
    table = Table(title="Generated monitors beside those written by hand", title_justify="left")
    for head in ("language", "speed", against or "no other version", "wanted"):
        table.add_column(head, justify="left" if head == "language" else "right")
    for each in speeds:
        before = "" if each.before is None else f"{each.before:.2f} x"
        style = "bold red" if each.is_slower else None
        wanted = f"{WANTED[each.language]:.2f} x"
        table.add_row(each.language, f"{each.now:.2f} x", before, wanted, style=style)
    return table


def _said(speed: Speed) -> str:
    before = "" if speed.before is None else f", was {speed.before:.2f}"
    return f"{speed.now:.2f} times the speed by hand{before}"


if __name__ == "__main__":
    sys.exit(main())
