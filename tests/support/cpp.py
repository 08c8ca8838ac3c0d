"""C++ in tests: the compiler, the wheels' message headers, and an rclcpp where there is one.

rclcpp is not on the package index. Tests of generated nodes therefore say ``needs("rclcpp")``; to
have them run, source a ROS 2 (``. /opt/ros/jazzy/setup.sh``) before pytest.
"""

from __future__ import annotations

import fcntl
import functools
import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from tests.support.object_cache import compile_objects

WARNINGS = ("-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror")
"""What generated C++ compiles with, and nothing comes of it."""

COLCON = str(Path(sys.executable).with_name("colcon"))
"""That of the tests' environment; a machine with ROS 2 may have one of its own, too."""

BUILD_LIMIT = 1800.0
"""Seconds that colcon may take; a package of two rclcpp nodes takes one minute on a slow core."""

_DAY = 24 * 3600.0


def ros_prefixes(env: Mapping[str, str]) -> tuple[Path, ...]:
    """Return the prefixes of ROS 2 in an environment, those that come first in front."""
    texts = env.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
    return tuple(Path(text) for text in texts if text)


def _joined(first: Iterable[str], rest: str) -> str:
    """Return a search path with folders in front, none of them twice."""
    folders = [*first, *rest.split(os.pathsep)]
    return os.pathsep.join(dict.fromkeys(folder for folder in folders if folder))


def rclcpp_environment() -> dict[str, str] | None:
    """Return the environment in which packages on rclcpp are built and run.

    It is this process's own, without the traces of the interpreter's wheels, so that compiled
    programs load the libraries of the prefixes in AMENT_PREFIX_PATH. ``None`` where none of these
    prefixes has rclcpp.
    """
    prefixes = ros_prefixes(os.environ)
    if not any((prefix / "share/rclcpp/cmake").is_dir() for prefix in prefixes):
        return None
    env = dict(os.environ)
    env.pop("_ROS_WHEELS_BOOTSTRAP_COMPLETE", None)
    libraries = [str(prefix / "lib") for prefix in prefixes]
    env["LD_LIBRARY_PATH"] = _joined(libraries, env.get("LD_LIBRARY_PATH", ""))
    env["AMENT_CPPCHECK_ALLOW_SLOW_VERSIONS"] = "1"  # ament_cppcheck does nothing else
    return env


def has_package(name: str) -> bool:
    """Tell whether a ROS 2 package is in one of the prefixes in AMENT_PREFIX_PATH."""
    return any((prefix / "share" / name).is_dir() for prefix in ros_prefixes(os.environ))


# Packages on rclcpp -------------------------------------------------------------------------------


