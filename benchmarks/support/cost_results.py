"""What a run of the cost benchmark has found, and the bars that it is held against."""

from __future__ import annotations

import statistics
from collections.abc import Iterator
from dataclasses import dataclass

LIMIT_PERCENT = 2.0
"""What the safety node may take of one core above a node that only receives, and for a scan."""

LIMIT_GROWTH_MIB = 1.0
"""By how much its resident memory may grow in a run; Python takes memory in pieces of this size."""

SAFETY, USUAL, FASTEST = "safety", "usual", "fastest"
"""The nodes, by their namespaces."""

NODES = {
    SAFETY: "generated safety node",
    USUAL: "receiver: typed, default executor",
    FASTEST: "receiver: raw, EventsExecutor",
}
"""What each of them is."""


@dataclass(frozen=True, slots=True)
class Use:
    """The processor's use by a node under a load, in percent of one core, over several turns."""

    load: str
    node: str
    percents: tuple[float, ...]

    @property
    def mean(self) -> float:
        """The mean over all turns, which are equally long."""
        return statistics.fmean(self.percents)

    @property
    def deviation(self) -> float:
        """The standard deviation among the turns."""
        return statistics.stdev(self.percents)


@dataclass(frozen=True, slots=True)
class Memory:
    """What of a node's memory was resident when it began, and at the end, in MiB."""

    node: str
    start: float
    end: float


@dataclass(frozen=True, slots=True)
class Verdict:
    """One thing that is asked for: what was found, what is allowed, and whether it holds."""

    what: str
    found: float
    limit: float
    unit: str = "%"

    @property
    def held(self) -> bool:
        """Tell whether it is kept."""
        return self.found < self.limit


@dataclass(frozen=True, slots=True)
class Results:
    """What one run has found.

    Attributes:
        loads: their names and messages per second, in the order measured.
        seconds: for how long each node was measured under each load.
        received: of the messages sent to each receiver, the share that came.
        stopped: whether the safety node still stopped the robot at the end.
    """

    loads: dict[str, float]
    uses: tuple[Use, ...]
    memory: tuple[Memory, ...]
    seconds: float
    received: dict[str, float]
    stopped: bool

    def use(self, load: str, node: str) -> Use:
        """Return the use by one node under one load."""
        return next(each for each in self.uses if (each.load, each.node) == (load, node))

    def above(self, load: str, node: str) -> float:
        """Return what the safety node takes more than another one under a load."""
        return self.use(load, SAFETY).mean - self.use(load, node).mean

    def verdicts(self, paper: str, second_scan: str) -> Iterator[Verdict]:
        """Yield the verdicts; the arguments name the loads that they are about."""
        for node in (USUAL, FASTEST):
            what = f"at the paper's load, above the {NODES[node]}"
            yield Verdict(what, self.above(paper, node), LIMIT_PERCENT)
        added = self.use(second_scan, SAFETY).mean - self.use(paper, SAFETY).mean
        yield Verdict("a 2,000-range scan at 40 Hz adds", added, LIMIT_PERCENT)
        for each in self.memory:
            if each.node == SAFETY:
                yield Verdict("its memory grows by", each.end - each.start, LIMIT_GROWTH_MIB, "MiB")
