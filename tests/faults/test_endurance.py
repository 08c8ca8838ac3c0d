"""Faults that need time: lost triggers and growing memory."""

from __future__ import annotations

import mmap
import os
import signal
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.support.faults import NODE, Robot
from tests.support.played import load
from tests.support.ros import LIMIT
from tests.support.victims import Process

pytestmark = pytest.mark.ros

TOGGLER = Path(__file__).resolve().parents[1] / "support" / "toggler.py"
TRIGGERS = 10_000
UNREAD = 200 * mmap.PAGESIZE // 4096
"""Enough triggers for more output than an unread pipe holds."""

SOAK_MESSAGES = int(os.environ.get("DEROS_SOAK_MESSAGES", "50_000"))
"""Number of messages of the soak test; hours find leaks that seconds do not."""

EVENTS_KEPT = 1000
"""Number of events that the node stores for late readers: until then its memory does grow."""

STRETCHES = 5
LEAST_OBJECT = 16
"""Size in bytes of the smallest Python object; a leaked object takes at least as much."""


def leak(node: Process, count: Callable[[], int], stretch: int, go_on: Callable[[], None]) -> float:
    """Return the growth of the node in bytes per counted item.

    It is the median over several stretches: a leak shows in each of them, a pool of the middleware
    that is enlarged once, in one.
    """
    growths = []
    for _ in range(STRETCHES):
        first, before = count(), node.memory()
        counted, since = first, time.monotonic()
        while counted < first + stretch:
            go_on()
            last, counted = counted, count()
            if counted > last:
                since = time.monotonic()
            assert time.monotonic() < since + LIMIT, "it does not continue"
        growths.append((node.memory() - before) / (count() - first))
    print(f"bytes for each, in {STRETCHES} stretches: {growths}")
    return statistics.median(growths)


def toggler(robot: Robot, times: int) -> subprocess.Popen[str]:
    """Violate and satisfy a rule repeatedly, each time as soon as the response arrives."""
    command = [sys.executable, str(TOGGLER), "/load", "/slow", "99.0", "1.0", str(times)]
    return subprocess.Popen(
        command, env=robot.env, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )


@pytest.mark.slow
def test_ten_thousand_triggers_are_all_executed(robot: Robot) -> None:
    """Each of 10,000 violations triggers the action, and each end resets it.

    The node does not grow by them, either.
    """

    def triggers() -> int:
        return node.output().count("slow, by heavy")

    with robot.safety_node() as node, toggler(robot, TRIGGERS) as toggling:
        robot.until(lambda: triggers() >= EVENTS_KEPT)
        stretch = (TRIGGERS - 2 * EVENTS_KEPT) // STRETCHES
        grown = leak(node, triggers, stretch, lambda: robot.spin(0.1))
        output, _ = toggling.communicate(timeout=LIMIT)
        assert toggling.returncode == 0, output
        robot.until_alive()
        assert triggers() == TRIGGERS
        assert grown < 4 * LEAST_OBJECT


def test_unread_output_blocks_nothing(robot: Robot) -> None:
    """A hung launcher leaves a full pipe; the node drops the output, and acts."""
    command, env = robot.software.command(NODE, robot.env)
    with (
        subprocess.Popen(
            command,
            env=env,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            pipesize=mmap.PAGESIZE,
        ) as node,
        toggler(robot, UNREAD) as toggling,
    ):
        try:
            output, _ = toggling.communicate(timeout=LIMIT)
            assert toggling.returncode == 0, output
            robot.until_alive()
            node.send_signal(signal.SIGINT)
            assert node.wait(LIMIT) == 0
            assert node.stdout is not None
            unread = node.stdout.read()
            assert len(unread) <= mmap.PAGESIZE
            assert b"slow, by heavy" in unread
        finally:
            toggling.kill()
            node.kill()


@pytest.mark.slow
def test_memory_does_not_grow(robot: Robot) -> None:
    """Fifty thousand messages at full speed, with triggers among them, leave nothing behind.

    They are sent in bursts, each after the node has caught up with the last: until then it does use
    memory for waiting messages (see docs/guarantees.md).
    """
    each = 500
    messages = [load(99.0), *(load(float(number % 40)) for number in range(each - 1))]

    def taken() -> int:
        return node.output().count("slow, by heavy") * each

    with robot.safety_node() as node, robot.sensors() as sensors:
        sensors.drive()
        robot.until_free()
        sensors.match("/load")

        def send() -> None:
            sensors.send("/load", *messages, times=4 * each, rate=20_000.0)
            robot.until_alive()  # its timers run after the waiting messages

        with toggler(robot, EVENTS_KEPT) as toggling:
            output, _ = toggling.communicate(timeout=LIMIT)
            assert toggling.returncode == 0, output
        send()
        assert leak(node, taken, SOAK_MESSAGES // STRETCHES, send) < LEAST_OBJECT
