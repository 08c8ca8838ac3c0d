"""What the benchmarks on real middleware have in common as programs."""

from __future__ import annotations

import json
import os
import signal
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import Any, TypeVar

from rich.console import Console

from support.processes import ProcessError

_BUSY = 0.3
_Found = TypeVar("_Found")


def conduct(measure: Callable[[Path], _Found]) -> _Found:
    """Measure, in a folder that is gone afterwards.

    Raises:
        SystemExit: if nothing was measured: with 2 if a process failed or nobody came to a topic,
            with 128 and its number more if a signal ended it.
    """
    signal.signal(signal.SIGTERM, _leave)
    try:
        with tempfile.TemporaryDirectory(prefix="deros-benchmark-") as folder:
            return measure(Path(folder))
    except KeyboardInterrupt:
        sys.exit(128 + signal.SIGINT)
    except (ProcessError, TimeoutError) as error:
        print(error, file=sys.stderr)
        sys.exit(2)


def _leave(number: int, _frame: FrameType | None) -> None:
    sys.exit(128 + number)


class Report:
    """Where the results go.

    Made before anything is measured, it knows whether the machine had something else to do.

    Args:
        width: how wide the tables are where the output is no terminal.
    """

    def __init__(self, width: int) -> None:
        """Look at the machine."""
        self.console = Console(width=None if sys.stdout.isatty() else width)
        self._load = os.getloadavg()[0]

    def close(self, file: Path | None, results: dict[str, Any]) -> None:
        """Say if the machine was busy; write the results to a file, if there is one."""
        if self._load > _BUSY:
            text = f"The machine was not idle before (load {self._load:.1f}): take this for noise."
            self.console.print(text)
        if file is not None:
            file.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
