"""Faults that only the C library can fake: a stepped wall clock, a full disk.

Each is a small library that is built when a test needs it and loaded into the process under test
alone, by LD_PRELOAD; the machine's own clock and disks are left alone.
"""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

_SOURCES = Path(__file__).with_name("shims")
_STRICT = ["-Wall", "-Wextra", "-Werror", "-O2", "-shared", "-fPIC"]


def _built(name: str, folder: Path) -> str:
    """Build one of the libraries into a folder, and return its path."""
    compiler = shutil.which("gcc") or shutil.which("cc")
    if compiler is None:
        pytest.skip("there is no C compiler to build the library that fakes the fault")
    library = folder / f"{name}.so"
    source = _SOURCES / f"{name}.c"
    subprocess.run([compiler, *_STRICT, "-o", str(library), str(source), "-ldl"], check=True)
    return str(library)


class WallClock:
    """The wall clock of the processes that are started with :attr:`env`."""

    def __init__(self, folder: Path) -> None:
        """Begin with the time that it really is."""
        self._offset = folder / "wall_clock_offset"
        self.step(0)
        self.env = {
            "LD_PRELOAD": _built("clock", folder),
            "WALL_CLOCK_OFFSET": str(self._offset),
        }

    def step(self, seconds: int) -> None:
        """Set the clock to the real time plus so many seconds, in all running processes at once."""
        # One write within one page: a reader sees the old text or the new one.
        with self._offset.open("r+" if self._offset.exists() else "w") as file:
            file.write(f"{seconds:<20}")


class Disk:
    """The disk under one folder, for the processes that are started with :attr:`env`."""

    def __init__(self, folder: Path, library: Path) -> None:
        """Begin with space enough; the library is built into another folder."""
        self._full = library / "disk_full"
        self.env = {
            "LD_PRELOAD": _built("disk", library),
            "DISK": str(folder),
            "DISK_FULL": str(self._full),
        }

    def fill(self) -> None:
        """Let every write fail from now on."""
        self._full.touch()

    def clear(self) -> None:
        """Let writes succeed again."""
        self._full.unlink()
