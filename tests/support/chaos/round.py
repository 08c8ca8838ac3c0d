"""Plays rounds: lets the robot drive, breaks it as the schedule says, has it judged."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Iterator
from typing import Any

from tests.support.chaos.bench import Bench
from tests.support.chaos.breaking import FAULTS, LINK_FAULTS, intruders, provoked
from tests.support.chaos.driving import prepare
from tests.support.chaos.links import COMMAND, HEARTBEAT, LET_THROUGH, STOP
from tests.support.chaos.referee import Verdict
from tests.support.chaos.schedule import WINDOW, Fault, Provocation, Schedule

# A round ----------------------------------------------------------------------------------------


def play(bench: Bench, schedule: Schedule) -> Verdict:
    """Play one round and judge it.

    Raises:
        NotReadyError: if the robot could not be brought to drive.
    """
    with intruders(bench, schedule):
        prepare(bench)
        before = time.monotonic() - 3.0
        for link in schedule.blocked:
            bench.proxy.fault(link, "drop", 1.0)
        begin = time.monotonic()
        with contextlib.ExitStack() as open_faults:
            _run(bench, schedule, begin, open_faults)
        end = time.monotonic()
        bench.proxy.heal_all()
    messages, delays = bench.record.take(before)
    return bench.referee(messages, delays, begin, end, _is_whole(schedule)).judge()


def _run(bench: Bench, schedule: Schedule, begin: float, open_faults: contextlib.ExitStack) -> None:
    """Begin and end each fault at its time; what is still open is healed when the stack closes."""
    steps: list[tuple[float, str, Fault | Provocation]] = []
    for fault in schedule.faults:
        steps.append((fault.begin, "begin", fault))
        steps.append((fault.begin + fault.duration, "end", fault))
    if schedule.provocation.kind != "nothing":
        provocation = schedule.provocation
        steps.append((provocation.begin, "begin", provocation))
        steps.append((provocation.begin + provocation.duration, "end", provocation))
    steps.append((WINDOW, "over", schedule.provocation))
    active: dict[int, contextlib.AbstractContextManager[None]] = {}
    for moment, what, each in sorted(steps, key=lambda step: (step[0], step[1] == "begin")):
        time.sleep(max(0.0, begin + moment - time.monotonic()))  # the moment is what is drawn
        if what == "begin":
            context = _context(bench, each)
            active[id(each)] = open_faults.enter_context(_closing(context))
        elif what == "end" and id(each) in active:
            active.pop(id(each)).__exit__(None, None, None)
        elif what == "over":
            return


@contextlib.contextmanager
def _closing(context: Any) -> Iterator[Any]:
    """Enter a context; leave it at the end, unless it was left before."""
    once = _Once(context)
    try:
        yield once
    finally:
        once.__exit__(None, None, None)


class _Once(contextlib.AbstractContextManager[None]):
    """A context that was entered, and is left once."""

    def __init__(self, context: contextlib.AbstractContextManager[None]) -> None:
        """Enter it."""
        self._context: contextlib.AbstractContextManager[None] | None = context
        context.__enter__()

    def __exit__(self, *_: object) -> None:
        """Leave it, the first time."""
        if self._context is not None:
            context, self._context = self._context, None
            context.__exit__(None, None, None)


def _context(bench: Bench, each: Fault | Provocation) -> contextlib.AbstractContextManager[None]:
    if isinstance(each, Provocation):
        return provoked(bench, each)
    return FAULTS[each.kind](bench, each)


def _is_whole(schedule: Schedule) -> bool:
    """Return whether no link from the safety node to the actuator was bad."""
    said = {HEARTBEAT.name, STOP.name, LET_THROUGH.name, COMMAND.name}
    return not any(fault.kind in LINK_FAULTS and fault.target in said for fault in schedule.faults)
