"""What the stages of a test run (:mod:`tools.run_tests`) read, and in which order they run it.

Reading all tests takes seconds in each process. Where only tests on ROS are run, ``-m ros``, only
the modules are read that spell that mark; a test that has it without its module spelling it would
be run by no stage, and is an error in collection. Tests that need other programs come last.
"""

from __future__ import annotations

import functools
import gc
from collections.abc import Generator
from pathlib import Path

import pytest

_MARK = "mark.ros"


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Read no module without a test on ROS where only such tests are run."""
    is_asked = config.getoption("markexpr") == "ros" and collection_path.suffix == ".py"
    return True if is_asked and not _spells_mark(collection_path) else None


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """Collect no garbage while tests are read, nor later in what was read.

    It stays until the end of the run; looking for garbage in it took four tenths of the reading.
    """
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report() -> Generator[None, pytest.CollectReport, pytest.CollectReport]:
    """Refuse a test on ROS that would not be found again."""
    report = yield
    for item in report.result:
        is_ros = isinstance(item, pytest.Item) and item.get_closest_marker("ros") is not None
        if is_ros and not _spells_mark(item.path):
            report.outcome = "failed"
            report.longrepr = f"{item.nodeid} is on ROS: write {_MARK} in {item.path.name}"
    return report


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Put the tests that need other programs last; else their order stays."""
    items.sort(key=lambda item: item.get_closest_marker("needs") is not None)


@functools.cache
def _spells_mark(path: Path) -> bool:
    return _MARK in path.read_text(encoding="utf-8")
