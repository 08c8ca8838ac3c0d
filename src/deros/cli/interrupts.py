"""Ctrl-C: ends a command at once, with exit code 130, no traceback and nothing half-written."""

from __future__ import annotations

import contextlib
import os
import shutil
import signal
from collections.abc import Callable, Iterator
from pathlib import Path
from types import FrameType

INTERRUPTED = 130

_ENDING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
_OURS = (signal.default_int_handler, signal.SIG_DFL)


@contextlib.contextmanager
def interrupts_at_once() -> Iterator[None]:
    """End the process at a SIGINT from now on, unless it is ignored or handled already.

    Python's own handler raises an exception wherever the program is. In the middle of some imports
    and in a destructor that is printed and forgotten, and the program goes on.
    """
    before = signal.getsignal(signal.SIGINT)
    if before in _OURS:
        signal.signal(signal.SIGINT, _end)
    try:
        yield
    finally:
        if before in _OURS:
            signal.signal(signal.SIGINT, before)


@contextlib.contextmanager
def removed_at_interrupt(folder: Path) -> Iterator[None]:
    """Remove a temporary folder at a SIGINT, before the handler that is in place ends the process.

    That handler leaves no time for what would remove the folder otherwise.
    """
    before = signal.getsignal(signal.SIGINT)

    def remove(number: int, frame: FrameType | None) -> None:
        shutil.rmtree(folder, ignore_errors=True)
        if callable(before):
            before(number, frame)

    if callable(before):
        signal.signal(signal.SIGINT, remove)
    try:
        yield
    finally:
        if callable(before):
            signal.signal(signal.SIGINT, before)


@contextlib.contextmanager
def held() -> Iterator[None]:
    """Let a signal that ends the program wait while files are written: all of them, or none."""
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, _ENDING)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)


@contextlib.contextmanager
def stopped_by_signals() -> Iterator[Callable[[], bool]]:
    """Provide what says whether a SIGINT or a SIGTERM has come, which then ends nothing by itself.

    A SIGINT that is ignored stays so: a shell starts jobs in the background like that.
    """
    came: list[int] = []
    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    taken = [number for number, handler in before.items() if handler is not signal.SIG_IGN]
    for number in taken:
        signal.signal(number, lambda number, _: came.append(number))
    try:
        yield lambda: bool(came)
    finally:
        for number in taken:
            signal.signal(number, before[number])


def _end(*_: object) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # timeout(1), for one, sends it twice
    with contextlib.suppress(OSError):  # a closed terminal
        os.write(2, b"\nderos: interrupted\n")
    os._exit(INTERRUPTED)
