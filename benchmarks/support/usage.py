"""What a process takes of the machine, and the machine's host of it, as Linux counts it."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
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


def stolen_ns() -> int:
    """Return the time that a processor was wanted but not given, averaged over all, in ns.

    On a virtual machine that is what its host has given to others meanwhile ("steal", proc(5)), if
    the host tells; elsewhere it is 0.
    """
    total = Path("/proc/stat").read_text(encoding="ascii").splitlines()[0]
    ticks = int(total.split()[8])
    return ticks * 1_000_000_000 // os.sysconf("SC_CLK_TCK") // (os.cpu_count() or 1)


@dataclass(frozen=True, slots=True)
class Meter:
    """Measures what is taken of a processor, from :meth:`start` on.

    Attributes:
        counter: returns the time taken so far, in ns.
    """

    counter: Callable[[], int]
    since_ns: int
    taken_ns: int

    @classmethod
    def start(cls, counter: Callable[[], int]) -> Meter:
        """Begin now."""
        return cls(counter, time.monotonic_ns(), counter())

    def percent(self) -> float:
        """Return what was taken so far, in percent of one processor."""
        taken = self.counter() - self.taken_ns
        return 100.0 * taken / (time.monotonic_ns() - self.since_ns)
