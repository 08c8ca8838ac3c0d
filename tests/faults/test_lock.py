"""Faults of the lock against a second node of the same name: deleted, or not private."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.support.faults import NODE, Robot
from tests.support.victims import Process

pytestmark = pytest.mark.ros

EARLY = 5.0
"""Seconds after its start during which a node exits if it finds another one of its name."""


def locks(folder: Path) -> Path:
    """Return the folder with the locks of this user, below a temporary folder."""
    return folder / f"deros-{os.getuid()}"


def start_second(robot: Robot, folder: Path) -> Process:
    """Start a second node that shares only the lock with the first."""
    parameters = [f"state_file:={folder / 'second'}"]
    return robot.start(NODE, parameters, TMPDIR=str(folder), TEMP="", TMP="")


@pytest.mark.slow
def test_second_node_ends_even_if_the_lock_is_deleted(robot: Robot, tmp_path: Path) -> None:
    """It gets the free lock, finds the first node in the graph, and exits."""
    with robot.safety_node(TMPDIR=str(tmp_path)):
        begun = time.monotonic()
        robot.until(lambda: time.monotonic() > begun + EARLY)
        (lock,) = locks(tmp_path).iterdir()
        lock.unlink()
        second = start_second(robot, tmp_path)
        assert robot.until(second.popen.poll) == 1
        assert "another node publishes this heartbeat" in second.output()


@pytest.mark.slow
def test_node_survives_the_deletion_of_its_lock(robot: Robot, tmp_path: Path) -> None:
    """It continues without the lock, and a restart after a kill creates a new one."""
    with robot.safety_node(TMPDIR=str(tmp_path)) as node:
        (lock,) = locks(tmp_path).iterdir()
        lock.unlink()
        robot.until_alive()
        node.kill()
        robot.restart()
        assert list(locks(tmp_path).iterdir()) == [lock]


def make_writable_for_all(folder: Path) -> None:
    """Make the folder of the locks writable for others."""
    locks(folder).mkdir()
    locks(folder).chmod(0o777)


def put_link(folder: Path) -> None:
    """Replace the folder of the locks by a link."""
    (folder / "another").mkdir(mode=0o700)
    locks(folder).symlink_to(folder / "another")


@pytest.mark.slow
@pytest.mark.parametrize("put", [make_writable_for_all, put_link])
def test_shared_lock_folder_is_not_used(
    robot: Robot, tmp_path: Path, put: Callable[[Path], None]
) -> None:
    """Other users could hold the lock: the node reports this, and runs without one."""
    folder = tmp_path / "temporary"
    folder.mkdir()
    put(folder)
    with robot.safety_node(TMPDIR=str(folder)) as node:
        robot.until(lambda: "a second instance on this machine would not be seen" in node.output())
        assert list(locks(folder).iterdir()) == []
