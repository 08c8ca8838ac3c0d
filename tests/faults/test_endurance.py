"""Faults that only come with time: lost triggers and growing memory."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.faults import Robot
from tests.support.played import load
from tests.support.ros import LIMIT

pytestmark = pytest.mark.ros

TOGGLER = Path(__file__).resolve().parents[1] / "support" / "toggler.py"
TRIGGERS = 10_000

SOAK_MESSAGES = int(os.environ.get("DEROS_SOAK_MESSAGES", "50_000"))
"""How many messages the soak lasts; hours find what seconds do not."""

EVENTS_KEPT = 1000
"""How many events the node keeps for those who ask late: until then its memory does grow."""

GROWTH = 500_000
"""Bytes by which the node may grow, however long it runs: caches that are filled once.

The least object takes 16 bytes, so leaking one a message takes more than that in the shortest soak.
"""


def toggle(robot: Robot, times: int) -> None:
    """Break a rule and keep it again, so many times, each as soon as the answer has come."""
    command = [sys.executable, str(TOGGLER), "/load", "/slow", "99.0", "1.0", str(times)]
    done = subprocess.run(command, env=robot.env, capture_output=True, text=True, timeout=3 * LIMIT)
    assert done.returncode == 0, done.stdout + done.stderr


def test_ten_thousand_triggers_in_a_row_are_all_carried_out(robot: Robot) -> None:
    """Each of 10,000 violations is answered by the action, and each end of one by its reset."""
    with robot.safety_node() as node:
        toggle(robot, EVENTS_KEPT)
        before = node.memory()
        toggle(robot, TRIGGERS - EVENTS_KEPT)
        robot.until_alive()
        assert node.output().count("slow, by heavy") == TRIGGERS
        assert node.memory() - before < GROWTH


def test_memory_does_not_grow(robot: Robot) -> None:
    """Fifty thousand messages at full speed, triggers among them, leave nothing behind."""
    each = 500
    messages = [load(99.0), *(load(float(number % 40)) for number in range(each - 1))]

    def taken() -> int:
        return node.output().count("slow, by heavy") * each

    with robot.safety_node() as node, robot.sensors() as sensors:
        sensors.drive()
        robot.until_free()
        sensors.match("/load")
        toggle(robot, EVENTS_KEPT)
        sensors.send("/load", *messages, times=20 * each, rate=20_000.0)  # warms up
        first, before = taken(), node.memory()
        while taken() < first + SOAK_MESSAGES:
            sensors.send("/load", *messages, times=20 * each, rate=20_000.0)
        growth = node.memory() - before
        print(f"{growth} bytes after {taken() - first} messages")
        assert growth < GROWTH
