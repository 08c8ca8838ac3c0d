"""What became of each test: ``pytest --record FILE`` writes it, ``--after FILE`` reads it.

``--slow-share S --draw TEXT`` runs a share of the slow tests, which another text draws anew; 0 runs
none of them, 1, the default, all. With ``--after FILE``, of the tests that are not slow only those
are run that were skipped in the run that FILE records, because a program was missing.

Slow are those that say so, ``@pytest.mark.slow``, and those that ``tests/slow.txt`` lists, since
each of their cases takes half a second or more on the average (:mod:`tools.slow_tests`). One of
these that is ``essential`` is not, so it is run with each change. ``slow(seconds=S)`` says that
each case takes far longer than others: it is drawn the less often.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path

import pytest

RECORD = Path(__file__).resolve().parents[2] / ".tmp/tests.json"
"""What became of each test of the last run."""

SLOW = Path("tests/slow.txt")
"""The list of functions whose tests are slow, as measured; below pytest's root folder."""


@dataclass
class Result:
    """One test.

    Attributes:
        outcome: ``passed``, ``skipped`` or ``failed``, of setup, test and teardown the worst.
        seconds: that it took, with setup and teardown.
        text: why it was skipped or how it failed, in one line.
        slow: whether it says itself that it is.
    """

    outcome: str = "passed"
    seconds: float = 0.0
    text: str = ""
    slow: bool = False


def read(path: Path) -> dict[str, Result]:
    """Return the results that were recorded, by the id of the test."""
    entries = json.loads(path.read_text(encoding="utf-8"))
    return {test: Result(**entry) for test, entry in entries.items()}


def function_of(test: str) -> str:
    """Return the id of a test without its parameters: of all cases of a function."""
    return test.partition("[")[0]


def read_slow(root: Path) -> frozenset[str]:
    """Return the functions, by the ids of their tests, that a root folder lists as slow."""
    path = root / SLOW
    return frozenset(path.read_text(encoding="utf-8").split() if path.exists() else ())


def write(path: Path, results: Mapping[str, Result]) -> None:
    """Write results in the form that :func:`read` takes."""
    path.parent.mkdir(parents=True, exist_ok=True)
    entries = {test: asdict(result) for test, result in results.items()}
    path.write_text(json.dumps(entries, indent=0), encoding="utf-8")


# Plug-in of pytest --------------------------------------------------------------------------------

_LISTED = pytest.StashKey[frozenset[str]]()


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the options."""
    group = parser.getgroup("deros")
    group.addoption("--record", type=Path, help="write there what became of each test")
    group.addoption("--after", type=Path, help="run no quick test that FILE records as run")
    group.addoption("--slow-share", type=float, default=1.0, help="the share of slow tests to run")
    group.addoption("--draw", default="", help="a text by which the slow tests are drawn")


def pytest_configure(config: pytest.Config) -> None:
    """Record in the process that hears of all tests, not in its workers."""
    config.stash[_LISTED] = listed = read_slow(config.rootpath)
    path = config.getoption("record")
    if path is not None and not hasattr(config, "workerinput"):
        config.pluginmanager.register(_Recorder(path, listed))


def pytest_itemcollected(item: pytest.Item) -> None:
    """Mark what is listed as slow, unless it is essential."""
    listed = item.config.stash[_LISTED]
    if function_of(item.nodeid) in listed and not item.get_closest_marker("essential"):
        item.add_marker("slow")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Keep the drawn ones of the slow tests, and of the others those that are asked for."""
    share, draw = config.getoption("slow_share"), config.getoption("draw")
    after = config.getoption("after")
    results = None if after is None else read(after)

    def is_run(item: pytest.Item) -> bool:
        mark = item.get_closest_marker("slow")
        if mark is not None:
            return bool(share >= 1 or _drawn(f"{draw} {item.nodeid}") < share * _weight(mark))
        return results is None or item.nodeid not in results or _was_missed(results[item.nodeid])

    left = [item for item in items if not is_run(item)]
    if left:
        config.hook.pytest_deselected(items=left)
        items[:] = [item for item in items if is_run(item)]


def _weight(mark: pytest.Mark) -> float:
    """Return how often a slow test is drawn, beside others; those are taken to last 10 s."""
    seconds = float(mark.kwargs.get("seconds", 10.0))
    return min(1.0, 10.0 / seconds)


def _was_missed(result: Result) -> bool:
    return result.outcome == "skipped" and "Skipped: no " in result.text


def _drawn(text: str) -> float:
    """Return a number from 0 to 1, less than 1, that follows from a text."""
    return int.from_bytes(hashlib.sha256(text.encode()).digest()[:6], "big") / 2**48


class _Recorder:
    def __init__(self, path: Path, listed: frozenset[str]) -> None:
        self._path = path
        self._listed = listed
        self._results: dict[str, Result] = {}

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        result = self._results.setdefault(report.nodeid, Result())
        result.seconds += report.duration
        is_listed = function_of(report.nodeid) in self._listed
        result.slow = "slow" in report.keywords and not is_listed
        if report.outcome != "passed" and result.outcome != "failed":
            result.outcome, result.text = report.outcome, _line(report)

    def pytest_sessionfinish(self) -> None:
        write(self._path, self._results)


def _line(report: pytest.TestReport) -> str:
    """Return the reason of a report in one line."""
    if isinstance(report.longrepr, tuple):
        return str(report.longrepr[2])
    crash = getattr(report.longrepr, "reprcrash", None)
    text = str(report.longrepr) if crash is None else str(crash.message)
    return text.strip().partition("\n")[0]