def colcon_build(packages: Path, *, testing: bool = False) -> Path:
    """Build the packages in a folder, warnings being errors, and return the install folder.

    The result is kept for a day under a name made from all that goes into it, so that tests, test
    processes and runs share it; it must not be changed.

    Args:
        packages: the folder with the packages' sources; it stays as it is.
        testing: whether the packages' own tests (linters) are configured and run too.

    Raises:
        AssertionError: with what colcon printed, if a package does not build or a test fails.
    """
    env = rclcpp_environment()
    assert env is not None, "no rclcpp in AMENT_PREFIX_PATH"
    store = Path(tempfile.gettempdir()) / f"deros-test-colcon-{os.getuid()}"
    store.mkdir(mode=0o700, exist_ok=True)
    built = store / _digest(packages, env, testing)
    with (store / f"{built.name}.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not (built / "done").exists():
            shutil.rmtree(built, ignore_errors=True)
            shutil.copytree(packages, built / "src")
            _colcon(built, env, testing)
            (built / "done").touch()
    os.utime(built)
    _forget_old(store)
    return built / "install"


def overlay(install: Path, env: Mapping[str, str]) -> dict[str, str]:
    """Return ``env`` with an install folder in front, to run its programs and libraries.

    ``env`` is most often that of the fixture ``ros_env``: its domain and home are kept.
    """
    base = rclcpp_environment()
    assert base is not None, "no rclcpp in AMENT_PREFIX_PATH"
    merged = {**env, **{name: base[name] for name in ("AMENT_PREFIX_PATH", "LD_LIBRARY_PATH")}}
    merged.pop("_ROS_WHEELS_BOOTSTRAP_COMPLETE", None)
    merged["AMENT_PREFIX_PATH"] = _joined([str(install)], merged["AMENT_PREFIX_PATH"])
    merged["LD_LIBRARY_PATH"] = _joined([str(install / "lib")], merged["LD_LIBRARY_PATH"])
    return merged


def instrument(package: Path, node: str, sources: Iterable[str]) -> None:
    """Have some sources of a node's component notice the use of freed memory.

    All others stay as they are, so that what other tests have compiled of them is used again.

    Args:
        package: the generated package.
        node: the name that its targets begin with.
        sources: relative to the package.
    """
    option = "-fsanitize=address"
    # Compilers that link only the libraries that are needed do not so with a sanitizer.
    linking = f"{option} LINKER:--as-needed"
    text = (
        f"set_property(SOURCE {' '.join(sources)} APPEND PROPERTY COMPILE_OPTIONS {option})\n"
        f"target_link_options({node}_component PUBLIC {linking})\n"
    )
    with (package / "custom.cmake").open("a") as file:
        file.write(text)


def sanitized(env: Mapping[str, str]) -> dict[str, str]:
    """Return ``env`` for a program that loads components changed by :func:`instrument`.

    It ends with 99 if one of them uses freed memory; the report is in its output.
    """
    command = ["c++", "-print-file-name=libasan.so"]
    library = subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
    options = "detect_leaks=0:exitcode=99:new_delete_type_mismatch=0"  # ROS 2 is as it is
    return {**env, "LD_PRELOAD": library, "ASAN_OPTIONS": options}


def python_overlay(install: Path, env: Mapping[str, str]) -> dict[str, str]:
    """Return the same for Python that starts such programs.

    It finds its own libraries where theirs are; its wheels would put others in front.
    """
    return {**overlay(install, env), "_ROS_WHEELS_BOOTSTRAP_COMPLETE": "1"}


def program(install: Path, package: str, name: str) -> str:
    """Return the path of a package's program in an install folder of :func:`colcon_build`."""
    return str(install / "lib" / package / name)


def _colcon(folder: Path, env: dict[str, str], testing: bool) -> None:
    if shutil.which("ccache", path=env.get("PATH")):
        launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache", "-DCMAKE_C_COMPILER_LAUNCHER=ccache"]
        # Tests have no folder for caches (conftest); this one is the compiler's.
        caches = env.get("CCACHE_DIR", str(Path("~/.cache/ccache").expanduser()))
        own = {"CCACHE_DIR": caches, "CCACHE_BASEDIR": str(folder), "CCACHE_NOHASHDIR": "1"}
        env = {**env, **own}
    else:
        launcher = []
    flags = " ".join(WARNINGS)
    build = [
        *("build", "--merge-install", "--executor", "sequential"),
        *("--event-handlers", "console_direct-", "console_cohesion+"),
        *("--cmake-args", f"-DCMAKE_CXX_FLAGS={flags}", "-DCMAKE_BUILD_TYPE=Release"),
        *launcher,
        f"-DBUILD_TESTING={'ON' if testing else 'OFF'}",
    ]
    _run([COLCON, "--log-base", "log", *build], folder, env)
    if testing:
        # colcon's own wheels would put their libraries in front of those that were linked.
        env = {**env, "_ROS_WHEELS_BOOTSTRAP_COMPLETE": "1"}
        test = [
            "test",
            "--merge-install",
            "--executor",
            "sequential",
            "--return-code-on-test-failure",
        ]
        handlers = ["--event-handlers", "console_cohesion+"]
        _run([COLCON, "--log-base", "log", *test, *handlers], folder, env)


def _run(command: Sequence[str], folder: Path, env: Mapping[str, str] | None = None) -> None:
    done = subprocess.run(
        command,
        cwd=folder,
        env=env,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=BUILD_LIMIT,
        check=False,
    )
    assert done.returncode == 0, done.stdout


def _digest(packages: Path, env: Mapping[str, str], testing: bool) -> str:
    """Return a name for all that a build depends on, as far as tests vary it."""
    found = hashlib.sha256(f"{testing} {WARNINGS} {env['AMENT_PREFIX_PATH']}".encode())
    for prefix in ros_prefixes(env):
        library = prefix / "lib/librclcpp.so"
        if library.exists():
            found.update(str(library.stat().st_mtime_ns).encode())
    for path in sorted(path for path in packages.rglob("*") if path.is_file()):
        found.update(path.relative_to(packages).as_posix().encode() + b"\0")
        found.update(hashlib.sha256(path.read_bytes()).digest())
    return found.hexdigest()[:24]


def _forget_old(store: Path) -> None:
    for lock in store.glob("*.lock"):
        built = lock.with_suffix("")
        if built.exists() and time.time() - built.stat().st_mtime > _DAY:
            shutil.rmtree(built, ignore_errors=True)
            lock.unlink(missing_ok=True)


# C++ without rclcpp -------------------------------------------------------------------------------


@functools.cache
def ros_prefix() -> Path:
    """Return the first ROS 2 prefix, or that of this environment's wheels."""
    prefixes = (*ros_prefixes(os.environ), Path(sys.prefix))
    return next(p for p in prefixes if (p / "include/rosidl_runtime_cpp").is_dir())


@functools.cache
def message_flags() -> tuple[str, ...]:
    """Return the options that let ``#include "sensor_msgs/msg/imu.hpp"`` be found.

    The headers are those of the first ROS 2 prefix, the wheels of this environment otherwise. They
    come as system headers: their own warnings are not ours.
    """
    include = ros_prefix() / "include"
    folders = sorted(folder for folder in include.iterdir() if (folder / folder.name).is_dir())
    return tuple(argument for folder in folders for argument in ("-isystem", str(folder)))


def compile_cpp(
    sources: Iterable[Path],
    output: Path,
    *flags: str,
    includes: Sequence[str] = (),
    standard: str = "c++17",
    libraries: Iterable[str] = (),
) -> Path:
    """Compile sources to a program, with all warnings as errors, and return its path.

    The options that name ``libraries`` come last, as linkers want it.

    Raises:
        AssertionError: with what the compiler printed, if it does not compile.
    """
    output.parent.mkdir(parents=True, exist_ok=True)
    options = (f"-std={standard}", *WARNINGS, *flags)
    objects = compile_objects("c++", options, includes, sources)
    command = ["c++", *options, *map(str, objects), "-o", str(output), *libraries]
    _run(command, output.parent)
    return output
