"""Processor time of ``deros check`` on systems whose parts depend on many arguments.

The floor, taken in the same run, is the check of the same system without any condition. What is to
hold: 12 arguments with 40 conditions in less than 2 s, as the findings of all 4,096 combinations,
each resolved and checked by itself: the finding and, of all that have it, one that it names.
"""

from __future__ import annotations

import argparse
import itertools
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from support.varied_system import write

from deros import codes
from deros.diagnostics import Code, Span
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.system import System
from deros.rules.compiler.build_cache import BuildCache
from deros.systems.arguments.resolve import resolve
from deros.systems.arguments.variants import Variants
from deros.systems.flatten import flatten
from deros.validators.findings.context import CheckContext
from deros.validators.system.arguments.variants import EVERYWHERE, is_there, places_of
from deros.validators.system.system import check

LIMIT_SECONDS = 2.0
SIZES = ((12, 40), (20, 40), (40, 40), (12, 100), (40, 100))

_CHECK = "from deros.cli.main import main; main()"


def _seconds(path: Path) -> float:
    """Return the processor time of the check of a file, which may have findings."""
    process = subprocess.Popen(
        [sys.executable, "-c", _CHECK, "check", "--no-cache", str(path)],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode not in (0, 1):
        raise RuntimeError(f"the check ended with {process.returncode}")
    return usage.ru_utime + usage.ru_stime


def _loaded(path: Path) -> System:
    model = Repository().load(path).model
    if not isinstance(model, System):
        raise TypeError(f"{path} is not a system")
    return model


_ABOUT_ARGUMENTS = {codes.UNUSED_ARGUMENT, codes.IDLE_CONDITION}
"""Of findings about the arguments themselves, no single combination has any."""

_Key = tuple[Code, Span]


def agrees(system: System) -> bool:
    """Return whether the findings are those of all combinations, each checked by itself."""
    store = InterfaceStore()
    context = CheckContext(store, BuildCache(store), is_whole=True)
    names = [each.name for each in system.arguments]
    shown: dict[_Key, list[int]] = {}
    places: dict[int, set[Span]] = {}
    combinations = list(itertools.product((False, True), repeat=len(names)))
    for number, values in enumerate(combinations):
        plain = resolve(system, dict(zip(names, values, strict=True)))
        places[number] = places_of(flatten(plain))
        for key in {(each.code, each.span) for each in check(plain, context)}:
            shown.setdefault(key, []).append(number)
    kept = set()
    for key, numbers in shown.items():
        without = set(places).difference(numbers)
        if key[0] in _ABOUT_ARGUMENTS:
            continue
        if key[0] not in EVERYWHERE or not any(
            is_there(key[1], places[number], places) for number in without
        ):
            kept.add(key)
    found = [each for each in check(system, context) if each.code not in _ABOUT_ARGUMENTS]
    for each in found:
        told = re.findall(r"(\w+) = (true|false)", each.message.partition(", where ")[2])
        named = {(names.index(name), value == "true") for name, value in told}
        numbers = shown.get((each.code, each.span), [])
        if named and not any(
            all(combinations[number][place] == value for place, value in named)
            for number in numbers
        ):
            return False
    return {(each.code, each.span) for each in found} == kept


def main() -> int:
    """Print the table; return 1 when a limit is passed, or a finding differs."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeat", type=int, default=3, help="the best of so many runs counts")
    options = parser.parse_args()
    print(f"{'arguments':>9} {'conditions':>10} {'variants':>9} {'check s':>9} {'floor s':>9}")
    held = True
    with tempfile.TemporaryDirectory(prefix="deros-benchmark-") as folder:
        for arguments, conditions in SIZES:
            path = write(Path(folder), arguments, conditions)
            variants = len(Variants(_loaded(path)).numbers)
            seconds = min(_seconds(path) for _ in range(options.repeat))
            plain = path.with_name("plain.system")
            plain.write_text(re.sub(r" when .*", "", path.read_text(encoding="utf-8")))
            floor = min(_seconds(plain) for _ in range(options.repeat))
            plain.unlink()
            row = f"{arguments:>9} {conditions:>10} {variants:>9} {seconds:>9.2f} {floor:>9.2f}"
            print(row, flush=True)
            if (arguments, conditions) == SIZES[0]:
                held = seconds < LIMIT_SECONDS
        agreed = agrees(_loaded(write(Path(folder), *SIZES[0])))
    print(f"12 arguments, 40 conditions: limit {LIMIT_SECONDS} s")
    print(f"the findings are {'' if agreed else 'not '}those of all {1 << SIZES[0][0]:,}")
    return 0 if held and agreed else 1


if __name__ == "__main__":
    sys.exit(main())
