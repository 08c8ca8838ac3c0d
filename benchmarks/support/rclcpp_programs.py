"""Programs on rclcpp, built on the spot where there is an rclcpp."""

from __future__ import annotations

import contextlib
import fcntl
import hashlib
import os
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path

from .processes import run


def rclcpp_environment() -> dict[str, str] | None:
    """Return the environment in which programs on rclcpp are built and run.

    It is this process's own, but for the traces of the interpreter's wheels: the libraries are
    those of the prefixes in AMENT_PREFIX_PATH. ``None`` where none of them has rclcpp.
    """
    prefixes = [Path(each) for each in os.environ.get("AMENT_PREFIX_PATH", "").split(":") if each]
    if not any((prefix / "share/rclcpp/cmake").is_dir() for prefix in prefixes):
        return None
    env = dict(os.environ)
    env.pop("_ROS_WHEELS_BOOTSTRAP_COMPLETE", None)
    folders = [str(prefix / "lib") for prefix in prefixes]
    folders += env.get("LD_LIBRARY_PATH", "").split(":")
    env["LD_LIBRARY_PATH"] = ":".join(dict.fromkeys(each for each in folders if each))
    return env


@contextlib.contextmanager
def workshop(env: Mapping[str, str]) -> Iterator[Path]:
    """Hold the folder in which this checkout's programs are built for an rclcpp.

    It outlives the benchmark, so that the next one builds only what has changed.
    """
    store = Path(tempfile.gettempdir()) / f"deros-benchmark-cpp-{os.getuid()}"
    store.mkdir(mode=0o700, exist_ok=True)
    # CMake refuses a folder that another checkout's sources were built in.
    key = f"{Path(__file__).resolve()}:{env['AMENT_PREFIX_PATH']}"
    folder = store / hashlib.sha256(key.encode()).hexdigest()[:16]
    folder.mkdir(exist_ok=True)
    with (store / f"{folder.name}.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield folder


def build(source: Path, folder: Path, env: Mapping[str, str]) -> None:
    """Build a CMake project in a folder, with optimization.

    Raises:
        ProcessError: if that fails, with what was printed.
    """
    prefixes = env["AMENT_PREFIX_PATH"].replace(":", ";")
    options = ["-DCMAKE_BUILD_TYPE=Release", "-DBUILD_TESTING=OFF"]
    options.append(f"-DCMAKE_PREFIX_PATH={prefixes}")
    run(["cmake", "-S", str(source), "-B", str(folder), *options], env)
    parallel = str(len(os.sched_getaffinity(0)))
    run(["cmake", "--build", str(folder), "--parallel", parallel], env)
