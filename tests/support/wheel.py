"""The wheel of this very tree, and an environment in which nothing but it is installed."""

from __future__ import annotations

import os
import subprocess
import sys
import venv
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def build_wheel(directory: Path) -> Path:
    """Build the wheel into ``directory``, as a release would be built."""
    command = [sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "-w"]
    subprocess.run([*command, directory, ROOT], check=True, capture_output=True, text=True)
    (wheel,) = directory.glob("deros-*.whl")
    return wheel


class Environment:
    """A virtual environment; its programs run without anything of ours on any path."""

    def __init__(self, directory: Path) -> None:
        """Create it in ``directory``."""
        venv.create(directory, with_pip=True, symlinks=True)
        self.bin = directory / "bin"

    def install(self, *what: str | Path) -> None:
        """Install with pip."""
        command = [self.bin / "python", "-m", "pip", "install", "--quiet", *what]
        subprocess.run(command, check=True, capture_output=True, text=True)

    def run(self, program: str, *arguments: object, cwd: Path) -> subprocess.CompletedProcess[str]:
        """Run one of its programs."""
        ours = ("PYTHON", "AMENT", "ROS", "_ROS", "LD_LIBRARY", "VIRTUAL_ENV", "COLCON")
        env = {name: value for name, value in os.environ.items() if not name.startswith(ours)}
        return subprocess.run(
            [self.bin / program, *map(str, arguments)],
            cwd=cwd,
            env=env,
            capture_output=True,
            text=True,
            check=False,
        )
