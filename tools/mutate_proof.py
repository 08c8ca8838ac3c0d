"""Make every single slip of some kinds in the emitted C, and see that the proof finds each.

A slip is killed if a goal of the function that it is in is no longer proved. One that survives has
to be listed in ``tools/proof/equivalent.json`` with the reason why it changes nothing; what is
listed and killed, or listed and not made, is an error, too. Exit code 1 says that there is one, 2
that Frama-C is missing. A run that was interrupted goes on where it was.
"""

from __future__ import annotations

import argparse
import json
import random
import sys
import tempfile
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path
from queue import SimpleQueue

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

from tests.support import c_proof
from tests.support.c_mutants import TABLES, Mutant, mutants
from tests.support.c_slips import Effort, Found, Original, Results
from tools.prove import REPOSITORY, program_of

EQUIVALENT = REPOSITORY / "tools" / "proof" / "equivalent.json"
SHARES = {"intelligent_one": 1.0, "feeding_robot": 0.1}
"""How many of the slips of each example are made; which ones, a seed decides."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Make the slips asked for; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("examples", nargs="*", default=[*SHARES], help="names of examples")
    parser.add_argument("--share", type=float, help="make so many of all slips, 0 to 1")
    parser.add_argument("--seed", type=int, default=1, help="decides which")
    parser.add_argument("--functions", default="", help="in these alone, with commas between")
    parser.add_argument("--jobs", type=int, default=2, help="slips at once")
    parser.add_argument("--results", type=Path, default=REPOSITORY / ".tmp" / "slips")
    options = parser.parse_args(arguments)
    if c_proof.missing():
        print(c_proof.missing(), file=sys.stderr)
        return 2
    options.results.mkdir(parents=True, exist_ok=True)
    with c_proof.provers() as environment:
        complete = [_example(name, options, environment) for name in options.examples]
    return 0 if all(complete) else 1


def _example(name: str, options: argparse.Namespace, environment: dict[str, str]) -> bool:
    """Make the slips of one example, and tell how it went."""
    console = Console(soft_wrap=True)
    results = Results(options.results / f"{name}.jsonl")
    with tempfile.TemporaryDirectory(prefix="deros-slips-") as temporary:
        path = REPOSITORY / "examples" / name / f"{name}.deros"
        source = c_proof.write(program_of(path), Path(temporary) / "original")
        original = Original(source, environment)
        chosen = _chosen(
            original, SHARES[name] if options.share is None else options.share, options
        )
        found = _find(original, chosen, results, Path(temporary), options.jobs)
    return _report(name, found, console, bool(options.functions) or options.share is not None)


def _chosen(
    original: Original, share: float, options: argparse.Namespace
) -> list[tuple[str, Mutant]]:
    """Return the slips to be made, by names of which no two are equal."""
    count: Counter[str] = Counter()
    named = []
    for each in mutants(original.text, original.header):
        count[each.name] += 1
        number = f" ({count[each.name]})" if count[each.name] > 1 else ""
        named.append((each.name + number, each))
    functions = options.functions.split(",") if options.functions else []
    wanted = [each for each in named if not functions or each[1].function in functions]
    if share < 1:
        wanted = random.Random(options.seed).sample(wanted, round(share * len(wanted)))
    return wanted


def _find(
    original: Original,
    chosen: list[tuple[str, Mutant]],
    results: Results,
    folder: Path,
    jobs: int,
) -> dict[str, tuple[Mutant, Found]]:
    """Make each slip of which it is not known what becomes of it."""
    found: dict[str, tuple[Mutant, Found]] = {}
    todo = []
    for name, mutant in chosen:
        key = original.key(mutant)
        known = results.get(key)
        if known is None:
            todo.append((name, mutant, key))
        else:
            found[name] = (mutant, known)
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn())
    places: SimpleQueue[Path] = SimpleQueue()
    for number in range(jobs):
        (folder / str(number)).mkdir()
        places.put(folder / str(number))

    def one(mutant: Mutant, effort: Effort) -> Found:
        place = places.get()
        try:
            return original.find(mutant, place, effort)
        finally:
            places.put(place)

    def measured(function: str) -> Effort:
        key = original.effort_key(function)
        effort = results.effort(key)
        if effort is None:
            effort = original.effort(function)
            results.add_effort(key, function, effort)
        return effort

    with Progress(*columns, TimeElapsedColumn()) as progress, ThreadPoolExecutor(jobs) as pool:
        functions = list(dict.fromkeys(m.function for _, m, _ in todo if m.function != TABLES))
        task = progress.add_task("functions measured", total=len(functions))
        efforts = {}
        measuring = {pool.submit(measured, function): function for function in functions}
        for done in as_completed(measuring):
            efforts[measuring[done]] = done.result()
            progress.advance(task)
        todo.sort(key=lambda each: efforts.get(each[1].function, Effort()).most)
        task = progress.add_task("slips", total=len(todo))
        running = {
            pool.submit(one, mutant, efforts.get(mutant.function, Effort())): (name, mutant, key)
            for name, mutant, key in todo
        }
        for finished in as_completed(running):
            name, mutant, key = running[finished]
            found[name] = (mutant, finished.result())
            results.add(key, name, finished.result())
            progress.advance(task)
    return found


def _report(
    name: str, found: dict[str, tuple[Mutant, Found]], console: Console, is_part: bool
) -> bool:
    """Print what has become of the slips; return whether all is as it should be."""
    listed = equivalent().get(name, {})
    made = {slip: each for slip, (_, each) in found.items() if not each.refused}
    survivors = [slip for slip, each in made.items() if not each.goal]
    unlisted = [slip for slip in survivors if slip not in listed]
    wrong = [slip for slip in listed if slip in made and made[slip].goal]
    unknown = [] if is_part else [slip for slip in listed if slip not in found]
    for text, slips in (
        ("survives", unlisted),
        ("is listed as equivalent, but killed", wrong),
        ("is listed as equivalent, but not made", unknown),
    ):
        for slip in slips:
            console.print(f"  {text}: {slip}", style="red", highlight=False, markup=False)
    kinds = Counter(mutant.kind for slip, (mutant, _) in found.items() if slip in made)
    console.print(f"{name}: {_counted(kinds)}", highlight=False)
    console.print(
        f"{name}: {len(made)} slips, {len(made) - len(survivors)} killed, "
        f"{len(survivors) - len(unlisted)} equivalent, {len(unlisted)} survive; "
        f"{len(found) - len(made)} more are not C",
        highlight=False,
    )
    return not (unlisted or wrong or unknown)


def equivalent() -> dict[str, dict[str, str]]:
    """Return the slips that change nothing, by example, each with the reason."""
    listed: dict[str, list[dict[str, object]]] = json.loads(EQUIVALENT.read_text(encoding="utf-8"))
    found: dict[str, dict[str, str]] = {}
    for name, groups in listed.items():
        found[name] = {}
        for group in groups:
            slips = group["slips"]
            assert isinstance(slips, list)
            found[name].update(dict.fromkeys(slips, str(group["reason"])))
    return found


def _counted(kinds: Counter[str]) -> str:
    return ", ".join(f"{kind} {count}" for kind, count in kinds.most_common())


if __name__ == "__main__":
    sys.exit(main())
