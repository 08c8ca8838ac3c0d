"""The programs that a test runs, by name: ``@needs("clang")``.

A test declares every program that it runs, other than those of its own Python environment and those
that it builds. Where one is missing the test is skipped, with that name as the reason. A test that
runs a program that it does not declare is an error, on a machine that has the program as well:

* in collection, where the call is found by reading the test, its fixtures and what they call in the
  packages of this repository (:mod:`tests.support.needs_reading`);
* when it runs, by an audit hook, for what cannot be seen by reading.
"""

from __future__ import annotations

import functools
import os
import shutil
import sys
import tempfile
import zlib
from collections.abc import Callable, Generator
from pathlib import Path
from typing import Any

import pytest

from tests.support import capabilities
from tests.support.cpp import ros_prefixes
from tests.support.needs_reading import Reader

PROGRAMS = (
    *("gcc", "cc", "g++", "c++", "clang", "clang++", "arm-none-eabi-gcc", "nm", "objdump"),
    *("cmake", "ctest", "ninja", "make", "cppcheck", "frama-c", "why3", "z3", "cvc4", "gdb"),
    *(
        "chromium",
        "npm",
        "ros2",
        "git",
        "bash",
        "sh",
        "env",
        "sleep",
        "touch",
        "ssh",
        "sshd",
        "ssh-keygen",
    ),
)
"""The programs that are looked for when tests are read; the audit hook knows any."""

_CAPABILITIES: dict[str, Callable[[], bool]] = {
    "rclcpp": capabilities.has_rclcpp,
    "gcc's sanitizers": capabilities.has_sanitizers,
    "libFuzzer": capabilities.has_fuzzer,
    "elkjs": capabilities.has_elkjs,
    "launch_ros": capabilities.has_launch,
}
"""What is no single program, and how to find out whether it is there."""

_FREE = ("/bin/sh", "/usr/bin/env")
"""What every POSIX system has, and ``subprocess`` itself runs."""


def needs(*names: str) -> pytest.MarkDecorator:
    """Return the mark of a test that runs programs, or needs one of the capabilities."""
    return pytest.mark.needs(*names)


def may_run(*names: str) -> pytest.MarkDecorator:
    """Return the mark of a test that runs programs where they are, and passes without them."""
    return pytest.mark.may_run(*names)


def missing(names: frozenset[str]) -> list[str]:
    """Return those of some names that this machine does not have."""
    return sorted(name for name in names if not _is_there(name))


@functools.cache
def _is_there(name: str) -> bool:
    found = _CAPABILITIES.get(name)
    return shutil.which(name) is not None if found is None else found()


def declared(item: pytest.Item, *marks: str) -> frozenset[str]:
    """Return the names in the marks of a test."""
    names = marks or ("needs", "may_run")
    return frozenset(
        name for mark in item.iter_markers() if mark.name in names for name in mark.args
    )


# Plug-in of pytest --------------------------------------------------------------------------------


_reader = Reader(PROGRAMS)
_ran: set[str] = set()
"""The programs that the present test has run."""


def pytest_configure(config: pytest.Config) -> None:
    """Register the mark, and watch which programs are run from now on."""
    config.addinivalue_line("markers", "needs(*names): the programs that the test runs")
    config.addinivalue_line("markers", "may_run(*names): programs that it runs where they are")
    sys.addaudithook(_audit)


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(
    collector: pytest.Collector,
) -> Generator[None, pytest.CollectReport, pytest.CollectReport]:
    """Refuse a module with tests that run programs that they do not declare.

    Of several processes of a run, which all collect the same tests, each reads its share of them.
    """
    report = yield
    if not _is_read_here(collector):
        return report
    faults = []
    for item in report.result:
        if isinstance(item, pytest.Function):
            undeclared = _reader.programs(item) - declared(item)
            if undeclared:
                faults.append(f"{item.nodeid} runs {_listed(undeclared)}")
    if faults:
        report.outcome, report.longrepr = "failed", "\n".join(faults)
    return report


def _is_read_here(collector: pytest.Collector) -> bool:
    worker = getattr(collector.config, "workerinput", {})
    number = int(worker.get("workerid", "gw0").removeprefix("gw"))
    share = zlib.crc32(str(collector.path).encode()) % worker.get("workercount", 1)
    return bool(share == number)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Skip the tests whose programs are missing."""
    for item in items:
        if absent := missing(declared(item, "needs")):
            item.add_marker(pytest.mark.skip(reason=f"no {', no '.join(absent)}"))


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol() -> Generator[None, object, object]:
    """Begin to watch a test."""
    _ran.clear()
    return (yield)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item: pytest.Item) -> Generator[None, object, object]:
    """Fail a test that has run a program that it does not declare."""
    result = yield
    undeclared = _ran - declared(item)
    if undeclared:
        pytest.fail(f"the test runs {_listed(undeclared)}", pytrace=False)
    return result


def _listed(names: frozenset[str] | set[str]) -> str:
    ordered = sorted(names)
    quoted = ", ".join(f'"{name}"' for name in ordered)
    return f"{', '.join(ordered)}, which it does not declare: mark it with @needs({quoted})"


def _audit(event: str, arguments: tuple[Any, ...]) -> None:
    """Note a program that is started; see the table of audit events in Python's documentation."""
    if event == "subprocess.Popen":
        executable, command, folder, env = arguments
        program = executable or (command if isinstance(command, (str, bytes)) else command[0])
        search = (env or os.environ).get("PATH")
    elif event in ("os.posix_spawn", "os.exec"):
        program, search, folder = arguments[0], os.environ.get("PATH"), None
    else:
        return
    path = os.fsdecode(program)
    if path in _FREE:
        return
    found = str(Path(folder or "", path)) if os.sep in path else shutil.which(path, path=search)
    if found is None or not _is_own(Path(found).resolve()):
        _ran.add(need_of(Path(found or path)))


def need_of(program: Path) -> str:
    """Return what a test declares that runs a program: those of a ROS 2 come with its rclcpp."""
    folders = [(prefix / "lib").resolve() for prefix in ros_prefixes(os.environ)]
    is_of_ros = any(map(program.resolve().is_relative_to, folders))
    return "rclcpp" if is_of_ros else program.name


def _is_own(path: Path) -> bool:
    """Return whether a program is Python, of its environment, or made by a test."""
    return path.name.startswith("python") or any(path.is_relative_to(own) for own in _own_folders())


@functools.cache
def _own_folders() -> tuple[Path, ...]:
    root = Path(__file__).parents[2]
    folders = (Path(sys.prefix), Path(tempfile.gettempdir()), root)
    return tuple(folder.resolve() for folder in folders)
