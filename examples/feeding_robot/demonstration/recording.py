"""What one run showed: the watched values over time, and how each case went."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

from demonstration.referee import Event, Reaction

THINNING = 0.04
"""Shortest time, in s, between two recorded samples of a number that changes all the time."""

CURVES = frozenset({"speed", "roll", "pitch", "nearest"})
STATES = frozenset({"low_speed", "stop", "motor_stop", "engine_running"})


@dataclass(frozen=True)
class Result:
    """How one case went.

    Attributes:
        reaction_time: seconds from the instant the reaction was due, ``None`` where none was.
        failure: why the case failed, empty when it passed.
        start, end: when it was played, in s since the recording began.
    """

    number: int
    title: str
    expected: frozenset[Reaction]
    observed: frozenset[Reaction]
    reaction_time: float | None
    failure: str
    start: float
    end: float
    simulated: bool = False

    @property
    def passed(self) -> bool:
        """Whether the robot reacted as it must."""
        return not self.failure


@dataclass
class Recording:
    """Samples ``(seconds, value)`` by name; times count from the first event."""

    simulated: bool = False
    tracks: dict[str, list[tuple[float, float]]] = field(default_factory=dict)
    results: list[Result] = field(default_factory=list)
    origin: int | None = None

    def feed(self, event: Event) -> None:
        """Record an event, unless it adds nothing to the picture."""
        time = self.seconds(event.received)
        if event.name in CURVES:
            track = self.tracks.setdefault(event.name, [])
            if not track or time - track[-1][0] >= THINNING:
                track.append((time, float(event.value)))
        elif event.name in STATES:
            track = self.tracks.setdefault(event.name, [])
            if not track or track[-1][1] != event.value:
                track.append((time, float(event.value)))

    def seconds(self, instant: int) -> float:
        """Return an instant (ns) as seconds since the recording began."""
        if self.origin is None:
            self.origin = instant
        return (instant - self.origin) / 1e9

    @property
    def end(self) -> float:
        """The time of the last sample, in s."""
        return max((track[-1][0] for track in self.tracks.values() if track), default=0.0)


def percentile(values: Sequence[float], share: float) -> float:
    """Return the smallest value that ``share`` (0 to 1) of the values do not exceed.

    Raises:
        ValueError: if there are no values.
    """
    if not values:
        raise ValueError("no values")
    ordered = sorted(values)
    return ordered[max(0, math.ceil(share * len(ordered)) - 1)]
