"""Run what takes too long for a change: everything that ``.ci/run`` draws a part of, and more.

Each step is a command that anybody can run; its output is kept under ``.tmp/nightly``. The end is
one table. A run that was interrupted goes on with the steps that have not passed on this commit.
Exit code 1 says that a step failed, or that a test needed to be run again twice within a week.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from rich.console import Console
from rich.table import Table

REPOSITORY = Path(__file__).resolve().parents[1]
OUTPUT = REPOSITORY / ".tmp" / "nightly"


@dataclass(frozen=True)
class Step:
    """One command.

    Attributes:
        name: what the table calls it.
        target: a target of make, with its variables.
        figures: a pattern of what is quoted from the output, each time that it occurs.
    """

    name: str
    target: str
    figures: str


STEPS = (
    Step("all tests", "physics test-all", r"--- (\d+ passed, .*?) in "),
    Step("ROS on a busy machine", "repeat", r"(\d+ of \d+ rounds passed)"),
    Step("zeros of a gate, 100 kills", "gate-times", r"([a-z ]+, 100 times: .* at most)"),
    Step("random pairs", "pairs", r"(\d+ pairs passed in \w+)"),
    Step("properties", "property", r"(\d+ passed)"),
    Step("speed beside an earlier version", "speed", r"(\w+: [\d.]+ times the speed by hand.*)"),
    Step(
        "the paper's experiments",
        "experiments",
        r"safety node and player do not share: (\d+, of \d+ shared)",
    ),
    Step("sanitizers", "sanitize", r"(\w+: \d+ pairs of \d+ programs) passed"),
    Step("MISRA C", "misra", r"(\d+ monitors, \d+ violations)"),
    Step("fuzzing of monitors", "fuzz", r"(\w+: \d+ inputs)"),
    Step("fuzzing of models", "fuzz-models FUZZ=--seconds=900", r"([\d,]+ mutants)"),
    Step("faults drawn at random", "chaos", r"(\d+ of \d+ rounds played)|(\d+ violations)"),
    Step("the same, every kind of line", "chaos CHAOS=--lines", r"(\d+ of \d+ rounds played)"),
    Step("the extension in VS Code", "editor", r"(\d+ passed)"),
    Step("proofs and their ledger", "prove-all", r"(\w+: \d+ of \d+ goals) proved"),
    Step("slips in what is proved", "slips SHARE=0.02", r"(\w+: \d+ slips, \d+ killed)"),
    Step("reruns of the week", "reruns", r"(\S+ needed it more than once)"),
)
"""All that is done at night."""


@dataclass(frozen=True)
class Outcome:
    """How a step ended: for which commit, the exit code, its time, and what is quoted."""

    commit: str
    code: int
    seconds: float
    figures: str


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the steps, print the table; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--output", type=Path, default=OUTPUT)
    parser.add_argument("--steps", help="only these, by the beginnings of their names, with commas")
    parser.add_argument("--again", action="store_true", help="also those that have passed")
    options = parser.parse_args(arguments)
    options.output.mkdir(parents=True, exist_ok=True)
    commit = _commit()
    path = options.output / "outcomes.json"
    outcomes = _read(path)
    console = Console(soft_wrap=True)
    for step in STEPS:
        chosen = not options.steps or any(map(step.name.startswith, options.steps.split(",")))
        before = outcomes.get(step.name)
        is_done = before is not None and before.commit == commit and before.code == 0
        if not chosen or (is_done and not options.again):
            continue
        console.print(f"--- {step.name}", highlight=False)
        outcomes[step.name] = _run(step, commit, options.output)
        text = json.dumps({name: asdict(each) for name, each in outcomes.items()}, indent=1)
        path.write_text(text, encoding="utf-8")
    current = {name: each for name, each in outcomes.items() if each.commit == commit}
    console.print(_table(current, commit))
    return 0 if all(current.get(s.name) and current[s.name].code == 0 for s in STEPS) else 1


def _commit() -> str:
    command = ["git", "describe", "--always", "--dirty"]
    done = subprocess.run(command, cwd=REPOSITORY, capture_output=True, text=True, check=True)
    return done.stdout.strip()


def _read(path: Path) -> dict[str, Outcome]:
    if not path.exists():
        return {}
    entries = json.loads(path.read_text(encoding="utf-8"))
    return {name: Outcome(**entry) for name, entry in entries.items()}


def _run(step: Step, commit: str, output: Path) -> Outcome:
    """Run a step; its words go to a file of its name."""
    log = output / f"{re.sub(r'[^a-z0-9]+', '-', step.name.lower())}.log"
    command = ["make", "--no-print-directory", *step.target.split()]
    begun = time.monotonic()
    with log.open("w", encoding="utf-8") as file:
        code = subprocess.run(
            command,
            cwd=REPOSITORY,
            env={**os.environ, "COLUMNS": "200"},
            stdin=subprocess.DEVNULL,
            stdout=file,
            stderr=subprocess.STDOUT,
            check=False,
        ).returncode
    text = log.read_text(encoding="utf-8", errors="replace")
    found = [match.group(match.lastindex or 0) for match in re.finditer(step.figures, text)]
    figures = "; ".join(dict.fromkeys(found))
    return Outcome(commit, code, time.monotonic() - begun, figures)


def _table(outcomes: dict[str, Outcome], commit: str) -> Table:
    table = Table(title=f"The night of {commit}")
    for heading in ("step", "result", "minutes", "figures"):
        table.add_column(heading)
    for step in STEPS:
        found = outcomes.get(step.name)
        if found is None:
            table.add_row(step.name, "not run", "", "")
        else:
            result = "passed" if found.code == 0 else f"failed ({found.code})"
            table.add_row(step.name, result, f"{found.seconds / 60:.1f}", found.figures)
    return table


if __name__ == "__main__":
    sys.exit(main())
