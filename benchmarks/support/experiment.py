"""The order in which reactions are measured: everybody in turn, so that nobody has better times.

There is one action at a time, with a short pause before each: a tilt of one of the lanes that react
at once, which has to be answered before anything else is done; then, in between, one action on the
lanes that react later, many of which are under way at once. Nothing is done near the instant at
which one of these is due to react.
"""

from __future__ import annotations

import gc
import random
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

from support.reaction_rules import Lane
from support.samples import Sample
from support.schedule import Schedule

QUIET_NS = 3_000_000
"""How far everything else stays from the instant at which a reaction is due."""

PAUSE_NS = (4_000_000, 9_000_000)
"""The least and the greatest pause before each action; drawn anew, to fall in with no timer."""

LIMIT_NS = 2_000_000_000
"""How long after it is due a reaction counts as lost."""

WARM_UP = 20
"""How many rounds of the immediate lanes come before the first that is measured."""


class Channel(Protocol):
    """Both topics of a lane, from the driver's side.

    Attributes:
        lane: the topics.
        resets: whether the other side's state turns false when it is levelled; a relay's is always
            true.
        sent, received: the last tilt and its answer, by CLOCK_MONOTONIC in ns; 0 for none yet.
    """

    lane: Lane
    resets: bool
    sent: int
    received: int

    def tilt(self) -> None:
        """Tilt; the answer is a true state, some time."""

    def ask(self, tilted: bool, limit: int) -> bool:
        """Tilt or level, and receive until the answer comes, for at most ``limit`` ns.

        Returns:
            whether it came.
        """


class Driver(Protocol):
    """What receives meanwhile."""

    def meet(self, seconds: float, watch: Callable[[], None]) -> None:
        """Wait until there is somebody at the other end of everything; ``watch`` is called often.

        Raises:
            TimeoutError: if there still is not after so many seconds.
        """

    def spin_until(self, instant: int) -> None:
        """Receive until an instant of CLOCK_MONOTONIC, in ns."""


@dataclass(slots=True)
class Progress:
    """How much has been measured, of how much."""

    done: int = 0
    wanted: int = 0
    lost: int = 0


class Timed:
    """The lanes of one kind whose reaction comes after a while.

    Args:
        wanted: how many samples of each duration.
    """

    def __init__(self, channels: Sequence[Channel], wanted: int) -> None:
        """Begin with all lanes at rest."""
        self._idle = list(channels)
        self._tilted: list[Channel] = []
        self._answered: list[Channel] = []
        self._open = dict.fromkeys((each.lane.seconds for each in channels), wanted)
        self.samples: list[Sample] = []
        self.progress = Progress(wanted=wanted * len(self._open))

    def act(self, schedule: Schedule) -> bool:
        """Do the next thing that is to be done; return whether there was one."""
        return self._collect() or self._level() or self._tilt(schedule)

    def _collect(self) -> bool:
        """Take in the answers; this disturbs nobody, so it never counts as something done."""
        for channel in list(self._tilted):
            lane, sent = channel.lane, channel.sent
            due = sent + round(lane.seconds * 1e9)
            if channel.received:
                self.samples.append(Sample(lane.name, lane.seconds, sent, channel.received))
                self.progress.done += 1
            elif time.monotonic_ns() > due + LIMIT_NS:
                self.progress.lost += 1
                self._open[lane.seconds] += 1
            else:
                continue
            self._tilted.remove(channel)
            (self._answered if channel.resets else self._idle).append(channel)
        return False

    def _level(self) -> bool:
        if not self._answered:
            return False
        channel = self._answered[0]
        if channel.ask(False, LIMIT_NS):
            self._idle.append(self._answered.pop(0))
        return True

    def _tilt(self, schedule: Schedule) -> bool:
        for channel in self._idle:
            seconds = channel.lane.seconds
            due = time.monotonic_ns() + round(seconds * 1e9)
            if self._open[seconds] and schedule.admits(due):
                self._open[seconds] -= 1
                self._idle.remove(channel)
                self._tilted.append(channel)
                channel.tilt()
                schedule.add(due)
                return True
        return False


class Immediate:
    """A lane whose reaction comes at once.

    Args:
        wanted: how many samples.
    """

    def __init__(self, channel: Channel, wanted: int) -> None:
        """Begin level."""
        self._channel = channel
        self.samples: list[Sample] = []
        self.progress = Progress(wanted=wanted)

    def tilt(self, measured: bool) -> None:
        """Tilt and wait for the answer."""
        channel = self._channel
        answered = channel.ask(True, LIMIT_NS)
        if not measured:
            return
        if answered:
            self.samples.append(Sample(channel.lane.name, 0.0, channel.sent, channel.received))
            self.progress.done += 1
        else:
            self.progress.lost += 1

    def level(self) -> None:
        """Level and wait for the answer, so that the next tilt is an edge again."""
        self._channel.ask(False, LIMIT_NS)


class Experiment:
    """All that is measured in one run.

    Args:
        watch: called about once a second, while nothing is measured, with the progress.
    """

    def __init__(
        self,
        driver: Driver,
        immediate: Sequence[Immediate],
        timed: Sequence[Timed],
        watch: Callable[[], None],
    ) -> None:
        """Prepare the run."""
        self._driver = driver
        self._immediate = list(immediate)
        self._timed = list(timed)
        self._watch = watch
        self._watched = 0
        self._schedule = Schedule(QUIET_NS)
        self._random = random.Random(1)

    def run(self) -> None:
        """Measure until there are enough samples of everything."""
        gc.collect()
        gc.disable()
        try:
            for _ in range(WARM_UP):
                self._round(measured=False)
            while self._is_wanting():
                self._round(measured=True)
        finally:
            gc.enable()

    def _is_wanting(self) -> bool:
        everything = [each.progress for each in self._immediate]
        everything += [each.progress for each in self._timed]
        return any(each.done < each.wanted for each in everything)

    def _round(self, measured: bool) -> None:
        """Tilt and level each of the immediate lanes once, with other lanes' turns in between."""
        self._random.shuffle(self._immediate)
        for each in self._immediate:
            self._pause()
            each.tilt(measured)
            self._give_way(measured)
            self._pause()
            each.level()
            self._give_way(measured)

    def _give_way(self, measured: bool) -> None:
        """Let the timed lanes have their turn, each kind as often first as the other."""
        if not measured:
            return
        self._timed.append(self._timed.pop(0))
        self._pause()
        for each in self._timed:
            if each.act(self._schedule):
                return

    def _pause(self) -> None:
        now = time.monotonic_ns()
        if now - self._watched > 1_000_000_000:
            self._watched = now
            self._watch()
        self._schedule.forget_before(now)
        free = self._schedule.first_free(now + self._random.randint(*PAUSE_NS))
        self._driver.spin_until(free)
