"""What a process takes of the machine, and the machine's host of it, as Linux counts it."""

from __future__ import annotations

import os
import time
from dataclasses import dataclass
from pathlib import Path

_CPUCLOCK_SCHED = 2


def processor_time_ns(pid: int) -> int:
    """Return the processor time that all threads of a process have taken so far, in ns.

    It is exact, unlike what /proc shows, which comes in ticks of 10 ms. The number of a process's
    clock is part of the kernel's interface (clock_getcpuclockid(3), MAKE_PROCESS_CPUCLOCK).

    Raises:
        OSError: if there is no such process.
    """
    return time.clock_gettime_ns((~pid << 3) | _CPUCLOCK_SCHED)


def memory_mib(pid: int) -> float:
    """Return how much memory of a process is resident, in MiB.

    Raises:
        OSError: if there is no such process.
    """
    for line in Path(f"/proc/{pid}/status").read_text(encoding="ascii").splitlines():
        if line.startswith("VmRSS:"):
            return int(line.split()[1]) / 1024
    raise ProcessLookupError(f"process {pid} has ended")


def stolen_s() -> float:
    """Return the processor time that was wanted but not given, all processors together, in s.

    On a virtual machine that is what its host has given to others meanwhile ("steal", proc(5)), if
    the host tells; elsewhere it is 0.
    """
    total = Path("/proc/stat").read_text(encoding="ascii").splitlines()[0]
    return int(total.split()[8]) / os.sysconf("SC_CLK_TCK")


@dataclass(frozen=True, slots=True)
class Theft:
    """Measures what a virtual machine's host takes of its processors, from :meth:`start` on."""

    since_ns: int
    stolen_s: float

    @classmethod
    def start(cls) -> Theft:
        """Begin now."""
        return cls(time.monotonic_ns(), stolen_s())

    def percent(self) -> float:
        """Return how much was taken so far, in percent of all processors."""
        seconds = (time.monotonic_ns() - self.since_ns) / 1e9
        return 100.0 * (stolen_s() - self.stolen_s) / (seconds * (os.cpu_count() or 1))


@dataclass(frozen=True, slots=True)
class Meter:
    """Measures the processor's use by one process, from :meth:`start` on."""

    pid: int
    since_ns: int
    taken_ns: int

    @classmethod
    def start(cls, pid: int) -> Meter:
        """Begin now."""
        return cls(pid, time.monotonic_ns(), processor_time_ns(pid))

    def percent(self) -> float:
        """Return the use so far, in percent of one core."""
        taken = processor_time_ns(self.pid) - self.taken_ns
        return 100.0 * taken / (time.monotonic_ns() - self.since_ns)
