"""What a run of the reaction benchmark has found, and the bars that it is held against."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from support.bars import Bar
from support.samples import Fired, ReportedSample, Sample, Trigger, match
from support.summary import Summary, summarize


@dataclass(frozen=True, slots=True)
class Client:
    """A client library, and what is asked for on it on an idle machine.

    Attributes:
        name: of the library.
        section: what the sections of the table that are about it begin with.
        timer: the name of the row of the timed relay's lateness before it publishes.
        median, percent_99: at most so many times that of the fastest relay an immediate reaction
            takes; None if nothing is asked.
        late_median_ms: a rule with a ``for`` is late by less than that in the median.
    """

    name: str
    section: str
    timer: str
    median: float
    percent_99: float | None
    late_median_ms: float | None


RCLPY = Client("rclpy", "", "one-shot timer of rclpy", 1.15, 1.3, 0.5)
RCLCPP = Client("rclcpp", "rclcpp, ", "thread on a condition variable", 1.1, None, None)

LATE = 1.5
"""In 99 of 100 cases a state is published at most so many times as late as a bare thread wakes."""

LOADED = 2.0
"""Under load everything takes less than so many times as long as its floor under the same load."""

SAFETY, FASTEST, USUAL = "safety", "fastest", "usual"
"""Whose immediate reactions are compared."""


@dataclass(frozen=True, slots=True)
class Run:
    """What one run has recorded.

    Args:
        client: the library that the nodes are written for.
        loaded: whether the machine was put under load.
        immediate: the reactions at once, by who reacted.
        timed: the reactions of the safety node after a while.
        floor: those of the timed relay.
        triggers: what the safety nodes tell of their reactions.
        firings: the records of the timers of the timed relay.
        sleeps: how late a plain sleep ended, in ns.
        lost: how many reactions have not come.
        traffic: messages per second of the load that have come to their receiver.
        stolen: what the machine's host took of its processors, in percent of all of them.
        priority: the real-time priority of those that keep deadlines; 0 for none.
    """

    client: Client
    loaded: bool
    immediate: dict[str, list[Sample]]
    timed: list[Sample]
    floor: list[Sample]
    triggers: list[Trigger]
    firings: list[Fired]
    sleeps: list[int]
    lost: int
    traffic: float
    stolen: float
    priority: int = 0


@dataclass(frozen=True, slots=True)
class Row:
    """One series: what was measured, of whom, its times in ns, and the floor it stands beside.

    The name of the section begins with the client's ``section``.
    """

    section: str
    name: str
    times: list[int]
    summary: Summary
    floor: Summary | None

    @property
    def ratios(self) -> tuple[float, float] | None:
        """The median and the 99th percentile as multiples of the floor's."""
        if self.floor is None:
            return None
        return _ratio(self.summary.median, self.floor.median), _ratio(
            self.summary.percent_99, self.floor.percent_99
        )


