"""What all robots under test have in common: the generated nodes in each language, as processes."""

from __future__ import annotations

import contextlib
import re
import sys
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol

from deros.generators.api.protocol import Context, Files
from deros.generators.output.writer import write
from deros.generators.runtime.interface import PYTHON_RUNTIME, with_runtime
from deros.generators.safety_package.cpp import generate as safety_cpp
from deros.generators.safety_package.python import generate as safety_python
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.rules import Rules
from tests.support.cpp import colcon_build, overlay, program
from tests.support.ros import LIMIT, Peer
from tests.support.victims import Process, Sensors

PROMPT = 1.0
"""Seconds from hearing a violation to the stop that counts as not missed, on any machine.

How fast deros is, is measured by the benchmarks, beside the floor that the machine sets. Here the
question is whether a fault can lose, block or starve a stop.
"""

_UNFILLED = re.compile(r"^    @not_filled_in\n", re.MULTILINE)


def _generate(target: Callable[..., Files], rules: Path, folder: Path) -> None:
    context = Context(InterfaceStore(), Repository())
    model = context.repository.load(rules).model
    assert isinstance(model, Rules), context.repository.diagnostics
    write(with_runtime(target(model, context, {})), folder)


class Software(Protocol):
    """The generated nodes of a package."""

    def command(self, module: str, env: Mapping[str, str]) -> tuple[list[str], dict[str, str]]:
        """Return what runs a node, and the environment for it."""
        ...


class PythonNodes:
    """The generated nodes in Python; the actions that are robot code do nothing.

    Attributes:
        actions: the file with these actions.
    """

    def __init__(self, rules: Path, folder: Path) -> None:
        """Generate the package of ``rules`` into a folder."""
        _generate(safety_python.generate, rules, folder)
        self._package = f"{rules.stem}_safety"
        code = folder / self._package / self._package
        self.actions = code / f"{self._package}_node_actions.py"
        filled = _UNFILLED.sub("", self.actions.read_text(encoding="utf-8"))
        self.actions.write_text(filled.replace("    not_filled_in,\n", ""), encoding="utf-8")
        self._path = f"{folder / self._package}:{folder / PYTHON_RUNTIME}"

    def command(self, module: str, env: Mapping[str, str]) -> tuple[list[str], dict[str, str]]:
        """Return what runs a node, and the environment for it."""
        command = [sys.executable, "-m", f"{self._package}.{module}"]
        return command, {**env, "PYTHONPATH": self._path}


class CppNodes:
    """The generated nodes in C++, built; the same actions do nothing."""

    def __init__(self, rules: Path, folder: Path) -> None:
        """Generate the package of ``rules`` into a folder, and build it."""
        _generate(safety_cpp.generate, rules, folder)
        safety = f"{rules.stem}_safety"
        self._package = f"{safety}_cpp"
        header = folder / self._package / "include" / self._package / f"{safety}_node_actions.hpp"
        text = header.read_text(encoding="utf-8")
        filled, count = re.subn(r"// (void \w+\(\)) override;", r"\1 override {}", text)
        assert count
        header.write_text(filled, encoding="utf-8")
        self._fill_in(rules, header)
        self._install = colcon_build(folder)

    def _fill_in(self, rules: Path, header: Path) -> None:
        """Replace actions that are to do something, before the package is built."""

    def command(self, module: str, env: Mapping[str, str]) -> tuple[list[str], dict[str, str]]:
        """Return what runs a node, and the environment for it."""
        command = [program(self._install, self._package, f"{module}_cpp")]
        return command, overlay(self._install, env)


class Rig:
    """Runs the processes of a robot under test, and waits for what they do.

    Attributes:
        peer: the test's own node.
        folder: for what the processes write.
        software: the generated nodes.
        env: the environment of the processes.
    """

    safety: str
    """The module of the safety node, which runs by default."""

    topics: Mapping[str, str]
    """The topics that sensors have by default, with their types."""

    def __init__(
        self, software: Software, folder: Path, env: Mapping[str, str], peer: Peer
    ) -> None:
        """Start nothing yet."""
        self.peer = peer
        self.folder = folder
        self.env = {**env, "ROS_HOME": str(folder), "ROS_LOG_DIR": str(folder / "log")}
        self.software = software
        self._processes: list[Process] = []
        self._sensors: list[Sensors] = []

    def until(self, condition: Callable[[], Any], limit: float = LIMIT) -> Any:
        """Wait until something is true.

        The limit does not count the time for which the machine ran other processes instead of those
        of the robot, so that load alone does not exceed it.
        """
        began, held_up = time.monotonic(), self.held_up()
        came: Any = None

        def is_over() -> bool:
            nonlocal came
            came = condition()
            passed = time.monotonic() - began
            return came or (passed > limit and passed - (self.held_up() - held_up) > limit)

        self.peer.until(is_over, limit + LIMIT)
        assert came, "the awaited event did not come"
        return came

    def held_up(self) -> float:
        """Return the seconds for which the machine ran other processes than those of the test."""
        robot: list[Process | Sensors] = [*self._processes, *self._sensors]
        return self.peer.held_up + sum(each.waited() for each in robot)

    def spin(self, seconds: float) -> None:
        """Listen for a time in which something must *not* happen."""
        end = time.monotonic() + seconds
        self.peer.until(lambda: time.monotonic() >= end)

    @contextlib.contextmanager
    def sensors(self, topics: Mapping[str, str] | None = None, **env: str) -> Iterator[Sensors]:
        """Run a process that plays sensors."""
        sensors = Sensors(self.topics if topics is None else topics, {**self.env, **env})
        self._sensors.append(sensors)
        try:
            yield sensors
        finally:
            self._sensors.remove(sensors)
            sensors.close()

    def start(
        self, module: str = "", parameters: Sequence[str] = (), name: str = "", **env: str
    ) -> Process:
        """Start a node of the generated package; the caller ends it.

        Args:
            module: the program; by default the safety node.
            parameters: in the form ``name:=value``.
            name: the node's name, if it is not to be its own.
            env: what is to be added to the environment.
        """
        module = module or self.safety
        words = [word for each in parameters for word in ("-p", each)]
        words += ["-r", f"__node:={name}"] if name else []
        ros = ["--ros-args", *words] if words else []
        command, own = self.software.command(module, self.env)
        return self._start([*command, *ros], {**own, **env}, module)

    def _start(self, command: Sequence[str], env: Mapping[str, str], name: str) -> Process:
        number = len(self._processes)
        process = Process(command, env, self.folder / f"{name.split('.')[0]}.{number}.log")
        self._processes.append(process)
        return process

    def clear(self) -> None:
        """Kill what still runs, and show what all have printed, should the test fail."""
        for process in self._processes:
            if process.popen.poll() is None:
                process.kill()
            print(f"--- {process.name}:\n{process.output()}")
        self._processes.clear()
