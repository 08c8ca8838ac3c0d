"""``tools/supervise.py`` leaves no process behind, however its command ends."""

from __future__ import annotations

import os
import select
import signal
import subprocess
import sys
from pathlib import Path

import pytest

SUPERVISE = Path(__file__).resolve().parents[2] / "tools" / "supervise.py"

# Starts a daemon in its own session, prints its pid, and then does as its argument says.
PARENT = """
import os, subprocess, sys, time
daemon = [sys.executable, "-c", "import time; time.sleep(600)"]
child = subprocess.Popen(daemon, start_new_session=True, stdout=subprocess.DEVNULL)
print(child.pid, os.getpid(), flush=True)
exec(sys.argv[1])
"""


def _start(then: str) -> tuple[subprocess.Popen[str], int, int]:
    command = [sys.executable, str(SUPERVISE), sys.executable, "-c", PARENT, then]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    daemon, parent = map(int, process.stdout.readline().split())
    return process, daemon, parent


def _gone(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return True
    return False


@pytest.mark.parametrize(("then", "code"), [("sys.exit(7)", 7), ("os.kill(os.getpid(), 9)", 137)])
def test_orphans_of_a_finished_command_are_stopped(then: str, code: int) -> None:
    """The exit code of the command is returned, and its daemon is stopped."""
    process, daemon, _ = _start(then)
    assert process.wait(timeout=30) == code
    assert _gone(daemon)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_signals_are_forwarded_to_the_command(number: signal.Signals) -> None:
    """A signal to the supervisor ends the command and its descendants."""
    process, daemon, parent = _start("time.sleep(600)")
    process.send_signal(number)
    assert process.wait(timeout=30) != 0
    assert _gone(daemon)
    assert _gone(parent)


def test_killed_supervisor_ends_its_command() -> None:
    """SIGKILL cannot be caught, but the kernel signals the command."""
    process, daemon, parent = _start("time.sleep(600)")
    watched = os.pidfd_open(parent)
    process.kill()
    process.wait(timeout=30)
    ended, _, _ = select.select([watched], [], [], 30)
    os.close(watched)
    os.kill(daemon, signal.SIGKILL)
    assert ended
