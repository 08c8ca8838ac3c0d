"""What the sessions of the reaction benchmark share, on whichever client library."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from support.experiment import LIMIT_NS, Driver, Experiment, Immediate, Timed
from support.processes import Processes
from support.progress import Line
from support.samples import Sample, Trigger, match
from support.usage import Meter, stolen_ns

LOAD_TOPICS = 20

MEETING = 60.0
"""Seconds after which nobody is waited for any more."""

LISTEN_NS = 20_000_000
"""For how long the driver receives events before it is seen whether all have come."""


@dataclass(frozen=True, slots=True)
class Wanted:
    """What is to be measured.

    Attributes:
        immediate: how many reactions at once, of each.
        repeat: how many reactions after a while, of each duration.
        load: whether the machine is put under load.
        priority: the real-time priority of the nodes on rclcpp that keep deadlines; 0 for none.
    """

    immediate: int
    repeat: int
    load: bool
    priority: int = 0


def events_of(node: str) -> str:
    """Return the topic on which a safety node tells what it does."""
    return f"/{node}/events"


def start_load(processes: Processes) -> None:
    """Put the machine under load: a burner for each processor, and topics at 100 Hz."""
    topics = [f"/load/topic_{number}" for number in range(LOAD_TOPICS)]
    processes.start("reaction_nodes.listener", *topics)
    processes.start("reaction_nodes.talker", *topics)
    for number in range(len(os.sched_getaffinity(0))):
        processes.start("reaction_nodes.burner", name=f"burner_{number}")


def carry_out(
    title: str,
    driver: Driver,
    processes: Processes,
    at_once: Sequence[Immediate],
    later: Sequence[Timed],
) -> float:
    """Wait until all nodes have met, and measure until there is enough of everything.

    Return what the machine's host took of its processors meanwhile, in percent.
    """
    everything = [*(each.progress for each in at_once), *(each.progress for each in later)]
    with Line(sys.stderr) as line:
        line.show(f"{title}: waiting for all nodes to meet")
        driver.meet(MEETING, processes.check)

        def watch() -> None:
            processes.check()
            done = sum(min(each.done, each.wanted) for each in everything)
            wanted = sum(each.wanted for each in everything)
            lost = sum(each.lost for each in everything)
            tail = f", {lost} lost" if lost else ""
            line.show(f"{title}: {done} of {wanted} reactions{tail}")

        stolen = Meter.start(stolen_ns)
        Experiment(driver, at_once, later, watch).run()
        return stolen.percent()


def receive_events(
    driver: Driver, reported: Callable[[], list[Trigger]], samples: Sequence[Sample]
) -> list[Trigger]:
    """Receive until the safety nodes have reported all reactions; return the triggers.

    They tell after they have acted, so the last of it comes after the last reaction. What has not
    come within the time in which a reaction would count as lost, is not reported.
    """
    end = time.monotonic_ns() + LIMIT_NS
    while len(match(samples, triggers := reported())) < len(samples):
        if (now := time.monotonic_ns()) > end:
            break
        driver.spin_until(now + LISTEN_NS)
    return triggers


def lost(safety: Iterable[Immediate | Timed]) -> int:
    """Return how many reactions have not come."""
    return sum(each.progress.lost for each in safety)
