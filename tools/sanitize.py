"""Compare monitors in C with the reference while the compiler's sanitizers watch them.

Random programs with random traces, compiled with the address and the undefined-behaviour sanitizer,
and stopped at the first finding. Exit code 1 says that there is one, or a difference from the
reference; 2 that the compiler has no sanitizers.
"""

from __future__ import annotations

import argparse
import secrets
import sys
import tempfile
from pathlib import Path

from tests.support import c_library, c_pairs, counterexamples
from tests.support.capabilities import has_sanitizers


def main() -> int:
    """Print how many pairs passed; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--programs", type=int, default=60, help="for each choice of inputs")
    parser.add_argument("--seed", type=int, help="repeats an earlier run")
    arguments = parser.parse_args()
    if not has_sanitizers():
        print("make sanitize needs gcc with libasan and libubsan (Debian: gcc)", file=sys.stderr)
        return 2
    seed = secrets.randbelow(1 << 48) if arguments.seed is None else arguments.seed
    print(f"seed {seed}", flush=True)
    for focus, kinds in c_pairs.FOCUSES.items():
        cases = c_pairs.cases(kinds, arguments.programs, seed)
        try:
            passed = watch(cases)
        except AssertionError as error:
            print(f"{focus}: {error}")
            return 1
        print(f"{focus}: {passed} pairs of {len(cases)} programs passed", flush=True)
    return 0


def watch(cases: list[c_pairs.Case]) -> int:
    """Compare the cases in a program that is watched; return how many pairs passed.

    Raises:
        AssertionError: the sanitizers found something, or a pair differs; it is kept.
    """
    units = [each.unit for each in cases]
    with (
        tempfile.TemporaryDirectory(prefix="deros-sanitize-") as folder,
        c_library.Watched(units, Path(folder)) as library,
    ):
        for pair, error in c_pairs.differences(library, cases):
            path = counterexamples.write(pair, c_pairs.FOLDER)
            raise AssertionError(f"{error}\nkept as {path}") from error
    return sum(len(each.pairs) for each in cases)


if __name__ == "__main__":
    sys.exit(main())
