"""One node, or another process, at run time."""

from __future__ import annotations

import contextlib
import enum
import functools
import os
from pathlib import Path
import signal
import subprocess
import time

from .guard import Guard, signal_group
from .node import Program, Row
from .programs import starts_quietly

YOUNG = 10.0  # seconds for which Python may still be importing
PIPE_CAPACITY = 1 << 16  # bytes, of Linux; a line that is longer goes out in pieces


class State(enum.Enum):
    """The state of a node."""

    WAITING = 'waiting'  # for the moment of its start
    RUNNING = 'running'
    STOPPING = 'stopping'
    ENDED = 'ended'  # for good


class Process:
    """A program of the table and its process group, across restarts."""

    def __init__(self, node: Row, label: str, command: list[str]) -> None:
        """Set the command, without starting it."""
        self.node = node
        self.label = label
        self.command = command
        self.state = State.WAITING
        self.due: float | None = 0.0  # monotonic time to go on; None: when something happens
        self.awaited: Process | None = None  # whose exit comes before its first start
        self.restarts = 0
        self.signals_sent = 0
        self.since = 0.0  # monotonic time of its last start
        self.patient_until = 0.0  # monotonic time at which it is told to stop, up or not
        self.told_at_its_start = False  # it was told to stop before it was up
        self.group = 0
        self.ticket = 0  # under which the guard knows the group
        self.exit_code: int | None = None  # the program's own; others of its group may live on
        self.end = 'not started'  # how it ended last, in words
        self.pipe: int | None = None
        self.standard_input: int = subprocess.DEVNULL
        self._unfinished = b''

    def start(self, environment: dict[str, str], guard: Guard) -> int:
        """
        Start the program as the first of a new session and return where its output is read.

        Raises OSError when it cannot be run.
        """
        self.ticket = guard.ticket()
        folder = self.node.folder if isinstance(self.node, Program) else ''
        blocked = [signal.SIGINT] if starts_quietly(self.command) else []
        read, write = os.pipe()
        try:
            with guard.signals_held():
                started = subprocess.Popen(
                    self.command,
                    stdin=self.standard_input,
                    stdout=write,
                    stderr=write,
                    env={**environment, **self.node.environment},
                    cwd=folder or None,
                    start_new_session=True,
                    pass_fds=guard.inherited,
                    preexec_fn=functools.partial(guard.enrol, blocked),
                )
        except BaseException:
            os.close(read)
            raise
        finally:
            os.close(write)
        started.returncode = 0  # it is reaped together with all the others, not through Popen
        os.set_blocking(read, False)
        self.group, self.pipe, self.since = started.pid, read, time.monotonic()
        self.state, self.due, self.exit_code, self.signals_sent = State.RUNNING, None, None, 0
        return read

    def still_importing(self) -> bool:
        """Tell whether a SIGINT would probably meet Python among its imports, as an exception."""
        young = time.monotonic() - self.since < YOUNG
        return young and starting(self.group) and _is_python(self.group)

    def send(self, number: int) -> float:
        """Send a stop signal; return the seconds that it may take longer than others to stop."""
        node = self.node
        longer = node.time_to_stop if isinstance(node, Program) else 0.0
        if longer and number == signal.SIGINT and self.exit_code is None:
            os.kill(self.group, number)  # a second one to what it started could disturb its end
            return longer
        signal_group(self.group, number)
        return 0.0

    def gone(self) -> bool:
        """Return whether the program has ended and its group is empty."""
        return self.exit_code is not None and not signal_group(self.group, 0)

    def read(self) -> tuple[list[bytes], bool]:
        """Return the received lines, without line ends, and whether more may follow."""
        assert self.pipe is not None
        try:
            data = os.read(self.pipe, PIPE_CAPACITY)
        except BlockingIOError:
            return [], True
        *lines, self._unfinished = (self._unfinished + data).split(b'\n')
        if not data or len(self._unfinished) >= PIPE_CAPACITY:
            lines += self._finish()
        return lines, bool(data)

    def close(self) -> list[bytes]:
        """Close the pipe and return the lines that were still in it."""
        if self.pipe is None:
            return []
        lines, _ = self.read()
        os.close(self.pipe)
        self.pipe = None
        return lines + self._finish()

    def _finish(self) -> list[bytes]:
        line, self._unfinished = self._unfinished, b''
        return [line] if line else []


def starting(pid: int) -> bool:
    """
    Tell whether a program is not up yet: Python from its first instruction handles SIGINT alone.

    A node of ROS 2 handles SIGTERM as well, from its initialization on.
    """
    try:
        text = Path(f'/proc/{pid}/status').read_text(encoding='utf-8', errors='replace')
        caught = int(text.partition('SigCgt:')[2].split()[0], 16)
    except (OSError, LookupError):
        return False
    return bool(caught & 1 << signal.SIGINT - 1) and not caught & 1 << signal.SIGTERM - 1


def _is_python(pid: int) -> bool:
    try:
        return Path(f'/proc/{pid}/exe').readlink().name.startswith('python')
    except OSError:
        return False


def describe(exit_code: int) -> str:
    """Return how a program ended, in words."""
    if exit_code == 0:
        return 'ended'
    if exit_code > 0:
        return f'exited with code {exit_code}'
    with contextlib.suppress(ValueError):
        return f'was killed by {signal.Signals(-exit_code).name}'
    return f'was killed by signal {-exit_code}'
