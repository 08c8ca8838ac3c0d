"""Faults of what the safety node keeps on disk: damaged, unreadable, no space left."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.support.faults import Robot
from tests.support.preload import Disk

pytestmark = pytest.mark.ros


def cut(file: Path) -> None:
    """Leave half of it, as a crash of the machine may."""
    file.write_bytes(file.read_bytes()[: file.stat().st_size // 2])


def flip(file: Path) -> None:
    """Turn one bit, as a worn disk may."""
    data = bytearray(file.read_bytes())
    data[len(data) // 2] ^= 1
    file.write_bytes(data)


def empty(file: Path) -> None:
    """Leave nothing, as a file system does that had not yet written it."""
    file.write_bytes(b"")


def scribble(file: Path) -> None:
    """Write what is no text at all."""
    file.write_bytes(bytes(range(256)) * 16)


def block(file: Path) -> None:
    """Put something there that cannot be read as a file."""
    file.unlink()
    file.mkdir()


@pytest.mark.parametrize("damage", [cut, flip, empty, scribble, block])
def test_a_damaged_state_file_means_stopped(
    robot: Robot, tmp_path: Path, damage: Callable[[Path], object]
) -> None:
    """Who cannot know whether the robot was stopped takes it for stopped, and says why."""
    file = tmp_path / "state"
    with robot.safety_node(f"state_file:={file}") as node:
        node.end()
        damage(file)
        node = robot.restart()
        assert robot.is_active("/stop")
        assert str(file) in node.output()


def test_a_full_disk_costs_no_stop(robot: Robot, tmp_path: Path) -> None:
    """The stop comes all the same, and a restart finds it, although it could not be written."""
    folder = tmp_path / "disk"
    folder.mkdir()
    disk = Disk(folder, tmp_path)
    with robot.safety_node(f"state_file:={folder / 'state'}", **disk.env) as node:
        disk.fill()
        robot.violate()
        robot.until_alive()
        assert "No space left on device" in node.output()
        node.kill()
        disk.clear()
        node = robot.restart()
        assert robot.is_active("/stop"), "the stop was undone by a restart"


def test_a_full_disk_refuses_the_reset(robot: Robot, tmp_path: Path) -> None:
    """A reset that a restart would undo is not done; with space again, it is."""
    folder = tmp_path / "disk"
    folder.mkdir()
    disk = Disk(folder, tmp_path)
    with (
        robot.safety_node(f"state_file:={folder / 'state'}", **disk.env),
        robot.sensors() as sensors,
    ):
        sensors.drive()
        robot.violate()
        disk.fill()

        def is_told_why() -> bool:
            success, message = robot.reset()
            assert not success
            return "No space left on device" in message

        robot.until(is_told_why)  # once it has heard that the rule is kept again
        assert robot.is_active("/stop")
        disk.clear()
        robot.until(lambda: robot.reset()[0])
        robot.until(lambda: not robot.is_active("/stop"))


def test_a_disk_that_is_full_from_the_start_means_stopped(robot: Robot, tmp_path: Path) -> None:
    """A node that could not keep a stop begins with it."""
    folder = tmp_path / "disk"
    folder.mkdir()
    disk = Disk(folder, tmp_path)
    disk.fill()
    with robot.safety_node(f"state_file:={folder / 'state'}", **disk.env):
        robot.until_stopped()
