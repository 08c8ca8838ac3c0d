"""Measured reactions, and the events of the safety node about them."""

from __future__ import annotations

from bisect import bisect_left
from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Sample:
    """One tilt: the lane, the ``for`` of its rule, and when it was sent and answered.

    Instants are of CLOCK_MONOTONIC in ns: taken just before the tilt is published, and just after
    the state is received.
    """

    lane: str
    seconds: float
    sent: int
    received: int

    @property
    def due(self) -> int:
        """The earliest instant at which the rule may be broken long enough."""
        return self.sent + round(self.seconds * 1e9)

    @property
    def late(self) -> int:
        """How much later than asked for the answer came, in ns."""
        return self.received - self.due


@dataclass(frozen=True, slots=True)
class Trigger:
    """A stop of a safety node: when it was called for, and when its state had been published.

    Both are instants of CLOCK_MONOTONIC in ns. The first is the one at which the message was
    taken, or for a rule with a ``for`` the one at which its time was up.
    """

    lane: str
    due: int
    published: int


@dataclass(frozen=True, slots=True)
class Fired:
    """A one-shot timer: its duration in ns, and three instants of CLOCK_MONOTONIC in ns.

    It was due, its callback began, and what it was to publish had been published.
    """

    duration: int
    due: int
    began: int
    published: int


@dataclass(frozen=True, slots=True)
class ReportedSample:
    """A sample with the event that the safety node published about it."""

    sample: Sample
    trigger: Trigger

    @property
    def late(self) -> int:
        """How long after its cause the state had been published, in ns."""
        return self.trigger.published - self.trigger.due

    @property
    def is_early(self) -> bool:
        """Tell whether anything of it came before its time, by a nanosecond."""
        return (
            self.sample.late < 0
            or self.trigger.due < self.sample.due
            or self.trigger.published < self.trigger.due
        )


def match(samples: Sequence[Sample], triggers: Iterable[Trigger]) -> list[ReportedSample]:
    """Join each sample with the trigger of its lane between its tilt and its answer.

    A sample without an event is left out.
    """
    by_lane: dict[str, list[Trigger]] = defaultdict(list)
    for trigger in sorted(triggers, key=lambda each: each.due):
        by_lane[trigger.lane].append(trigger)
    reported = []
    for sample in samples:
        known = by_lane[sample.lane]
        position = bisect_left(known, sample.sent, key=lambda each: each.due)
        if position < len(known) and known[position].due <= sample.received:
            reported.append(ReportedSample(sample, known[position]))
    return reported
