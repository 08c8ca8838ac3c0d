"""Processes that use the processor, under the name of a node, and the kernel's clock of them."""

from __future__ import annotations

import contextlib
import ctypes
import os
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping, Sequence

_LOOK = 0.005
"""Polling period in s: no event reports that a process has used processor time."""
_LIMIT = 30.0

BURNS = """
import sys, time
share, period = float(sys.argv[1]), 0.02
print("burning", flush=True)
while True:
    began, used = time.monotonic(), time.process_time()
    while time.process_time() - used < share * period:
        pass
    time.sleep(max(0.0, period - (time.monotonic() - began)))
"""
"""A program that uses a share of a processor, as far as it gets that much."""

HAS_CHILD_BURN = f"""
import subprocess, sys
child = subprocess.Popen([sys.executable, "-c", {BURNS!r}, "1.0"], stdout=subprocess.PIPE)
child.stdout.readline()
print("burning", child.pid, flush=True)
sys.stdin.read()
child.kill()
"""
"""A program that starts another one, which burns, until its input ends."""

HAS_COPY = """
import os, sys
copy = os.fork()
if copy:
    print("burning", copy, flush=True)
    os.waitpid(copy, 0)
else:
    sys.stdin.read()
"""
"""A program with a copy of itself, until its input ends."""

STANDS_IN_FRONT = """
import subprocess, sys
program = subprocess.Popen(sys.argv[1:])
program.wait()
"""
"""A program that stands in front of another one, as a debugger does."""


def named(node: str) -> list[str]:
    """Return the words that give a program the full name of a node, as launch files do."""
    namespace, _, name = node.rpartition("/")
    return ["--ros-args", "-r", f"__node:={name}", "-r", f"__ns:={namespace or '/'}"]


@contextlib.contextmanager
def burning(
    node: str,
    share: float = 0.0,
    *,
    program: str = BURNS,
    before: Sequence[str] = (),
    env: Mapping[str, str] | None = None,
) -> Iterator[tuple[subprocess.Popen[str], list[str]]]:
    """Run a program as a node; give it, and the words that it has printed when it was up.

    Its processes end with the block: of copies and of what it stands in front of, by their input.
    """
    command = [*before, sys.executable, "-c", program, str(share), *named(node)]
    with subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=env
    ) as process:
        try:
            assert process.stdout is not None
            yield process, process.stdout.readline().split()
        finally:
            process.kill()


def processor_time(pid: int) -> float:
    """Return the processor time in s that the threads of a process have used.

    It is the kernel's clock of the process, clock_getcpuclockid(3), and not /proc.
    """
    clock = ctypes.c_int()
    found = ctypes.CDLL(None).clock_getcpuclockid(pid, ctypes.byref(clock))
    if found:
        raise ProcessLookupError(os.strerror(found))
    return time.clock_gettime(clock.value)


def until_used(pid: int, seconds: float) -> None:
    """Wait until a process has used that much more processor time."""
    target, end = processor_time(pid) + seconds, time.monotonic() + _LIMIT
    while processor_time(pid) < target:
        assert time.monotonic() < end, f"process {pid} does not use the processor"
        time.sleep(_LOOK)
