"""Processor time of ``deros check`` on models that are as long or as strange as models can be.

The floor, taken in the same run, is to start the interpreter and to split the same text into words
with one regular expression. What is to hold: no model takes 5 s.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from support.extreme_models import MODELS

LIMIT_SECONDS = 5.0

_CHECK = "from deros.cli.main import main; main()"
_FLOOR = r"""
import pathlib, re, sys
re.findall(r'"[^"\n]*"|[\w/.]+|\S', pathlib.Path(sys.argv[1]).read_text(encoding="utf-8"))
"""


def _seconds(*command: str) -> float:
    """Return the processor time of a command, which may find faults in the model."""
    process = subprocess.Popen(
        [sys.executable, "-c", *command], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode not in (0, 1, 2):
        raise RuntimeError(f"{command} ended with {process.returncode}")
    return usage.ru_utime + usage.ru_stime


def main() -> int:
    """Print the table; return 1 when a limit is passed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeat", type=int, default=3, help="the best of so many runs counts")
    arguments = parser.parse_args()

    print(f"{'model':<32} {'KB':>7} {'check s':>9} {'floor s':>9} {'ratio':>7}")
    worst = 0.0
    with tempfile.TemporaryDirectory(prefix="deros-benchmark-") as folder:
        for name, (suffix, text, _) in MODELS.items():
            path = Path(folder) / f"model{suffix}"
            path.write_text(text(), encoding="utf-8")
            turns = range(arguments.repeat)
            seconds = min(_seconds(_CHECK, "check", str(path)) for _ in turns)
            floor = min(_seconds(_FLOOR, str(path)) for _ in turns)
            worst = max(worst, seconds)
            print(
                f"{name:<32} {path.stat().st_size // 1000:>7,} {seconds:>9.3f} {floor:>9.3f} "
                f"{seconds / floor:>7.1f}",
                flush=True,
            )
            path.unlink()
    print(f"the longest: {worst:.2f} s (limit {LIMIT_SECONDS} s)")
    return 0 if worst < LIMIT_SECONDS else 1


if __name__ == "__main__":
    sys.exit(main())
