"""Faults of the lock that keeps a second node of a name from running: deleted, or not its own."""

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
"""Seconds from its start in which a node that finds another one of its name gives way."""


def locks(folder: Path) -> Path:
    """Return where the locks of this user are, below a temporary folder."""
    return folder / f"deros-{os.getuid()}"


def start_second(robot: Robot, folder: Path) -> Process:
    """Start a second node that shares the lock of the first, and nothing else."""
    parameters = [f"state_file:={folder / 'second'}"]
    return robot.start(NODE, parameters, TMPDIR=str(folder), TEMP="", TMP="")


def test_a_lock_that_was_deleted_lets_no_second_node_run(robot: Robot, tmp_path: Path) -> None:
    """The second takes a lock that is nobody's, finds the first by the graph, and gives way."""
    with robot.safety_node(TMPDIR=str(tmp_path)):
        begun = time.monotonic()
        robot.until(lambda: time.monotonic() > begun + EARLY)
        (lock,) = locks(tmp_path).iterdir()
        lock.unlink()
        second = start_second(robot, tmp_path)
        assert robot.until(second.popen.poll) == 1
        assert "another node publishes this heartbeat" in second.output()


def test_a_lock_that_is_deleted_later_was_not_needed(robot: Robot, tmp_path: Path) -> None:
    """The node runs on without it, and a restart after a kill takes a new one."""
    with robot.safety_node(TMPDIR=str(tmp_path)) as node:
        (lock,) = locks(tmp_path).iterdir()
        lock.unlink()
        robot.until_alive()
        node.kill()
        robot.restart()
        assert list(locks(tmp_path).iterdir()) == [lock]


def open_to_all(folder: Path) -> None:
    """Let others write into the folder of the locks."""
    locks(folder).mkdir()
    locks(folder).chmod(0o777)


def link(folder: Path) -> None:
    """Put a link in the place of the folder of the locks."""
    (folder / "another").mkdir(mode=0o700)
    locks(folder).symlink_to(folder / "another")


@pytest.mark.parametrize("put", [open_to_all, link])
def test_a_folder_of_locks_that_is_not_the_users_alone_is_not_used(
    robot: Robot, tmp_path: Path, put: Callable[[Path], None]
) -> None:
    """Whoever may write there could hold the lock: the node says so, and runs without one."""
    folder = tmp_path / "temporary"
    folder.mkdir()
    put(folder)
    with robot.safety_node(TMPDIR=str(folder)) as node:
        robot.until(lambda: "a second instance on this machine would not be seen" in node.output())
        assert list(locks(folder).iterdir()) == []
