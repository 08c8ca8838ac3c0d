"""Compare the generated monitors with the reference engine on very many random pairs.

Rules and traces are drawn anew in every run: first for the monitor in Python, then, where there is
a compiler, for the one in C. Where one differs, the pair is made as small as it can be and kept as
a file (see ``tests/support/counterexamples.py``), which ``make test`` compares from then on. Exit
code 1 says that one was found.
"""

from __future__ import annotations

import argparse
import multiprocessing
import os
import secrets
import sys
import tempfile
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path

from hypothesis import HealthCheck, Phase, given, seed, settings
from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)

from tests.support import c_pairs, counterexamples
from tests.support.c_library import Loaded, has_compiler
from tests.support.counterexamples import Pair, pairs
from tests.support.strategies import ALL_KINDS, KINDS, programs

CHUNK = 200
"""Pairs that a process draws between two reports of progress."""

FOCUSES: tuple[tuple[str, ...], ...] = (
    tuple(KINDS),
    tuple(KINDS),
    ("scan", "array", "element"),
    ("number", "boolean"),
    ("stamped", "number", "quaternion"),
    tuple(ALL_KINDS),
)
"""The kinds of inputs that chunks draw, in turn."""


@dataclass(frozen=True)
class Outcome:
    """What became of a chunk: how many pairs passed, and the smallest that did not."""

    passed: int
    failed: Pair | None
    why: str = ""


def check(number: int, chunk_seed: int, pairs_wanted: int) -> Outcome:
    """Draw and compare one chunk of pairs."""
    passed = 0
    failures: list[Pair] = []

    @seed(chunk_seed)
    @settings(
        max_examples=pairs_wanted,
        database=None,
        deadline=None,
        phases=(Phase.generate, Phase.shrink),
        suppress_health_check=list(HealthCheck),
        report_multiple_bugs=False,
        print_blob=False,
    )
    @given(programs(kinds=FOCUSES[number % len(FOCUSES)]).flatmap(pairs))
    def compare(pair: Pair) -> None:
        nonlocal passed
        try:
            pair.compare()
        except Exception:
            failures.append(pair)  # the smallest comes last
            raise
        passed += 1

    try:
        compare()
    except Exception as error:
        if not failures:
            raise
        return Outcome(passed, failures[-1], f"{type(error).__name__}: {error}")
    return Outcome(passed, None)


def check_c(number: int, chunk_seed: int, pairs_wanted: int) -> Outcome:
    """Draw a chunk of pairs, compile their programs as a robot's would be, and compare them."""
    kinds = tuple(c_pairs.FOCUSES.values())
    wanted = -(-pairs_wanted // c_pairs.TRACES)
    cases = c_pairs.cases(kinds[number % len(kinds)], wanted, chunk_seed)
    with tempfile.TemporaryDirectory(prefix="deros-property-") as folder:
        library = Loaded([each.unit for each in cases], Path(folder), "-O2")
        for pair, error in c_pairs.differences(library, cases):
            return Outcome(0, pair, f"in C, {type(error).__name__}: {error}")
    return Outcome(sum(len(each.pairs) for each in cases), None)


Check = Callable[[int, int, int], Outcome]


def outcomes(check: Check, wanted: int, jobs: int, first_seed: int) -> Iterator[Outcome]:
    """Yield the outcome of each chunk as it comes in."""
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(jobs, context) as executor:
        futures = [
            executor.submit(check, number, first_seed + number, min(CHUNK, wanted - begun))
            for number, begun in enumerate(range(0, wanted, CHUNK))
        ]
        try:
            for future in as_completed(futures):
                yield future.result()
        finally:
            executor.shutdown(cancel_futures=True)


def main() -> int:
    """Print how many pairs passed; return 1 at the first that did not."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--pairs", type=int, default=100_000)
    parser.add_argument("--c-pairs", type=int, default=20_000, help="pairs for C")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--seed", type=int, help="repeats an earlier run")
    arguments = parser.parse_args()
    first_seed = secrets.randbelow(1 << 48) if arguments.seed is None else arguments.seed

    console = Console()
    console.print(f"seed {first_seed}")
    runs: list[tuple[str, Check, int, Path]] = [
        ("Python", check, arguments.pairs, counterexamples.FOLDER)
    ]
    if has_compiler():
        runs.append(("C", check_c, arguments.c_pairs, c_pairs.FOLDER))
    else:
        console.print("no C compiler: the monitor in C is not compared")
    for name, each, wanted, folder in runs:
        chunks = outcomes(each, wanted, arguments.jobs, first_seed)
        if not run(console, name, chunks, wanted, folder):
            return 1
    return 0


def run(console: Console, name: str, chunks: Iterator[Outcome], wanted: int, folder: Path) -> bool:
    """Show how far the comparison is; tell whether all pairs passed."""
    columns = (BarColumn(), MofNCompleteColumn(), TimeElapsedColumn(), TimeRemainingColumn())
    passed = 0
    with Progress(TextColumn("pairs"), *columns, console=console) as progress:
        task = progress.add_task("pairs", total=wanted)
        for outcome in chunks:
            passed += outcome.passed
            progress.update(task, completed=passed)
            if not console.is_terminal and passed // 2000 > (passed - outcome.passed) // 2000:
                console.print(f"{passed} pairs so far")
            if outcome.failed is not None:
                path = counterexamples.write(outcome.failed, folder)
                console.print(outcome.why, markup=False)
                console.print(f"the two differ; kept as {path}", markup=False, soft_wrap=True)
                return False
    console.print(f"{passed} pairs passed in {name}")
    return True


if __name__ == "__main__":
    sys.exit(main())
