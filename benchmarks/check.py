"""How long ``deros check`` takes on big systems, from the start of the process to its end.

The floor, taken in the same run, is what no checker written in Python can go below: to start the
interpreter and to split the same text into words with one regular expression. What is to hold:
1,000 nodes in less than 1.5 s, and 10,000 nodes in less than 12 times that.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

from big_system import write

LIMIT_SECONDS = 1.5
LIMIT_GROWTH = 12.0

_FLOOR = r"""
import pathlib, re, sys
for path in pathlib.Path(sys.argv[1]).iterdir():
    re.findall(r'"[^"\n]*"|[\w/.]+|\S', path.read_text(encoding="utf-8"))
"""


@dataclass(frozen=True, slots=True)
class Row:
    """One size of system: how many nodes and lines, and the best times in seconds."""

    nodes: int
    lines: int
    seconds: float
    floor: float


def _best(command: list[str], repeat: int) -> float:
    """Return the shortest wall-clock time of a command that must succeed."""
    times = []
    for _ in range(repeat):
        start = time.perf_counter()
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        times.append(time.perf_counter() - start)
    return min(times)


def measure(nodes: int, repeat: int) -> Row:
    """Write a system of ``nodes`` nodes, and time the check and the floor on it."""
    with tempfile.TemporaryDirectory(prefix="deros-benchmark-") as folder:
        path = write(Path(folder), nodes)
        lines = len(path.read_text(encoding="utf-8").splitlines())
        check = [
            sys.executable,
            "-c",
            "from deros.cli.main import main; main()",
            "check",
            str(path),
        ]
        seconds = _best(check, repeat)
        floor = _best([sys.executable, "-c", _FLOOR, folder], repeat)
    return Row(nodes, lines, seconds, floor)


def main() -> int:
    """Print the table; return 1 when a limit is passed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--nodes", type=int, nargs="+", default=[100, 1000, 10_000])
    parser.add_argument("--repeat", type=int, default=3, help="the best of so many runs counts")
    arguments = parser.parse_args()

    print(f"{'nodes':>7} {'lines':>8} {'check s':>9} {'floor s':>9} {'ratio':>7} {'ms/node':>9}")
    rows = {}
    for nodes in arguments.nodes:
        row = rows[nodes] = measure(nodes, arguments.repeat)
        print(
            f"{row.nodes:>7} {row.lines:>8} {row.seconds:>9.3f} {row.floor:>9.3f} "
            f"{row.seconds / row.floor:>7.1f} {1000 * row.seconds / row.nodes:>9.3f}",
            flush=True,
        )
    held = True
    if 1000 in rows:
        seconds = rows[1000].seconds
        held = seconds < LIMIT_SECONDS
        print(f"1,000 nodes: {seconds:.2f} s (limit {LIMIT_SECONDS} s)")
        if 10_000 in rows:
            growth = rows[10_000].seconds / seconds
            held = held and growth < LIMIT_GROWTH
            print(f"10,000 nodes: {growth:.1f} times that (limit {LIMIT_GROWTH:.0f})")
    return 0 if held else 1


if __name__ == "__main__":
    sys.exit(main())
