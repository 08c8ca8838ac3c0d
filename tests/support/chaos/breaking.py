"""How each fault is made, and each rule is broken; both are undone in the end."""

from __future__ import annotations

import base64
import contextlib
import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

from tests.support.chaos.bench import Bench
from tests.support.chaos.driving import LEVERS
from tests.support.chaos.links import BY_NAME
from tests.support.chaos.robot import Neighbours, feed, starve
from tests.support.chaos.schedule import FOREIGN, Fault, Provocation, Schedule
from tests.support.processes import freeze, thaw
from tests.support.ros import environment

INTRUDER = Path(__file__).with_name("intruder.py")


@contextlib.contextmanager
def _stopped(bench: Bench, fault: Fault) -> Iterator[None]:
    pid = bench.process_of(fault.target)
    freeze(pid)
    try:
        yield
    finally:
        with contextlib.suppress(ProcessLookupError):
            thaw(pid)


@contextlib.contextmanager
def _starved(bench: Bench, fault: Fault) -> Iterator[None]:
    pid = bench.process_of(fault.target)
    neighbours = Neighbours()
    starve(pid)
    try:
        yield
    finally:
        feed(pid)
        neighbours.close()


@contextlib.contextmanager
def _bad_link(bench: Bench, fault: Fault) -> Iterator[None]:
    bench.proxy.fault(fault.link, fault.kind, fault.amount)
    try:
        yield
    finally:
        bench.proxy.heal(fault.link, fault.kind)


@contextlib.contextmanager
def _intruder(bench: Bench, fault: Fault) -> Iterator[None]:
    process = bench.intruders.pop(0)
    assert process.stdin is not None
    process.stdin.write(_order(fault) + "\n")
    process.stdin.flush()
    try:
        yield
    finally:
        process.terminate()
        process.wait()


@contextlib.contextmanager
def intruders(bench: Bench, schedule: Schedule) -> Iterator[None]:
    """Have the foreign processes of a round in their domains, silent, before it begins."""
    faults = [fault for fault in schedule.faults if fault.kind == "second publisher"]
    with contextlib.ExitStack() as stack:
        for fault in sorted(faults, key=lambda fault: fault.begin):
            process = subprocess.Popen(
                [sys.executable, str(INTRUDER)],
                env=environment(bench.domains[fault.domain]),
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                text=True,
            )
            stack.enter_context(process)
            stack.callback(process.kill)
            bench.intruders.append(process)
        stack.callback(bench.intruders.clear)
        for process in bench.intruders:
            assert process.stdout is not None
            process.stdout.readline()
        yield


def _order(fault: Fault) -> str:
    """Return what lets an intruder speak, twenty times a second."""
    from rclpy.serialization import serialize_message

    topic = BY_NAME[fault.target]
    kind = topic.message_type()
    messages = [kind()]
    words = FOREIGN[fault.target, fault.domain][int(fault.amount)]
    if words == "counting":
        messages = [kind(data=number) for number in range(10_000, 12_000)]
    elif words == "constant":
        messages = [kind(data=1)]
    elif words == "free":
        scan = kind(angle_min=-1.5, angle_max=1.5, angle_increment=0.1, range_max=25.0)
        scan.ranges = [25.0] * 31
        messages = [scan]
    texts = [base64.b64encode(serialize_message(message)).decode() for message in messages]
    order = {"topic": topic.name, "type": topic.type, "latched": topic.latched, "rate": 20.0}
    return json.dumps({**order, "messages": texts})


@contextlib.contextmanager
def _killed(bench: Bench, fault: Fault) -> Iterator[None]:
    number = signal.SIGKILL if fault.kind == "kill" else signal.SIGINT
    os.kill(bench.process_of(fault.target), number)
    yield


@contextlib.contextmanager
def _clock(bench: Bench, fault: Fault) -> Iterator[None]:
    for clock in bench.clocks.values():
        clock.step(int(fault.amount))
    try:
        yield
    finally:
        for clock in bench.clocks.values():
            clock.step(0)


@contextlib.contextmanager
def _full_disk(bench: Bench, _fault: Fault) -> Iterator[None]:
    bench.disk.fill()
    try:
        yield
    finally:
        bench.disk.clear()


@contextlib.contextmanager
def provoked(bench: Bench, provocation: Provocation) -> Iterator[None]:
    """Break a rule, and keep it again in the end."""
    lever = LEVERS[provocation.kind]
    lever(bench, True)
    try:
        yield
    finally:
        lever(bench, False)


LINK_FAULTS = ("drop", "duplicate", "delay", "replay")
"""What may be wrong with a link of the proxy."""

FAULTS: Mapping[str, Callable[[Bench, Fault], contextlib.AbstractContextManager[None]]] = {
    "kill": _killed,
    "restart": _killed,
    "stop": _stopped,
    "starve": _starved,
    **dict.fromkeys(LINK_FAULTS, _bad_link),
    "second publisher": _intruder,
    "clock step": _clock,
    "full disk": _full_disk,
}
