"""A terminal of a given size, in which a program runs."""

from __future__ import annotations

import fcntl
import os
import pty
import re
import select
import struct
import subprocess
import termios
import time
from collections.abc import Callable, Mapping, Sequence

from tests.support.ros import LIMIT

_CONTROL = re.compile(r"\x1b\[[0-?]*[ -/]*[@-~]")
_HOME = "\x1b[H"
SECOND_SCREEN, FIRST_SCREEN = "\x1b[?1049h", "\x1b[?1049l"


class Terminal:
    """A program in a terminal of its own; it is killed when the block ends.

    Attributes:
        output: all that has been written to the terminal up to now.
    """

    def __init__(self, command: Sequence[str], env: Mapping[str, str], size: tuple[int, int]):
        """Start the program; the size is columns and lines."""
        self._ours, theirs = pty.openpty()
        self.resize(size)
        own = {name: value for name, value in env.items() if name not in ("COLUMNS", "LINES")}
        self._process = subprocess.Popen(
            command, env=own, stdin=theirs, stdout=theirs, stderr=theirs, start_new_session=True
        )
        os.close(theirs)
        self.output = ""

    def __enter__(self) -> Terminal:
        """Return the terminal."""
        return self

    def __exit__(self, *_: object) -> None:
        """Kill the program, if it still runs, and close the terminal."""
        self._process.kill()
        self._process.wait(LIMIT)
        os.close(self._ours)

    def resize(self, size: tuple[int, int]) -> None:
        """Change the size: columns and lines."""
        columns, lines = size
        fcntl.ioctl(self._ours, termios.TIOCSWINSZ, struct.pack("HHHH", lines, columns, 0, 0))

    def pictures(self) -> list[list[str]]:
        """Return the pictures that were drawn completely, each as lines without colours."""
        drawn = self.output.split(_HOME)[1:-1]
        return [_CONTROL.sub("", each).replace("\r", "").split("\n") for each in drawn]

    def until(self, condition: Callable[[list[str]], bool]) -> list[str]:
        """Wait until a picture meets a condition, and return it.

        Raises:
            AssertionError: if none does in time, or the program ends.
        """
        seen, end = len(self.pictures()), time.monotonic() + LIMIT
        while time.monotonic() < end:
            if not self._read():
                break
            for picture in self.pictures()[seen:]:
                if condition(picture):
                    return picture
        raise AssertionError(f"the awaited picture was not drawn; the last: {self.output[-4000:]}")

    def end(self, number: int) -> int:
        """Send a signal, read all that is written, and return the exit code."""
        self._process.send_signal(number)
        while self._read():
            pass
        return self._process.wait(LIMIT)

    def _read(self) -> bool:
        """Read what comes next; return whether there may be more."""
        ready, _, _ = select.select([self._ours], [], [], LIMIT)
        assert ready, "the program writes nothing"
        try:
            data = os.read(self._ours, 1 << 16)
        except OSError:  # the other end is closed
            return False
        self.output += data.decode("utf-8", errors="replace")
        return bool(data)
