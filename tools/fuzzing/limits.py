"""Limits on one mutant that are measured: processor time, memory at its peak, memory kept.

Processor time, because a busy machine must not make a mutant look slow. A timer of the process
interrupts Python code where it is, so that the place of a hang is known; what hangs within a
regular expression or a system call is found by the watchdog of :mod:`tools.fuzzing.pool`.
"""

from __future__ import annotations

import gc
import resource
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import FrameType

_MB = 1 << 20


@dataclass(frozen=True)
class Limits:
    """What one mutant of the size of an example may take.

    Attributes:
        seconds: of processor time.
        peak_mb: by which the memory of the process may grow at its peak.
        kept_mb: by which it may have grown after all mutants of one process, some warm-up apart.
        total_mb: what the process can allocate at all.
    """

    seconds: float = 5.0
    peak_mb: int = 200
    kept_mb: int = 150
    total_mb: int = 1500


class TooSlow(BaseException):
    """A mutant takes longer than it may; nothing that catches ``Exception`` keeps it."""


class TooMuch(Exception):  # noqa: N818 - it is a measurement, and no fault of the program
    """A mutant took, or the mutants kept, more memory than they may."""


def enforce(limits: Limits) -> None:
    """Keep this process from allocating more than it may, and let the timer interrupt it."""
    resource.setrlimit(resource.RLIMIT_AS, (limits.total_mb * _MB, limits.total_mb * _MB))
    signal.signal(signal.SIGPROF, _interrupt)


def _interrupt(_number: int, _frame: FrameType | None) -> None:
    raise TooSlow("took too long")


@contextmanager
def limited(limits: Limits) -> Iterator[None]:
    """Run the block of one mutant within its limits.

    Raises:
        TooSlow: when the block takes more processor time.
        TooMuch: when it ends, and the process had grown too much at its peak.
    """
    before = peak_mb()
    signal.setitimer(signal.ITIMER_PROF, limits.seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
    grown = peak_mb() - before
    if grown > limits.peak_mb:
        raise TooMuch(f"took {grown:.0f} MB at its peak")


def peak_mb() -> float:
    """Return the most memory that this process ever had.

    The peak that getrusage() returns includes the memory of the parent process before exec.
    """
    return _status_kb("VmHWM") / 1024


def _status_kb(field: str) -> int:
    status = Path("/proc/self/status").read_text(encoding="ascii", errors="replace")
    line = next(each for each in status.splitlines() if each.startswith(f"{field}:"))
    return int(line.split()[1])


def kept_mb() -> float:
    """Return the memory that this process has, garbage collected."""
    gc.collect()
    return _status_kb("VmRSS") / 1024


@dataclass(frozen=True)
class Usage:
    """What the kernel says of another process: its processor time, and whether it could run."""

    seconds: float
    runnable: bool


def usage(pid: int) -> Usage | None:
    """Return the usage of another process, or ``None`` if it is gone."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return None
    return Usage((int(fields[11]) + int(fields[12])) / _TICKS, fields[0] == "R")


_TICKS = 100  # of the kernel's user interface, on every Linux
