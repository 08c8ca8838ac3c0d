"""The feeding robot in three parts, each run by ``deros up`` in a domain of its own."""

from __future__ import annotations

import contextlib
import os
import re
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from tests.support.chaos.links import GATE, PLANT, SAFETY

PARTS: Mapping[str, tuple[str, ...]] = {
    PLANT: ("Machine", "Sensors", "Control"),
    SAFETY: ("safety",),
    GATE: ("actuators_command_gate",),
}
"""What of the system runs in which domain."""

_CALLED = {"actuators_command_gate": GATE}
"""Nodes that a campaign calls by another name than the system does."""

PATIENCE = 20.0
"""Seconds that a part has to end by itself."""

_STARTED = re.compile(r"\] (\S+) started, process (\d+)")
_ENDED = re.compile(r"\] (\S+) (?:ended|exited with|was killed)")

OnNode = Callable[[str], None]


class Part:
    """The nodes of one domain, from the start to :meth:`close`."""

    def __init__(
        self,
        name: str,
        system: Path,
        packages: Sequence[Path],
        env: Mapping[str, str],
        log: Path,
        started: OnNode,
        ended: OnNode,
    ) -> None:
        """Start them; the functions are called with the name of each that has started or ended."""
        self.processes: dict[str, int] = {}
        self._started, self._ended = started, ended
        self._changed = threading.Condition()
        self._log = log
        words = [word for only in PARTS[name] for word in ("--only", only)]
        places = [word for folder in packages for word in ("--package-path", str(folder))]
        command = [str(Path(sys.executable).with_name("deros")), "up", str(system)]
        self._process = subprocess.Popen(
            [*command, *words, *places, "--keep-going"],
            env=dict(env),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
            start_new_session=True,
        )
        self._reader = threading.Thread(target=self._read, name=f"log of {name}", daemon=True)
        self._reader.start()

    def process_of(self, node: str, limit: float = 30.0) -> int:
        """Return the process of a node, once it runs."""
        with self._changed:
            assert self._changed.wait_for(lambda: node in self.processes, limit), f"no {node}"
            return self.processes[node]

    def close(self) -> int:
        """Stop the nodes; return the exit code."""
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
            if self._process.poll() is None:
                self._process.send_signal(number)
            try:
                self._process.wait(PATIENCE)
                break
            except subprocess.TimeoutExpired:
                continue
        self._reader.join(PATIENCE)
        return self._process.returncode

    def _read(self) -> None:
        assert self._process.stdout is not None
        with self._log.open("w", encoding="utf-8") as log, self._process.stdout as output:
            for line in output:
                log.write(f"{time.monotonic():.3f} {line}")
                log.flush()
                if (found := _STARTED.search(line)) is not None:
                    self._note(_CALLED.get(found[1], found[1]), int(found[2]))
                elif (found := _ENDED.search(line)) is not None:
                    self._note(_CALLED.get(found[1], found[1]), None)

    def _note(self, node: str, pid: int | None) -> None:
        with self._changed:
            if pid is None:
                self.processes.pop(node, None)
            else:
                self.processes[node] = pid
            self._changed.notify_all()
        (self._ended if pid is None else self._started)(node)


# What is done to processes ------------------------------------------------------------------------


def starve(pid: int) -> None:
    """Give a process only the idle time of the processors."""
    _schedule(pid, os.SCHED_IDLE)


def feed(pid: int) -> None:
    """Treat it like all others again."""
    _schedule(pid, os.SCHED_OTHER)


def _schedule(pid: int, policy: int) -> None:
    for task in Path(f"/proc/{pid}/task").glob("*"):
        with contextlib.suppress(ProcessLookupError):  # the thread has ended
            os.sched_setscheduler(int(task.name), policy, os.sched_param(0))


class Neighbours:
    """Processes that never rest, one for each processor."""

    def __init__(self) -> None:
        """Start them."""
        command = [sys.executable, "-IS", "-c", "while True: pass"]
        count = len(os.sched_getaffinity(0))
        self._processes = [subprocess.Popen(command) for _ in range(count)]

    def close(self) -> None:
        """End them."""
        for process in self._processes:
            process.kill()
            process.wait()
