"""Runs of ``deros`` as a process, with the time and memory that they take."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import threading
from dataclasses import dataclass
from pathlib import Path

_KILLED_AFTER_S = 300.0
_STARTER = """\
import resource, sys
resource.setrlimit(resource.RLIMIT_AS, (3 << 30, 3 << 30))
resource.setrlimit(resource.RLIMIT_CPU, (60, 60))
from deros.cli.main import main
sys.argv[0] = "deros"
main()
"""


@dataclass(frozen=True)
class Measured:
    """How a run ended.

    Attributes:
        code: its exit code; negative where a signal ended it.
        out: what it printed, on both streams.
        seconds: of processor time.
        peak_mb: the most memory it had.
    """

    code: int
    out: str
    seconds: float
    peak_mb: float


def run(*arguments: object, folder: Path | None = None) -> Measured:
    """Run ``deros`` and measure it."""
    command = [sys.executable, "-c", _STARTER, *map(str, arguments)]
    with tempfile.TemporaryFile() as out:
        process = subprocess.Popen(
            command, stdin=subprocess.DEVNULL, stdout=out, stderr=out, cwd=folder
        )
        watchdog = threading.Timer(_KILLED_AFTER_S, process.kill)
        watchdog.start()
        _, status, usage = os.wait4(process.pid, 0)
        watchdog.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0)
        text = out.read().decode(errors="replace")
    seconds = usage.ru_utime + usage.ru_stime
    return Measured(process.returncode, text, seconds, usage.ru_maxrss / 1024)
