"""The rows of the table: what was found of each experiment, beside what the paper found."""

from __future__ import annotations

import statistics
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Any

from ..bars import Bar
from .analysis import Analysis, Series
from .robots import Robot, Times
from .session import Measured

MOST_PROCESSOR = 2.0
"""The safety node is to take less than that of a core, in percent, as in the paper."""


@dataclass(frozen=True, slots=True)
class Run:
    """A robot, by one clock, with a safety node of one target: what was recorded and measured."""

    robot: Robot
    clock: str
    target: str
    analysis: Analysis
    measured: Measured

    @property
    def title(self) -> str:
        """What it is called."""
        return f"{self.robot.title} {self.clock}, {self.target}"

    @property
    def processor(self) -> tuple[float, float]:
        """What the safety node took of a core, in percent: the mean of all seconds, and the most.

        Raises:
            ValueError: if the run lasted for less than a second.
        """
        if not self.measured.processor:
            raise ValueError(f"{self.title}: the run lasted for less than a second")
        return statistics.fmean(self.measured.processor), max(self.measured.processor)

    @property
    def lateness_ms(self) -> tuple[float, float]:
        """How late a plain sleep ended meanwhile, in ms: the median, and the most.

        Raises:
            ValueError: if none ended.
        """
        if not self.measured.sleeps:
            raise ValueError(f"{self.title}: no sleep ended meanwhile")
        return statistics.median(self.measured.sleeps) / 1e6, max(self.measured.sleeps) / 1e6


@dataclass(frozen=True)
class Row:
    """An experiment of a run, as a row of the table."""

    run: Run
    series: Series

    @property
    def label(self) -> str:
        """The paper's label: R or S for the clock, and what is exceeded."""
        return f"{self.run.clock}_{self.series.experiment.key}"

    @property
    def ideal(self) -> float:
        """The time that the rule asks for, in seconds."""
        return self.series.experiment.ideal

    @cached_property
    def times(self) -> Times | None:
        """Average, standard deviation, least and greatest; ``None`` if too few have come."""
        times = self.series.times
        if len(times) < 2:
            return None
        return Times(statistics.fmean(times), statistics.stdev(times), min(times), max(times))

    @property
    def paper(self) -> Times | None:
        """What the paper found, if it has this row."""
        return self.series.experiment.paper.get(self.run.clock)

    @property
    def beyond_ms(self) -> list[float]:
        """By how much each time exceeds the ideal, in ms."""
        return [1e3 * (each - self.ideal) for each in self.series.times]


class Results:
    """All runs, and what is asked of them."""

    def __init__(self, runs: Sequence[Run], left_out: Sequence[str]) -> None:
        """Take the runs; ``left_out`` says what was not played, and why."""
        self.runs = tuple(runs)
        self.left_out = tuple(left_out)

    @property
    def rows(self) -> list[Row]:
        """All rows, in the order of the table."""
        return [Row(run, series) for run in self.runs for series in run.analysis.series]

    @property
    def is_explained(self) -> bool:
        """Whether all events of the safety nodes are what the rules mean, and no others."""
        return not any(run.analysis.differences for run in self.runs)

    def bars(self) -> Iterator[Bar]:
        """Yield what is asked of the runs."""
        lost = sum(row.series.lost for row in self.rows)
        early = sum(beyond < 0.0 for row in self.rows for beyond in row.beyond_ms)
        count = sum(len(row.series.times) for row in self.rows) + lost
        differences = sum(len(run.analysis.differences) for run in self.runs)
        events = sum(run.analysis.events for run in self.runs)
        yield Bar("actions that have not come", f"{lost} of {count}", "none", lost == 0)
        yield Bar("actions before the ideal time", f"{early} of {count}", "none", early == 0)
        yield Bar(
            "events that safety node and player do not share",
            f"{differences}, of {events} shared",
            "none",
            differences == 0,
        )
        for run in self.runs:
            mean = run.processor[0]
            what = f"{run.title}: processor of the safety node"
            held = mean < MOST_PROCESSOR
            yield Bar(what, f"{mean:.2f} % of a core", f"< {MOST_PROCESSOR:g} %", held)

    def as_json(self) -> dict[str, Any]:
        """Return everything that was found, every single time included."""
        return {
            "benchmark": "experiments",
            "rows": [
                {
                    "robot": row.run.robot.title,
                    "experiment": row.label,
                    "name": row.series.experiment.name,
                    "target": row.run.target,
                    "ideal_s": row.ideal,
                    "times_s": list(row.series.times),
                    "lost": row.series.lost,
                    "s": _seconds(row.times),
                    "paper_s": _seconds(row.paper),
                }
                for row in self.rows
            ],
            "runs": [
                {
                    "run": run.title,
                    "events": run.analysis.events,
                    "differences": list(run.analysis.differences),
                    "apart_ns": run.analysis.apart,
                    "processor_percent": run.measured.processor,
                    "receiver_percent": run.measured.receiver,
                    "memory_mib": run.measured.memory,
                    "memory_percent": run.measured.memory_share,
                    "sleeps_late_ns": run.measured.sleeps,
                }
                for run in self.runs
            ],
            "left_out": list(self.left_out),
            "bars": [asdict(bar) for bar in self.bars()],
        }


def _seconds(times: Times | None) -> dict[str, float] | None:
    if times is None:
        return None
    return {
        "average": times.average,
        "deviation": times.deviation,
        "least": times.least,
        "greatest": times.greatest,
    }