class Results:
    """The series of a run, each beside its floor, and the verdicts."""

    def __init__(self, run: Run) -> None:
        """Look at a run."""
        self.run = run
        self.durations = sorted({sample.seconds for sample in run.timed})

    @cached_property
    def immediate_reported(self) -> list[ReportedSample]:
        """The immediate reactions with the events of the safety node about them."""
        return match(self.run.immediate[SAFETY], self.run.triggers)

    @cached_property
    def timed_reported(self) -> list[ReportedSample]:
        """The timed reactions with the events of the safety node about them."""
        return match(self.run.timed, self.run.triggers)

    @cached_property
    def rows(self) -> list[Row]:
        """All series, floors first."""
        return list(self._immediate_rows()) + [
            row for seconds in (*self.durations, None) for row in self._timed_rows(seconds)
        ]

    def row(self, section: str, name: str) -> Row:
        """Return the row of that name, in a section without the client's name."""
        wanted = (f"{self.run.client.section}{section}", name)
        return next(row for row in self.rows if (row.section, row.name) == wanted)

    def _immediate_rows(self) -> Iterator[Row]:
        section = f"{self.run.client.section}immediate rule"
        late = {name: [each.late for each in found] for name, found in self.run.immediate.items()}
        floor = summarize(late[FASTEST])
        yield Row(section, "fastest relay", late[FASTEST], floor, None)
        yield _row(section, "usual relay", late[USUAL], floor)
        yield _row(section, "safety node", late[SAFETY], floor)
        inside = [each.late for each in self.immediate_reported]
        yield Row(section, "  of which inside it", inside, summarize(inside), None)

    def _timed_rows(self, seconds: float | None) -> Iterator[Row]:
        """Yield the rows of one duration, or of all durations together."""
        section = f"for {seconds:g} sec" if seconds else "all of them"
        section = f"{self.run.client.section}{section}"

        def chosen(other: float) -> bool:
            return seconds is None or other == seconds

        fired = [each for each in self.run.firings if chosen(each.duration / 1e9)]
        began = [each.began - each.due for each in fired]
        timer = summarize(began)
        yield Row(section, self.run.client.timer, began, timer, None)
        done = _row(section, "timed relay, published", [f.published - f.due for f in fired], timer)
        yield done
        published = [t.late for t in self.timed_reported if chosen(t.sample.seconds)]
        yield _row(section, "safety node, published", published, done.summary)
        relayed = [s.late for s in self.run.floor if chosen(s.seconds)]
        relay = summarize(relayed)
        yield Row(section, "timed relay, end to end", relayed, relay, None)
        received = [s.late for s in self.run.timed if chosen(s.seconds)]
        yield _row(section, "safety node, end to end", received, relay)
        if seconds is None and self.run.sleeps:
            yield Row(section, "time.sleep", self.run.sleeps, summarize(self.run.sleeps), None)

    @property
    def early(self) -> int:
        """How many of the safety node's reactions came before their time, by a nanosecond."""
        samples = [*self.run.immediate[SAFETY], *self.run.timed]
        reported = [*self.immediate_reported, *self.timed_reported]
        early = {sample for sample in samples if sample.late < 0}
        return len(early | {each.sample for each in reported if each.is_early})

    @property
    def unreported(self) -> int:
        """How many of the safety node's reactions have no event."""
        samples = len(self.run.immediate[SAFETY]) + len(self.run.timed)
        return samples - len(self.immediate_reported) - len(self.timed_reported)

    def bars(self) -> list[Bar]:
        """Hold the results against what is asked for."""
        bars = list(self._loaded_bars() if self.run.loaded else self._idle_bars())
        count = len(self.run.immediate[SAFETY]) + len(self.run.timed)
        for what, number in (
            ("reactions that are early by a nanosecond or more", self.early),
            ("reactions that have not come", self.run.lost),
            ("reactions without an event", self.unreported),
        ):
            bars.append(Bar(what, f"{number} of {count}", "none", number == 0))
        return [replace(bar, what=f"{self.run.client.section}{bar.what}") for bar in bars]

    def _idle_bars(self) -> Iterator[Bar]:
        client = self.run.client
        safety = self.row("immediate rule", "safety node")
        assert safety.ratios is not None
        median, percent_99 = safety.ratios
        yield _at_most("immediate, median / fastest relay's", median, client.median)
        if client.percent_99 is not None:
            yield _at_most("immediate, 99 % / fastest relay's", percent_99, client.percent_99)
        usual = self.row("immediate rule", "usual relay")
        against_usual = _ratio(safety.summary.median, usual.summary.median)
        yield _below("immediate, median / usual relay's", against_usual, 1.0)
        yield from self._lateness_bars()

    def _lateness_bars(self) -> Iterator[Bar]:
        """Hold lateness, of all durations together, against what waits and does nothing else.

        How late a bare thread wakes is the host's doing: milliseconds say more of it than of deros.
        """
        limit = self.run.client.late_median_ms
        if limit is not None:
            for seconds in self.durations:
                late = self.row(f"for {seconds:g} sec", "safety node, published").summary
                assert late.median is not None
                yield _below(f"for {seconds:g} sec, median late", late.median, limit, " ms")
        late = self.row("all of them", "safety node, published").summary
        bare = self.row("all of them", self.run.client.timer).summary
        ratio = _ratio(late.percent_99, bare.percent_99)
        yield _at_most(f"for T, 99 % late / {self.run.client.timer}'s", ratio, LATE)

    def _loaded_bars(self) -> Iterator[Bar]:
        sections: Sequence[tuple[str, str]] = (
            ("immediate rule", "safety node"),
            ("all of them", "safety node, published"),
            ("all of them", "safety node, end to end"),
        )
        for section, name in sections:
            ratios = self.row(section, name).ratios
            assert ratios is not None
            what = f"{section.replace('all of them', 'for T')}: {name}"
            yield _below(f"{what}, median / floor's", ratios[0], LOADED)
            yield _below(f"{what}, 99 % / floor's", ratios[1], LOADED)


def _row(section: str, name: str, times: list[int], floor: Summary) -> Row:
    return Row(section, name, times, summarize(times), floor)


def _ratio(value: float | None, floor: float | None) -> float:
    assert value is not None
    assert floor is not None
    return value / floor


def _below(what: str, value: float, limit: float, unit: str = "") -> Bar:
    return Bar(what, f"{value:.3f}{unit}", f"< {limit:g}{unit}", value < limit)


def _at_most(what: str, value: float, limit: float) -> Bar:
    return Bar(what, f"{value:.3f}", f"<= {limit:g}", value <= limit)
