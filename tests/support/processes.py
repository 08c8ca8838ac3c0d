"""Processes that a test has left behind, and processes that it lets hang."""

from __future__ import annotations

import os
import signal
import time
from pathlib import Path

LIMIT = 30.0
"""Seconds in which a process stops; one that is held up in the kernel may take a while."""

_LOOK = 0.0005
"""Polling period in s: no event reports that the child of another process has stopped."""


def processes_with(text: str) -> list[int]:
    """Return the ids of the running processes that have ``text`` in their environment."""
    found = []
    for entry in Path("/proc").iterdir():
        if not entry.name.isdigit():
            continue
        try:
            environment = (entry / "environ").read_bytes()
        except OSError:
            continue  # it has ended meanwhile, or is not ours
        if text.encode() in environment:
            found.append(int(entry.name))
    return found


def freeze(pid: int) -> None:
    """Let a process hang, as a deadlock or a swapping machine would; return when it does.

    The signal alone stops nothing: each thread stops when it next comes out of the kernel, and
    until then it may publish another message.

    Raises:
        AssertionError: if the process ends, or does not stop in time.
    """
    os.kill(pid, signal.SIGSTOP)
    end = time.monotonic() + LIMIT
    while (states := thread_states(pid)) != {"T"}:
        assert not states <= {"X", "Z"}, f"process {pid} has ended"
        assert time.monotonic() < end, f"process {pid} does not stop: {states}"
        time.sleep(_LOOK)


def thaw(pid: int) -> None:
    """Let a process go on."""
    os.kill(pid, signal.SIGCONT)


def thread_states(pid: int) -> set[str]:
    """Return the states in which the threads of a process are, in the letters of proc(5)."""
    states = set()
    for task in Path(f"/proc/{pid}/task").glob("*/stat"):
        try:
            stat = task.read_text(encoding="utf-8", errors="replace")
        except OSError:
            continue  # the thread has ended
        states.add(stat.rpartition(")")[2].split()[0])
    return states
