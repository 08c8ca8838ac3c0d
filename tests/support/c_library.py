"""Many generated C monitors, compiled into one library or one program, and ways to call them."""

from __future__ import annotations

import contextlib
import ctypes
import shutil
import subprocess
from array import array
from collections.abc import Sequence
from pathlib import Path
from types import TracebackType
from typing import Protocol

from typing_extensions import Self

from tests.support.c_harness import DRIVER, Unit, library_text
from tests.support.capabilities import SANITIZED

CAPACITY = 1 << 16
"""Words that an answer may have."""

COMPILER = "gcc"
STRICT = ("-std=c99", "-Wall", "-Wextra", "-Werror", "-Wno-unused-function")


def has_compiler() -> bool:
    """Tell whether there is a C compiler."""
    return shutil.which(COMPILER) is not None


LIMIT = 600.0
"""Seconds that the compiler may take for a library."""


class CrashError(AssertionError):
    """The program has ended; what its sanitizers said."""


class Library(Protocol):
    """Monitors by their numbers, each of which takes words and answers in words."""

    units: Sequence[Unit]

    def step(self, number: int, words: array[int]) -> array[int]:
        """Call the monitor that was begun last."""

    def begin(self, number: int) -> None:
        """Make room for a monitor; the one before is gone."""


class Loaded:
    """A library loaded into this process."""

    def __init__(self, units: Sequence[Unit], folder: Path, *flags: str) -> None:
        """Compile the monitors in a folder of their own."""
        self._load(units, compile_units(units, folder, "monitors.so", "-shared", "-fPIC", *flags))

    def _load(self, units: Sequence[Unit], path: Path) -> None:
        """Load the library of some monitors."""
        self.units = units
        self._library = ctypes.CDLL(str(path))
        self._library.driver_size.restype = ctypes.c_size_t
        self._library.driver_step.restype = ctypes.c_size_t
        self._out = (ctypes.c_int64 * CAPACITY)()
        self._owner = ctypes.c_void_p()
        self._monitor: ctypes.Array[ctypes.c_char] | None = None

    def begin(self, number: int) -> None:
        """Make room for a monitor; the one before is gone."""
        size = self._library.driver_size(ctypes.c_int64(number))
        self._monitor = ctypes.create_string_buffer(size)

    def step(self, number: int, words: array[int]) -> array[int]:
        """Call the monitor that was begun last."""
        count = self._library.driver_step(
            ctypes.c_int64(number),
            self._monitor,
            ctypes.byref(self._owner),
            (ctypes.c_int64 * len(words)).from_buffer(words),
            ctypes.c_size_t(len(words)),
            self._out,
            ctypes.c_size_t(CAPACITY),
        )
        return array("q", self._out[:count])


class Watched:
    """A program of its own, watched by the sanitizers of the compiler."""

    def __init__(self, units: Sequence[Unit], folder: Path) -> None:
        """Compile the monitors in a folder of their own, and start the program."""
        self.units = units
        main = str(DRIVER / "main.c")
        program = compile_units(units, folder, "monitors", main, *SANITIZED)
        self._reports = (folder / "reports").open("w+")
        self._process = subprocess.Popen(
            [program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self._reports
        )

    def __enter__(self) -> Self:
        """Use the program for a while."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """End the program; what it leaked is reported now.

        Raises:
            AssertionError: the sanitizers found something.
        """
        assert self._process.stdin is not None
        with contextlib.suppress(BrokenPipeError):
            self._process.stdin.close()
        code = self._process.wait(60)
        report = self._report()
        self._reports.close()
        if kind is None:
            assert code == 0, report

    def begin(self, number: int) -> None:
        """Make room for a monitor; the one before is gone."""
        self._write(array("q", [-1, number]))

    def step(self, number: int, words: array[int]) -> array[int]:
        """Call the monitor that was begun last.

        Raises:
            CrashError: the sanitizers found something.
        """
        self._write(array("q", [number, len(words)]) + words)
        (count,) = self._read(1)
        return self._read(count)

    def _write(self, words: array[int]) -> None:
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(words.tobytes())
            self._process.stdin.flush()
        except BrokenPipeError:
            raise CrashError(self._report()) from None

    def _read(self, count: int) -> array[int]:
        assert self._process.stdout is not None
        found = self._process.stdout.read(8 * count)
        if len(found) != 8 * count:
            raise CrashError(self._report())
        words = array("q")
        words.frombytes(found)
        return words

    def _report(self) -> str:
        self._process.wait(60)
        self._reports.seek(0)
        return self._reports.read()


def compile_units(units: Sequence[Unit], folder: Path, name: str, *arguments: str) -> Path:
    """Compile monitors with what drives them; return the path of the result.

    Raises:
        AssertionError: with what the compiler printed, if it does not compile.
    """
    folder.mkdir(parents=True, exist_ok=True)
    for each in units:
        for file, text in each.texts.items():
            (folder / file).write_text(text, encoding="utf-8")
    (folder / "library.c").write_text(library_text(units), encoding="utf-8")
    includes = ["-I", str(DRIVER), "-I", str(folder)]
    command = [COMPILER, *STRICT, *includes, "library.c", *arguments, "-o", name, "-lm"]
    done = subprocess.run(
        command, cwd=folder, capture_output=True, text=True, timeout=LIMIT, check=False
    )
    assert done.returncode == 0, done.stderr
    return folder / name
