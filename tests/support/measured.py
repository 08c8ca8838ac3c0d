"""Runs of ``deros`` as a process, with the memory that they take."""

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
import atexit, os, resource, sys
def report(file=int(sys.argv.pop(1))):
    lines = open("/proc/self/status").read().splitlines()
    os.write(file, next(each for each in lines if each.startswith("VmHWM")).encode())
atexit.register(report)
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
        peak_mb: the most memory it had.
    """

    code: int
    out: str
    peak_mb: float


def run(*arguments: object, folder: Path | None = None) -> Measured:
    """Run ``deros`` and measure it; a minute of processor time ends it, as a hang."""
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as peak:
        command = [sys.executable, "-c", _STARTER, str(peak.fileno()), *map(str, arguments)]
        process = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=out,
            stderr=out,
            cwd=folder,
            pass_fds=[peak.fileno()],
        )
        watchdog = threading.Timer(_KILLED_AFTER_S, process.kill)
        watchdog.start()
        _, status, usage = os.wait4(process.pid, 0)
        watchdog.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0)
        text = out.read().decode(errors="replace")
        peak.seek(0)
        reported = peak.read().split()
    # The kernel's figure begins with the memory of this process, so it serves only where the
    # process could not report its own.
    peak_kb = int(reported[1]) if reported else usage.ru_maxrss
    return Measured(process.returncode, text, peak_kb / 1024)
