"""Projects that generate while they are built: models to start from, and CMake run as users do."""

from __future__ import annotations

import atexit
import functools
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

import deros as package
from tests.support.cli import deros
from tests.support.cpp import COLCON
from tests.support.needs import needs

PROGRAM = Path(sys.executable).with_name("deros")
"""The program deros of this environment."""

GENERATORS = ("Ninja", "Unix Makefiles")
"""CMake's generators that a build must work with."""

EACH_GENERATOR = (
    pytest.param(GENERATORS[0], marks=needs("ninja")),
    pytest.param(GENERATORS[1], marks=[needs("make"), pytest.mark.slow]),
)
"""The generators as parameters of a test."""

_LIMIT = 300.0


@functools.cache
def frozen_program() -> Path:
    """Return a copy of deros that does not change during development; builds depend on it."""
    folder = Path(tempfile.mkdtemp(prefix="deros-builds-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    ignored = shutil.ignore_patterns("__pycache__", ".*")
    shutil.copytree(Path(package.__file__).parent, folder / "deros", ignore=ignored)
    program = folder / "bin/deros"
    program.parent.mkdir()
    start = shlex.join([sys.executable, "-c", "from deros.cli.main import main; main()"])
    path = f'PYTHONPATH={shlex.quote(str(folder))}${{PYTHONPATH:+":$PYTHONPATH"}}'
    program.write_text(f'#!/bin/sh\n{path} exec {start} "$@"\n')
    program.chmod(0o755)
    return program


def models(folder: Path) -> Path:
    """Write the models that ``deros new rules robot`` gives, and return the rules."""
    assert deros("new", "rules", "robot", "-o", folder).code == 0
    return folder / "robot.deros"


def replace(path: Path, before: str, after: str) -> None:
    """Edit a file as a person would, and see to it that its time says so."""
    text = path.read_text()
    assert before in text
    path.write_text(text.replace(before, after))
    touch(path)


def touch(path: Path) -> None:
    """Make a file newer than it was, however coarse the times of this file system are."""
    previous = path.stat().st_mtime_ns
    while path.stat().st_mtime_ns <= previous:
        path.touch()


class Project:
    """A CMake project in a folder, built as a user builds it."""

    def __init__(self, folder: Path, generator: str, script: str) -> None:
        """Write the project; its models are to be put beside."""
        self.folder = folder
        self.build_folder = folder / "build tree"
        self._generator = generator
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "CMakeLists.txt").write_text(script)

    def configure(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        """Run CMake on the project."""
        program = frozen_program()
        found = [
            f"-Dderos_DIR={program.parents[1] / 'deros/cmake'}",
            f"-Dderos_EXECUTABLE={program}",
        ]
        where = ["-S", str(self.folder), "-B", str(self.build_folder)]
        command = ["cmake", "-G", self._generator, *where, *found, *arguments]
        return _run(command, self.folder)

    def build(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        """Build with two jobs."""
        command = ["cmake", "--build", str(self.build_folder), "--parallel", "2", *arguments]
        return _run(command, self.folder)

    def built(self, *arguments: str) -> str:
        """Build, which must succeed, and return what was printed."""
        done = self.build(*arguments)
        assert done.returncode == 0, done.stdout
        return done.stdout

    def generated(self) -> int:
        """Build, which must succeed, and return how many times deros was run."""
        return len(re.findall(r"\bGenerating \w+ from ", self.built()))


def configured(folder: Path, generator: str, script: str) -> Project:
    """Return a project that is configured; it needs no compiler unless the script says so."""
    project = Project(folder, generator, script)
    done = project.configure()
    assert done.returncode == 0, done.stdout
    return project


def times(folder: Path) -> dict[str, int]:
    """Return when each file below a folder was written."""
    files = (path for path in folder.rglob("*") if path.is_file())
    return {str(path.relative_to(folder)): path.stat().st_mtime_ns for path in files}


def _run(command: list[str], folder: Path, **more: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        command,
        cwd=folder,
        env={**os.environ, "NO_COLOR": "1", **more},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=_LIMIT,
        check=False,
    )


def colcon(workspace: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Build a workspace with this environment's colcon."""
    command: list[str] = [COLCON, "--log-base", "log", "build", "--executor", "sequential"]
    return _run([*command, *arguments], workspace, AMENT_PREFIX_PATH=sys.prefix)
