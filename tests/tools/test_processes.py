"""Process control in the fault tests: each effect is complete when the call returns."""

from __future__ import annotations

import contextlib
import mmap
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.support.processes import freeze, thread_states
from tests.support.victims import Process

COUNTERS = 8

# Each thread spends its time in the kernel, writing to a file that is mapped in the test.
WRITER = f"""\
import os, sys, threading
file = os.open(sys.argv[1], os.O_RDWR)
block = bytes(1 << 22)
def write(place):
    number = 0
    while True:
        os.pwrite(file, block, (place + 1) << 22)
        number += 1
        os.pwrite(file, number.to_bytes(8, sys.byteorder), 8 * place)
for place in range({COUNTERS}):
    threading.Thread(target=write, args=[place], daemon=True).start()
print("ready", flush=True)
sys.stdin.read()
"""


@contextlib.contextmanager
def killed(process: Process) -> Iterator[Process]:
    """Return a process that is killed at the end, frozen or not."""
    try:
        yield process
    finally:
        process.kill()


def test_frozen_process_is_completely_stopped(tmp_path: Path) -> None:
    """When the call returns, no thread runs, and none completes a pending operation."""
    file = tmp_path / "counters"
    file.write_bytes(bytes(mmap.PAGESIZE))
    command = [sys.executable, "-c", WRITER, str(file)]
    with (
        file.open("r+b") as opened,
        mmap.mmap(opened.fileno(), mmap.PAGESIZE) as counters,
        killed(Process(command, os.environ, tmp_path / "log", subprocess.PIPE)) as process,
    ):
        while "ready" not in process.output():
            assert process.popen.poll() is None
        for _ in range(20):
            process.freeze()
            seen = counters[: 8 * COUNTERS]
            assert thread_states(process.popen.pid) == {"T"}
            os.sched_yield()
            assert counters[: 8 * COUNTERS] == seen
            process.thaw()


def test_ended_process_cannot_be_frozen() -> None:
    """The calling test has lost its subject."""
    with subprocess.Popen([sys.executable, "-c", ""]) as process:
        os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)
        with pytest.raises(AssertionError, match="has ended"):
            freeze(process.pid)
