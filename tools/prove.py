"""Prove the emitted C of the example programs, or of other rules, with Frama-C.

Eva shows that no sequence of calls with any values causes a run-time error. WP proves that each
function meets its contract, which states the meaning of the rules. Prints the numbers of proved and
of all goals. With ``--new``, only what the ledger (``tools/ledger.py``) lacks is proved. Exit code
1: a goal is not proved; 2: Frama-C is not installed.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.rules import Rules
from deros.rules.compiler.build import build
from deros.rules.program.ir import Program
from tests.support import c_proof
from tools.ledger import ERRORS, Ledger, digests

REPOSITORY = Path(__file__).resolve().parents[1]
EXAMPLES = ("intelligent_one", "feeding_robot", "kobuki")

FEW = 8
"""How many of the functions to be proved are named."""

CHUNK = 16
"""After how many functions the ledger is written, so that an interrupted run loses little."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Prove the programs asked for; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    examples = [REPOSITORY / "examples" / name / f"{name}.deros" for name in EXAMPLES]
    parser.add_argument(
        "rules",
        nargs="*",
        type=Path,
        default=examples,
        help="files of rules, or sources of monitors with the contracts beside them",
    )
    parser.add_argument("--functions", default="", help="prove only these, separated by commas")
    parser.add_argument("--new", action="store_true", help="prove only what the ledger lacks")
    parser.add_argument("--check", action="store_true", help="the ledger must list what it may")
    parser.add_argument("--record", action="store_true", help="add what is proved to the ledger")
    parser.add_argument("--timeout", type=int, default=300, help="seconds for a goal")
    parser.add_argument("--jobs", type=int, default=2, help="provers at once")
    parser.add_argument("--output", type=Path, help="keep the sources and Frama-C's words here")
    options = parser.parse_args(arguments)
    if c_proof.missing():
        print(c_proof.missing(), file=sys.stderr)
        return 2
    results = []
    with tempfile.TemporaryDirectory(prefix="deros-proof-") as temporary:
        for path in options.rules:
            if path.suffix == ".c":
                functions = [each for each in options.functions.split(",") if each]
                functions = functions or c_proof.parts_of(path)
                proved = _prove(path.resolve(), path.stem, options, functions)
                results.append(set(proved) == set(functions))
            else:
                folder = (options.output or Path(temporary)) / path.stem
                source = c_proof.write(program_of(path), folder)
                results.append(_program(source, path.stem, options))
    return 0 if all(results) else 1


def program_of(path: Path) -> Program:
    """Return the program of a file of rules."""
    model = Repository().load(path).model
    assert isinstance(model, Rules), f"{path} holds no rules"
    built = build(model, InterfaceStore(()))
    assert built.program is not None, built.diagnostics
    return built.program


def _program(source: Path, name: str, options: argparse.Namespace) -> bool:
    """Prove one program, or what the ledger lacks of it; return whether all of it is proved."""
    ledger, console = Ledger(), Console(soft_wrap=True)
    chosen = [each for each in options.functions.split(",") if each] or list(digests(source))
    left = ledger.open(name, source)
    wanted = [each for each in chosen if each in left] if options.new else chosen
    known = f"{len(chosen) - len(wanted)} of {len(chosen)} functions known to be proved"
    some = ", ".join(wanted[:FEW]) + (", …" if len(wanted) > FEW else "")
    console.print(f"{name}: {known}; to prove: {len(wanted)} {some}", highlight=False)
    proved = [ERRORS] if ERRORS in wanted and _analyse(source, name) else []
    functions = [each for each in wanted if each != ERRORS]
    size = CHUNK if options.record else max(1, len(functions))
    for start in range(0, len(functions), size):
        chunk = functions[start : start + size]
        proved += _prove(source, name, options, chunk)
        if options.record:
            ledger.record(name, source, proved)
    is_listed = not options.check or _check(ledger, source, name, console)
    return set(proved) == set(wanted) and is_listed


def _check(ledger: Ledger, source: Path, name: str, console: Console) -> bool:
    """Report what the ledger lacks of a program, and what it has in vain."""
    lacks, stale = ledger.open(name, source), ledger.stale(name, source)
    for verb, names in (("lacks", lacks), ("has, and should not have,", stale)):
        if names:
            console.print(f"  the ledger {verb} {', '.join(names)}", style="red", highlight=False)
    return not lacks and not stale


def _prove(
    source: Path, name: str, options: argparse.Namespace, functions: Sequence[str]
) -> list[str]:
    """Prove functions of one program, and report the outcome; return those that are proved."""
    console = Console()
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn())
    with Progress(*columns, TimeElapsedColumn(), console=console) as progress:
        task = progress.add_task(f"{name}: proving", total=None)
        proof = c_proof.prove(
            source,
            functions,
            options.timeout,
            options.jobs,
            lambda done, total: progress.update(task, completed=done, total=total),
        )
    if options.output:
        options.output.mkdir(parents=True, exist_ok=True)
        (options.output / f"{name}.wp.log").write_text(proof.log, encoding="utf-8")
    for goal in proof.left:
        console.print(f"  not proved: {goal}", style="red", highlight=False)
    for complaint in proof.complaints:
        console.print(f"  assumed: {complaint}", style="red", highlight=False)
    console.print(f"{name}: {proof.proved} of {proof.all} goals proved", highlight=False)
    return proof.proved_of(functions)


def _analyse(source: Path, name: str) -> bool:
    """Look for run-time errors in one program, and tell how it went."""
    analysis = c_proof.analyse(source)
    reported = "not finished" if analysis.alarms is None else str(analysis.alarms)
    Console().print(f"{name}: possible run-time errors: {reported}", highlight=False)
    return analysis.is_clean


if __name__ == "__main__":
    sys.exit(main())
