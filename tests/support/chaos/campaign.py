"""A campaign: many rounds, a robot start for several of them, a table of what came of it."""

from __future__ import annotations

import itertools
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from rich.console import Console
from rich.markup import escape
from rich.table import Table

from tests.support.chaos.bench import NotReadyError, Software, running
from tests.support.chaos.lines import LinesReferee, change_models
from tests.support.chaos.referee import Referee, Verdict
from tests.support.chaos.round import play
from tests.support.chaos.schedule import Schedule
from tests.support.cpp import colcon_build
from tests.support.examples import EXAMPLES

SHOWN = 0.9
"""The share of the rounds that must have been played, with a robot that drives."""

PROMPT = 0.35
"""Seconds from a broken rule to zero after which a round's line says so; a loss takes 0.3 s."""

EXAMPLE = EXAMPLES / "feeding_robot"


@dataclass(frozen=True)
class Outcome:
    """What came of a round: a verdict, or why there is none."""

    schedule: Schedule
    verdict: Verdict | None
    failure: str = ""

    @property
    def result(self) -> str:
        """One word, for the table."""
        if self.verdict is None:
            return "not played"
        if self.verdict.violations:
            return "violation"
        return "held" if self.verdict.moved else "did not move"


def run(
    schedules: Sequence[Schedule],
    output: Path,
    per_start: int,
    round_s: float,
    in_cpp: bool = False,
    has_lines: bool = False,
) -> int:
    """Play the rounds, print how each went, and return the exit code.

    Args:
        schedules: the rounds.
        output: the folder for packages, logs and what violations leave.
        per_start: how many rounds are played on one start of the robot.
        round_s: about how many seconds each takes.
        in_cpp: whether safety node and gate are those in C++.
        has_lines: whether the gate is the one of :mod:`tests.support.chaos.lines`.
    """
    console = Console(soft_wrap=True, highlight=False)
    robot = generate_packages(output, in_cpp, has_lines)
    count, seed = len(schedules), schedules[0].seed
    minutes = count * round_s / 60
    console.print(f"seed {seed}: {count} rounds, about {minutes:.0f} minutes; logs in {output}")
    began = time.monotonic()
    outcomes: list[Outcome] = []
    for number, batch in enumerate(_batches(schedules, per_start)):
        folder = output / f"{seed}.{number}"
        for outcome in _play(batch, robot, folder):
            outcomes.append(outcome)
            _report(console, outcome, len(outcomes), count, time.monotonic() - began)
            if outcome.result == "violation":
                _keep(console, outcome, folder)
    console.print(_table(outcomes))
    return _conclude(console, outcomes, time.monotonic() - began)


def generate_packages(output: Path, in_cpp: bool, has_lines: bool = False) -> Software:
    """Generate the feeding robot's packages into a folder, and build what is to be built."""
    from demonstration import build  # type: ignore[import-not-found]

    example = change_models(EXAMPLE, output / "models") if has_lines else EXAMPLE
    referee = LinesReferee if has_lines else Referee
    system = example / "feeding_robot.system"
    packages = output / "packages"
    build.build(example, packages)
    if not in_cpp:
        return Software(system, packages, referee=referee)
    build.generate_cpp(example, output / "cpp")
    installed = colcon_build(output / "cpp")
    return Software(build.in_cpp(system, output), packages, installed, referee)


def _keep(console: Console, outcome: Outcome, folder: Path) -> None:
    """Write down what it takes to play a round again, and what was seen in it."""
    path = folder / f"{outcome.schedule.seed}-{outcome.schedule.number}.json"
    outcome.schedule.save(path)
    if outcome.verdict is not None:
        path.with_suffix(".txt").write_text(outcome.verdict.timeline + "\n", encoding="utf-8")
    console.print(f"  [red]kept as {path}; what the nodes said: {folder}/*/*.log[/]")


def _batches(schedules: Sequence[Schedule], size: int) -> list[list[Schedule]]:
    remaining = iter(schedules)
    return list(iter(lambda: list(itertools.islice(remaining, size)), []))


def _play(batch: Sequence[Schedule], robot: Software, folder: Path) -> Iterator[Outcome]:
    """Play some rounds on one robot, and on a new one after a round that it did not begin."""
    remaining = list(batch)
    attempt = 0
    while remaining:
        attempt += 1
        with running(robot, folder / str(attempt), remaining[0].seed) as bench:
            while remaining:
                schedule = remaining.pop(0)
                try:
                    yield Outcome(schedule, play(bench, schedule))
                except NotReadyError as error:
                    yield Outcome(schedule, None, str(error))
                    break


def _report(console: Console, outcome: Outcome, number: int, count: int, seconds: float) -> None:
    schedule = outcome.schedule
    faults = "; ".join(str(fault) for fault in schedule.faults)
    zero = outcome.verdict.slowest if outcome.verdict is not None else 0.0
    if zero > PROMPT:
        faults += f"; at zero after {zero:.2f} s"
    colour = {"held": "green", "violation": "bold red"}.get(outcome.result, "yellow")
    console.print(
        f"{number}/{count} {seconds:.0f} s  [{colour}]{outcome.result}[/]  round"
        f" {schedule.number}: {escape(str(schedule.provocation))}; {escape(faults)}"
    )
    if outcome.failure:
        console.print(f"  [yellow]{escape(outcome.failure)}[/]")
    if outcome.verdict is not None:
        for violation in outcome.verdict.violations:
            console.print(f"  [red]{escape(str(violation))}[/]")


def _table(outcomes: Sequence[Outcome]) -> Table:
    """Count, for each kind of fault, in how many rounds it was, and how they went."""
    results = ("held", "violation", "did not move", "not played")
    table = Table("fault", *results)
    counts: Counter[tuple[str, str]] = Counter()
    for outcome in outcomes:
        for kind in {fault.kind for fault in outcome.schedule.faults}:
            counts[kind, outcome.result] += 1
    for kind in sorted({kind for kind, _ in counts}):
        table.add_row(kind, *(str(counts[kind, result] or "") for result in results))
    return table


def _conclude(console: Console, outcomes: Sequence[Outcome], seconds: float) -> int:
    verdicts = [outcome.verdict for outcome in outcomes if outcome.verdict is not None]
    broken = sum(bool(verdict.broken) for verdict in verdicts)
    violated = [outcome for outcome in outcomes if outcome.result == "violation"]
    slowest = max((verdict.slowest for verdict in verdicts), default=0.0)
    console.print(
        f"{len(verdicts)} of {len(outcomes)} rounds played in {seconds:.0f} s, a rule broken in "
        f"{broken}; the pedal at zero after {slowest:.2f} s at most; {len(violated)} violations"
    )
    for outcome in violated:
        schedule = outcome.schedule
        console.print(f"  [red]--seed {schedule.seed} --round {schedule.number}[/]")
    shown = sum(verdict.moved for verdict in verdicts)
    if shown < SHOWN * len(outcomes):
        console.print(f"[red]only {shown} rounds have shown anything[/]")
        return 1
    return 1 if violated else 0
