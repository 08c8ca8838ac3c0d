"""What a machine can do beyond having a program; :mod:`tests.support.needs` asks by name."""

from __future__ import annotations

import importlib.util
import shutil
import subprocess
import tempfile
from pathlib import Path

from tests.support.cpp import rclcpp_environment
from tools import fetch_elkjs

SANITIZED = ("-O1", "-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all")
"""Options of gcc for a program that its sanitizers watch."""

FUZZED = ("-std=c99", "-g", "-O1", "-fsanitize=fuzzer,address,undefined")
"""Options of clang for a program that libFuzzer drives."""

_EMPTY = "int main(void) { return 0; }"
_ENTRY = "int LLVMFuzzerTestOneInput(const char *d, long s) { return (d == 0) && (s != 0); }"
_LIMIT = 60.0


def has_rclcpp() -> bool:
    """Return whether there is a ROS 2 with its C++ client library, and what builds packages."""
    return rclcpp_environment() is not None and all(map(shutil.which, ("cmake", "make", "c++")))


def has_sanitizers() -> bool:
    """Return whether gcc links programs that its sanitizers watch."""
    return _links("gcc", SANITIZED, _EMPTY)


def has_fuzzer() -> bool:
    """Return whether clang links programs that libFuzzer drives."""
    return _links("clang", FUZZED, _ENTRY)


def has_launch() -> bool:
    """Return whether the Python of the tests has launch and launch_ros."""
    return all(importlib.util.find_spec(each) is not None for each in ("launch", "launch_ros"))


def has_elkjs() -> bool:
    """Return whether elkjs has been fetched, as ``make`` does where there is npm."""
    return fetch_elkjs.is_there()


def _links(compiler: str, options: tuple[str, ...], text: str) -> bool:
    if shutil.which(compiler) is None:
        return False
    with tempfile.TemporaryDirectory(prefix="deros-tried-") as folder:
        command = [compiler, *options, "-x", "c", "-", "-o", str(Path(folder) / "tried")]
        done = subprocess.run(
            command, input=text, capture_output=True, text=True, timeout=_LIMIT, check=False
        )
    return done.returncode == 0
