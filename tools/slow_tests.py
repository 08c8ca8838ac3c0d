"""List the tests that are slow, ``tests/slow.txt``, after the figures of the last run.

A function is listed if its tests, each with its own parameters, took half a second or more on the
average of those that passed. Cases that say themselves that they are slow do not count. What the
last run left out stays listed while it is there; after ``make test-all`` nothing is left out. Exit
code 0: the list is written.
"""

from __future__ import annotations

import argparse
import statistics
import sys
from collections import defaultdict
from collections.abc import Mapping, Sequence
from pathlib import Path

from tests.support.record import RECORD, SLOW, Result, function_of, read, read_slow
from tools.evidence_table import tests_in

REPOSITORY = Path(__file__).resolve().parents[1]
LEAST = 0.5
"""Seconds from which a test is slow."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the list; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--record", type=Path, default=RECORD, help="what became of each test")
    parser.add_argument("--root", type=Path, default=REPOSITORY, help="the folder with the tests")
    options = parser.parse_args(arguments)
    listed = read_slow(options.root)
    slow = slow_functions(read(options.record), present(options.root, listed))
    (options.root / SLOW).write_text("".join(f"{each}\n" for each in slow), encoding="utf-8")
    print(f"{len(slow)} functions are listed, {len(listed)} were")
    return 0


def slow_functions(results: Mapping[str, Result], listed: frozenset[str]) -> list[str]:
    """Return the functions whose tests are slow, by their names.

    Args:
        results: of the last run, by the id of the test.
        listed: those that were slow before; of what has no result they are the answer.
    """
    seconds = _measured(results)
    slow = {each for each, taken in seconds.items() if _is_slow(taken)}
    return sorted(slow | listed - seconds.keys())


def unlisted(results: Mapping[str, Result], listed: frozenset[str]) -> dict[str, float]:
    """Return the functions that are slow and not listed, and the seconds of their tests."""
    measured = _measured(results).items()
    return {each: sum(s) for each, s in measured if _is_slow(s) and each not in listed}


def _is_slow(seconds: Sequence[float]) -> bool:
    return statistics.mean(seconds) >= LEAST


def _measured(results: Mapping[str, Result]) -> dict[str, list[float]]:
    """Return the seconds of each function's tests, of those that count."""
    seconds: dict[str, list[float]] = defaultdict(list)
    for test, result in results.items():
        if result.outcome == "passed" and not result.slow:
            seconds[function_of(test)].append(result.seconds)
    return seconds


def present(root: Path, functions: frozenset[str]) -> frozenset[str]:
    """Return those of some functions that a folder has, by the ids of their tests."""
    paths = {each.partition("::")[0] for each in functions}
    there = {path: tests_in(root / path) for path in paths if (root / path).is_file()}
    return frozenset(
        each
        for each in functions
        if each.rpartition("::")[2] in there.get(each.partition("::")[0], ())
    )


if __name__ == "__main__":
    sys.exit(main())
