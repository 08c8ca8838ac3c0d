"""Faults that only the C library can fake: a stepped wall clock, a full disk, no more threads.

Each is a small library that is built when a test needs it and loaded into the process under test
alone, by LD_PRELOAD; the machine's own clock and disks are left alone.
"""

from __future__ import annotations

import mmap
import struct
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

_SOURCES = Path(__file__).with_name("shims")
_STRICT = ["-Wall", "-Wextra", "-Werror", "-O2"]
# Looking up a function by its first call would take kilobytes of the stack that it is called on.
_LIBRARY = ["-shared", "-fPIC", "-Wl,-z,now"]


def build_shim(name: str, folder: Path, *options: str) -> str:
    """Build one of the libraries into a folder with gcc, and return its path."""
    library = folder / f"{name}.so"
    source = _SOURCES / f"{name}.c"
    command = ["gcc", *_STRICT, *_LIBRARY, *options, "-o", str(library), str(source), "-ldl"]
    subprocess.run(command, check=True)
    return str(library)


class WallClock:
    """The wall clock of the processes that are started with :attr:`env`."""

    def __init__(self, folder: Path) -> None:
        """Begin with the time that it really is."""
        offset = folder / "wall_clock_offset"
        offset.write_bytes(struct.pack("=q", 0))
        with offset.open("r+b") as file:
            self._offset = memoryview(mmap.mmap(file.fileno(), 0)).cast("q")
        self.env = {"LD_PRELOAD": build_shim("clock", folder), "WALL_CLOCK_OFFSET": str(offset)}

    def step(self, seconds: int) -> None:
        """Set the clock to the real time plus so many seconds, in all running processes at once."""
        self._offset[0] = seconds


class Disk:
    """The disk under one folder, for the processes that are started with :attr:`env`."""

    def __init__(self, folder: Path, library: Path) -> None:
        """Begin with space enough; the library is built into another folder."""
        self._full = library / "disk_full"
        self._fillings = 0
        self.env = {
            "LD_PRELOAD": build_shim("disk", library),
            "DISK": str(folder.resolve()),
            "DISK_FULL": str(self._full),
        }

    def fill(self) -> None:
        """Let every write fail from now on."""
        self._fillings += 1
        self._full.touch()

    def clear(self) -> None:
        """Let writes succeed again, once it was called as often as :meth:`fill`."""
        self._fillings -= 1
        if self._fillings == 0:
            self._full.unlink()


class Threads:
    """The threads of the processes that are started with :attr:`env`."""

    def __init__(self, folder: Path) -> None:
        """Begin with threads enough."""
        self._refused = folder / "threads_refused"
        self.env = {
            "LD_PRELOAD": build_shim("threads", folder),
            "THREADS_REFUSED": str(self._refused),
        }

    @contextmanager
    def refused(self) -> Iterator[None]:
        """Let no thread be made within the block."""
        self._refused.touch()
        yield
        self._refused.unlink()
