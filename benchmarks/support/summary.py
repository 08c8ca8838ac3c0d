"""The six numbers that stand for many times."""

from __future__ import annotations

import statistics
from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Summary:
    """What is known of a series of times, in milliseconds; None where a source does not say."""

    count: int | None
    mean: float
    deviation: float
    least: float
    median: float | None
    percent_99: float | None
    greatest: float


def summarize(times_ns: Sequence[int]) -> Summary:
    """Return the summary of a series of times in nanoseconds.

    Raises:
        ValueError: if there are fewer than two.
    """
    if len(times_ns) < 2:
        raise ValueError(f"{len(times_ns)} measured times are too few")
    times = sorted(time / 1e6 for time in times_ns)
    return Summary(
        len(times),
        statistics.fmean(times),
        statistics.stdev(times),
        times[0],
        percentile(times, 0.5),
        percentile(times, 0.99),
        times[-1],
    )


def percentile(ordered: Sequence[float], share: float) -> float:
    """Return the value below which ``share`` of the ordered values lie, interpolated linearly."""
    position = share * (len(ordered) - 1)
    below = int(position)
    above = min(below + 1, len(ordered) - 1)
    return ordered[below] + (position - below) * (ordered[above] - ordered[below])
