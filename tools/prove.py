"""Prove the emitted C of the example programs, or of other rules, with Frama-C.

Eva shows that no call, in any order and with any values, ends in a run-time error. WP proves that
each function keeps its contract, which says what the rules mean. Prints the goals proved and all;
exit code 1 says that not all are, 2 that Frama-C is missing.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.metamodels.rules import Rules
from deros.monitor.build import build
from deros.monitor.ir import Program
from tests.support import c_proof

REPOSITORY = Path(__file__).resolve().parents[1]
EXAMPLES = ("intelligent_one", "feeding_robot")


def main(arguments: Sequence[str] | None = None) -> int:
    """Prove the programs asked for; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    examples = [REPOSITORY / "examples" / name / f"{name}.deros" for name in EXAMPLES]
    parser.add_argument("rules", nargs="*", type=Path, default=examples, help="files of rules")
    parser.add_argument("--functions", default="", help="prove these alone, with commas between")
    parser.add_argument("--timeout", type=int, default=60, help="seconds for a goal")
    parser.add_argument("--jobs", type=int, default=2, help="provers at once")
    parser.add_argument("--output", type=Path, help="keep the sources and Frama-C's words here")
    options = parser.parse_args(arguments)
    if c_proof.missing():
        print(c_proof.missing(), file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory(prefix="deros-proof-") as folder:
        results = [
            _prove(path, options, (options.output or Path(folder)) / path.stem)
            for path in options.rules
        ]
    return 0 if all(results) else 1


def _program(path: Path) -> Program:
    model = Repository().load(path).model
    assert isinstance(model, Rules), f"{path} holds no rules"
    built = build(model, InterfaceStore(()))
    assert built.program is not None, built.diagnostics
    return built.program


def _prove(path: Path, options: argparse.Namespace, folder: Path) -> bool:
    """Prove one program, and tell how it went."""
    console = Console()
    source = c_proof.write(_program(path), folder)
    functions = [each for each in options.functions.split(",") if each]
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn())
    with Progress(*columns, TimeElapsedColumn(), console=console) as progress:
        task = progress.add_task(f"{path.stem}: goals", total=None)
        proof = c_proof.prove(
            source,
            functions,
            options.timeout,
            options.jobs,
            lambda done, total: progress.update(task, completed=done, total=total),
        )
    (folder / "wp.log").write_text(proof.log, encoding="utf-8")
    for name in proof.left:
        console.print(f"  not proved: {name}", style="red", highlight=False)
    for complaint in proof.complaints:
        console.print(f"  assumed: {complaint}", style="red", highlight=False)
    console.print(f"{path.stem}: {proof.proved} of {proof.all} goals proved", highlight=False)
    if functions:
        return proof.is_complete
    analysis = c_proof.analyse(source)
    (folder / "eva.log").write_text(analysis.log, encoding="utf-8")
    told = "not finished" if analysis.alarms is None else str(analysis.alarms)
    console.print(f"{path.stem}: possible run-time errors: {told}", highlight=False)
    return proof.is_complete and analysis.is_clean


if __name__ == "__main__":
    sys.exit(main())
