"""How long ``deros check`` takes on big systems, from the start of the process to its end.

The floor, taken in the same run, is what no checker written in Python can go below: to start the
interpreter and to split the same text into words with one regular expression. What is to hold:
1,000 nodes in less than 1.5 s; 10,000 nodes in less than 12 times that, also in 200 files with
30,000 topics; and any model in less than 1 s if nothing has changed since the last check.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

from big_system import write, write_in_files

LIMIT_SECONDS = 1.5
LIMIT_GROWTH = 12.0
LIMIT_AGAIN_SECONDS = 1.0
FILES = 200

_FLOOR = r"""
import pathlib, re, sys
for path in pathlib.Path(sys.argv[1]).iterdir():
    re.findall(r'"[^"\n]*"|[\w/.]+|\S', path.read_text(encoding="utf-8"))
"""


@dataclass(frozen=True, slots=True)
class Row:
    """One system: how many nodes, files and lines, and the best times in seconds.

    ``again``: of a check when nothing has changed since the last one.
    """

    nodes: int
    files: int
    lines: int
    seconds: float
    again: float
    floor: float


def _best(command: list[str], repeat: int, cache: str = os.devnull) -> float:
    """Return the shortest wall-clock time of a command that must succeed, run as installed."""
    times = []
    environment = {**os.environ, "XDG_CACHE_HOME": cache}
    # An installer compiles the modules; else Python does so once, unless it is told not to.
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    for _ in range(repeat):
        start = time.perf_counter()
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, env=environment)
        times.append(time.perf_counter() - start)
    return min(times)


def measure(nodes: int, files: int, repeat: int) -> Row:
    """Write a system of ``nodes`` nodes, and time the checks and the floor on it.

    Args:
        nodes: how many; about a hundred lines for ten of them.
        files: how many systems it consists of; 1: it is one.
        repeat: the best of so many runs counts.
    """
    with tempfile.TemporaryDirectory(prefix="deros-benchmark-") as place:
        folder = Path(place, "models")
        folder.mkdir()
        path = write(folder, nodes) if files == 1 else write_in_files(folder, nodes, files)
        lines = sum(len(each.read_text("utf-8").splitlines()) for each in folder.glob("*.system"))
        start = "from deros.cli.main import main; main()"
        check = [sys.executable, "-c", start, "check", str(path)]
        seconds = _best(check, repeat)
        _best(check, 1, place)
        again = _best(check, repeat, place)
        floor = _best([sys.executable, "-c", _FLOOR, str(folder)], repeat)
    return Row(nodes, files, lines, seconds, again, floor)


def main() -> int:
    """Print the table; return 1 when a limit is passed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--nodes", type=int, nargs="+", default=[100, 1000, 10_000])
    parser.add_argument("--repeat", type=int, default=3, help="the best of so many runs counts")
    arguments = parser.parse_args()

    print(
        f"{'nodes':>7} {'files':>6} {'lines':>8} {'check s':>9} {'again s':>9} {'floor s':>9}"
        f" {'ratio':>7} {'ms/node':>9}"
    )
    rows = {}
    sizes = [(nodes, 1) for nodes in arguments.nodes]
    sizes += [(nodes, FILES) for nodes in arguments.nodes if nodes >= 10_000]
    for nodes, files in sizes:
        row = rows[nodes, files] = measure(nodes, files, arguments.repeat)
        print(
            f"{row.nodes:>7} {row.files:>6} {row.lines:>8} {row.seconds:>9.3f} {row.again:>9.3f}"
            f" {row.floor:>9.3f} {row.seconds / row.floor:>7.1f}"
            f" {1000 * row.seconds / row.nodes:>9.3f}",
            flush=True,
        )
    again = max(row.again for row in rows.values())
    held = again < LIMIT_AGAIN_SECONDS
    print(f"nothing changed: {again:.2f} s at most (limit {LIMIT_AGAIN_SECONDS:.0f} s)")
    if (1000, 1) in rows:
        seconds = rows[1000, 1].seconds
        held = held and seconds < LIMIT_SECONDS
        print(f"1,000 nodes: {seconds:.2f} s (limit {LIMIT_SECONDS} s)")
        for (nodes, files), row in rows.items():
            if nodes == 10_000:
                growth = row.seconds / seconds
                held = held and growth < LIMIT_GROWTH
                where = f" in {files} files" if files > 1 else ""
                print(f"10,000 nodes{where}: {growth:.1f} times that (limit {LIMIT_GROWTH:.0f})")
    return 0 if held else 1


if __name__ == "__main__":
    sys.exit(main())
