"""Processes in a ROS domain of the benchmark's own, which surely end with it."""

from __future__ import annotations

import contextlib
import fcntl
import json
import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

_BENCHMARKS = Path(__file__).resolve().parents[1]
_DOMAINS = range(1, 102)  # the ports of higher ones may be taken by outgoing connections
_LOCKS = Path(tempfile.gettempdir()) / "deros-test-domains"  # shared with the project's tests
_LIMIT = 10.0


class ProcessError(Exception):
    """A process of the benchmark has ended too early, or does not end."""


@contextlib.contextmanager
def own_domain(folder: Path) -> Iterator[None]:
    """Confine this process and its children to a ROS domain that nobody else here uses.

    To be entered before rclpy is imported.

    Args:
        folder: where ROS is to write its logs, and whatever else it keeps.

    Raises:
        RuntimeError: if all domains are taken.
    """
    os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"
    os.environ["ROS_HOME"] = str(folder)
    _LOCKS.mkdir(mode=0o777, exist_ok=True)
    for number in reversed(_DOMAINS):
        with (_LOCKS / str(number)).open("w") as lock:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                continue
            os.environ["ROS_DOMAIN_ID"] = str(number)
            yield
            return
    raise RuntimeError("all ROS domains are in use")


@dataclass(frozen=True, slots=True)
class _Running:
    name: str
    process: subprocess.Popen[str]
    log: Path


class Processes:
    """Starts processes, watches over them, and ends them; use it as a context manager."""

    def __init__(self, folder: Path) -> None:
        """Keep what they write to stderr in ``folder``."""
        self._folder = folder
        self._running: dict[str, _Running] = {}

    def __enter__(self) -> Processes:
        """Begin with none."""
        return self

    def __exit__(self, *_: object) -> None:
        """End those that are left."""
        for each in self._running.values():
            each.process.send_signal(signal.SIGINT)
        for each in self._running.values():
            _awaited(each.process)

    def start(self, module: str, *arguments: str, path: Path = _BENCHMARKS, name: str = "") -> None:
        """Run a Python module found in ``path``; it goes by its own name unless one is given.

        The module may use the runtime that deros puts beside a package.
        """
        command = [sys.executable, "-m", module, *arguments]
        places = (path, path.with_name("deros_runtime"))
        env = {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, places))}
        self.start_program(command, env, name or module.rpartition(".")[2])

    def start_program(self, command: Sequence[str], env: Mapping[str, str], name: str) -> None:
        """Run a program in an environment; it goes by ``name``."""
        log = self._folder / f"{name}.log"
        with log.open("w") as errors:
            process = subprocess.Popen(
                command, env=env, stdout=subprocess.PIPE, stderr=errors, text=True
            )
        self._running[name] = _Running(name, process, log)

    def pid(self, name: str) -> int:
        """Return the number of a process."""
        return self._running[name].process.pid

    def check(self) -> None:
        """See that all of them are running.

        Raises:
            ProcessError: if one is not, with the end of its log.
        """
        for each in self._running.values():
            if each.process.poll() is not None:
                code = each.process.returncode
                raise ProcessError(f"{each.name} has ended with {code}:\n{_end_of(each.log)}")

    def end(self, name: str) -> Any:
        """End a process and return what it has printed as JSON, or None if it printed nothing.

        Raises:
            ProcessError: if it does not end by SIGINT.
        """
        each = self._running.pop(name)
        each.process.send_signal(signal.SIGINT)
        output = _awaited(each.process)
        if output is None:
            raise ProcessError(f"{name} does not end by SIGINT")
        return json.loads(output) if output else None


def run(command: Sequence[str], env: Mapping[str, str] | None = None) -> str:
    """Run a command to its end and return what it printed.

    Args:
        command: the program and its arguments.
        env: its environment; this process's own if none is given.

    Raises:
        ProcessError: if it fails, with what it wrote.
    """
    result = subprocess.run(command, capture_output=True, text=True, env=env)
    if result.returncode:
        raise ProcessError(f"{' '.join(command)} failed:\n{result.stderr or result.stdout}")
    return result.stdout


def _awaited(process: subprocess.Popen[str]) -> str | None:
    """Return what a process that was asked to end has printed; None if it had to be killed."""
    try:
        return process.communicate(timeout=_LIMIT)[0]
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()
        return None


def _end_of(log: Path) -> str:
    return "\n".join(log.read_text(encoding="utf-8", errors="replace").splitlines()[-20:])
