"""Worker code in the tests of the pool: mutants that behave as their entry says."""

from __future__ import annotations

import os
import re
import signal
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from tools.fuzzing.mutants import Mutant


class Victim:
    """Behaves as the entry of a mutant says."""

    def __init__(self, folder: Path) -> None:
        self.ends: Counter[str] = Counter()
        self._kept: list[bytearray] = []
        del folder

    def stages(self, mutant: Mutant) -> Iterator[Mutant]:
        """Yield the mutant, then misbehave."""
        yield mutant
        what = mutant.entry
        if what == "raise":
            raise ValueError("broken")
        if what == "raise if bad" and b"bad" in mutant.files["text"]:
            raise ValueError("broken")
        if what == "exit":
            os._exit(3)
        if what == "loop":
            while True:
                pass
        if what == "regex":  # does not return to Python, so that no signal is handled
            signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGPROF])
            re.fullmatch("(a+)+b", "a" * 40)
        if what == "wait":
            time.sleep(600)
        if what == "peak":
            bytearray(300 << 20)
        if what == "keep":
            self._kept.append(bytearray(1 << 20))
        self.ends["well"] += 1
