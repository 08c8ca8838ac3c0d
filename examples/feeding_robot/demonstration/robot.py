"""The system as a process: ``deros up``, what it says, and that it ends."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Sequence
from pathlib import Path

PATIENCE = 20.0
"""Seconds that the system has to end by itself, before it is killed."""

_STOPPING = re.compile(r"\] stopping: (.+)")
_STARTED = re.compile(r"\] (\S+) started, process (\d+)")


class Robot:
    """All nodes of the system, from the start to the end of the ``with`` block.

    Args:
        system: the model to run.
        packages: the folders with the packages of its nodes.
        log: the file that gets everything the nodes say.
        arguments: those of the system, as ``NAME:=VALUE``.
    """

    def __init__(
        self, system: Path, packages: Sequence[Path], log: Path, arguments: Sequence[str] = ()
    ) -> None:
        """Prepare the command; nothing is started yet."""
        self._command = [
            str(Path(sys.executable).with_name("deros")),
            *("up", str(system)),
            *(word for folder in packages for word in ("--package-path", str(folder))),
            *arguments,
        ]
        self._log = log
        self._processes: dict[str, int] = {}
        self._on_end: Callable[[str], None] = lambda _reason: None
        self._ending = False

    def __enter__(self) -> Robot:
        """Start the system, in a session of its own: a Ctrl-C reaches it through us alone."""
        self._system = subprocess.Popen(
            self._command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
            start_new_session=True,
        )
        self._reader = threading.Thread(target=self._read, name="log", daemon=True)
        self._reader.start()
        return self

    def __exit__(self, *_: object) -> None:
        """Stop the system; it is gone when this returns."""
        self._ending = True
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
            if self._system.poll() is None:
                self._system.send_signal(number)
            try:
                self._system.wait(PATIENCE)
                break
            except subprocess.TimeoutExpired:
                continue
        self._reader.join(PATIENCE)

    def process_of(self, node: str) -> int:
        """Return the id of the process that runs ``node``, after restarts the latest.

        Raises:
            KeyError: if no such node has been started.
        """
        return self._processes[node]

    def on_end(self, callback: Callable[[str], None]) -> None:
        """Have ``callback`` called with the reason if the system ends by itself."""
        self._on_end = callback

    def _read(self) -> None:
        assert self._system.stdout is not None
        reason = "before it has begun"
        with self._log.open("w", encoding="utf-8") as log, self._system.stdout as output:
            for line in output:
                log.write(line)
                log.flush()
                if (started := _STARTED.search(line)) is not None:
                    self._processes[started[1]] = int(started[2])
                elif (stopping := _STOPPING.search(line)) is not None:
                    reason = stopping[1]
        if not self._ending:
            self._on_end(f"the system has ended: {reason}; see {self._log}")
