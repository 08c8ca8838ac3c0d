"""Has a process of its own run a launch file in Python, and takes what that says of it."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any, BinaryIO

from deros.generators.text.prose import printable_line
from deros.importers.readers import UnreadableError

LONGEST_S = 60.0
"""How long a launch file may take until it has made its actions, in seconds."""

_PROGRAM = Path(__file__).parent / "visit" / "__main__.py"
_SHOWN = 20
"""Lines of the output that are shown where the launch file fails."""


def visited(path: Path, values: Mapping[str, str]) -> dict[str, Any]:
    """Return what a launch file makes, as :mod:`visit` writes it.

    Args:
        path: of the launch file, which is run.
        values: of its arguments, as they are given to launch.

    Raises:
        UnreadableError: launch is not there, or the file fails or takes too long.
    """
    with tempfile.TemporaryDirectory(prefix="deros-") as folder:
        result = Path(folder) / "made.json"
        with Path(folder, "output").open("w+b") as output:
            command = [sys.executable, "-B", str(_PROGRAM), str(result), str(path.absolute())]
            command.append(json.dumps(dict(values)))
            # What launch logs is no file of the user's.
            environment = {**os.environ, "ROS_LOG_DIR": folder}
            process = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
                env=environment,
                start_new_session=True,
            )
            try:
                process.wait(LONGEST_S)
            except subprocess.TimeoutExpired as error:
                why = f"{path}: the launch file has not made its actions within {LONGEST_S:g} s"
                raise UnreadableError(f"{why}{_end_of(output)}") from error
            finally:
                # A process that has been waited for is no longer the first of its group.
                if process.returncode is None:
                    os.killpg(process.pid, signal.SIGKILL)  # what it has started, too
                    process.wait()
            try:
                found: dict[str, Any] = json.loads(result.read_text(encoding="utf-8"))
            except (OSError, ValueError) as error:
                why = f"{path}: the launch file ended its process ({process.returncode})"
                raise UnreadableError(f"{why}{_end_of(output)}") from error
            if "failed" in found:
                place = f"{path}:{found['line']}" if found["line"] else str(path)
                why = f"{place}: the launch file fails: {printable_line(found['failed'])}"
                raise UnreadableError(f"{why}{_end_of(output)}")
    if "absent" in found:
        raise UnreadableError(
            f"{path}: launch and launch_ros run it, and Python cannot import them here "
            f"({printable_line(found['absent'])}): source ROS 2 before, as in "
            "'source /opt/ros/jazzy/setup.bash'"
        )
    return found


def _end_of(output: BinaryIO) -> str:
    """Return the last lines of an output, below one that says so; nothing if there are none."""
    output.seek(0)
    lines = output.read().decode(errors="replace").splitlines()[-_SHOWN:]
    shown = "".join(f"\n  {printable_line(each)}" for each in lines)
    return f"; the end of its output:{shown}" if shown else ""
