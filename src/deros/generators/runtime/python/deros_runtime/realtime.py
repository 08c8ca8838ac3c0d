"""Real-time process settings of Linux, each independent of the others."""

from __future__ import annotations

from collections.abc import Iterator
import contextlib
import ctypes
import gc
import os
from pathlib import Path
import resource
import stat
import sys

PR_SET_TIMERSLACK = 29
MCL_CURRENT, MCL_FUTURE = 1, 2
ON_LINUX = sys.platform.startswith('linux')


def minimize_timer_slack() -> None:
    """Reduce the timer slack of this thread, and of those it starts, from 50 us to 1 ns."""
    if ON_LINUX:
        ctypes.CDLL(None).prctl(PR_SET_TIMERSLACK, 1, 0, 0, 0)


def make_output_nonblocking() -> None:
    """
    Discard output to a full pipe rather than wait until it is read.

    A launcher that hangs would block the node, too. The pipes are reopened, because the flag would
    otherwise apply to every process that shares them.
    """
    for number in (1, 2):
        with contextlib.suppress(OSError):  # closed, or of another user: it stays as it is
            if stat.S_ISFIFO(os.fstat(number).st_mode):
                opened = os.open(f'/proc/self/fd/{number}', os.O_WRONLY | os.O_NONBLOCK)
                os.dup2(opened, number)
                os.close(opened)


def configure_process(priority: int, lock_memory: bool, garbage_collection: bool) -> list[str]:
    """
    Apply the parameters of the process; return a message for each that is not permitted.

    A priority above 0 puts all threads under the scheduling policy SCHED_FIFO. Locked memory is
    never paged out. Without garbage collection, cycles of objects stay until the process ends.
    """
    if not garbage_collection:
        gc.disable()
    refusals = list(_raise_priority(priority)) if priority > 0 else []
    if lock_memory:
        refusals += _lock_memory()
    return refusals


def _raise_priority(priority: int) -> Iterator[str]:
    """Change all present threads; those started later inherit the policy."""
    try:
        settings = os.sched_param(priority)
        for thread in Path('/proc/self/task').iterdir():
            with contextlib.suppress(ProcessLookupError):  # the thread has ended meanwhile
                os.sched_setscheduler(int(thread.name), os.SCHED_FIFO, settings)
    except (OSError, AttributeError) as error:
        yield f'realtime_priority {priority} is not permitted: {error}'


def can_lock_memory() -> bool:
    """Return whether locked memory can grow: with a limit, later allocations would fail."""
    limit, _ = resource.getrlimit(resource.RLIMIT_MEMLOCK)
    return limit == resource.RLIM_INFINITY or os.geteuid() == 0


def _lock_memory() -> Iterator[str]:
    if not ON_LINUX:
        yield f'lock_memory is not there on {sys.platform}'
        return
    if not can_lock_memory():
        yield 'lock_memory is not permitted: it needs an unlimited RLIMIT_MEMLOCK'
        return
    library = ctypes.CDLL(None, use_errno=True)
    if library.mlockall(MCL_CURRENT | MCL_FUTURE) != 0:
        yield f'lock_memory is not permitted: {os.strerror(ctypes.get_errno())}'
