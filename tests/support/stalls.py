"""How long a busy machine held a test up, for tests of how soon a program reacts.

A bound on a reaction counts the program's own time. A test that measures it from outside adds the
time for which other processes had the processors; a thread that only waits measures that time.
"""

from __future__ import annotations

import contextlib
import threading
import time
from collections.abc import Iterator

_STEP_S = 0.002
"""Period of the measurement; a wait that takes up to twice as long is an ordinary one."""


class Stalls:
    """Sum of the stalls so far.

    Attributes:
        seconds: how much longer than usual the waits took, added up.
    """

    def __init__(self) -> None:
        """Start with no stall."""
        self.seconds = 0.0

    def measure(self, ended: threading.Event) -> None:
        """Measure until ``ended`` is set."""
        before = time.monotonic()
        while not ended.wait(_STEP_S):
            now = time.monotonic()
            if now - before > 2 * _STEP_S:
                self.seconds += now - before - _STEP_S
            before = now


@contextlib.contextmanager
def stalls() -> Iterator[Stalls]:
    """Measure while the block runs; a reaction may be later by what ``seconds`` grew meanwhile."""
    measured, ended = Stalls(), threading.Event()
    thread = threading.Thread(target=measured.measure, args=(ended,), daemon=True)
    thread.start()
    try:
        yield measured
    finally:
        ended.set()
        thread.join()
