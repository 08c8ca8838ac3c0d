"""Faults of what the safety node keeps on disk: damaged, unreadable, replaced, no space left."""

from __future__ import annotations

import os
import socket
import stat
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.support.faults import NODE, Robot
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


def link(file: Path) -> None:
    """Make it a link to a file that says that nothing is active."""
    other = file.with_name("other")
    file.rename(other)
    file.symlink_to(other)


def dangle(file: Path) -> None:
    """Make it a link to nothing."""
    file.unlink()
    file.symlink_to(file.with_name("nowhere"))


def pipe(file: Path) -> None:
    """Make it a pipe that nobody writes to."""
    file.unlink()
    os.mkfifo(file)


def bind(file: Path) -> None:
    """Make it a socket."""
    file.unlink()
    with socket.socket(socket.AF_UNIX) as server:
        server.bind(str(file))


def device(file: Path) -> None:
    """Make it a device, as only root can; this one is the null device under another name."""
    file.unlink()
    try:
        os.mknod(file, 0o666 | stat.S_IFCHR, os.makedev(1, 3))
    except PermissionError:
        pytest.skip("only root can make a device")


def described(folder: Path) -> list[tuple[str, int, bytes]]:
    """Return what is in a folder: names, types, and what the regular files hold."""
    return [
        (path.name, stat.S_IFMT(path.lstat().st_mode), path.read_bytes() if is_file else b"")
        for path in sorted(folder.iterdir())
        for is_file in [stat.S_ISREG(path.lstat().st_mode)]
    ]


@pytest.mark.parametrize("put", [link, dangle, pipe, bind, device, block])
def test_what_is_no_regular_file_means_stopped_and_is_left_alone(
    robot: Robot, tmp_path: Path, put: Callable[[Path], object]
) -> None:
    """It is neither followed, nor waited for, nor replaced, not even by root, start after start."""
    folder = tmp_path / "state"
    file = folder / "file"
    with robot.safety_node(f"state_file:={file}") as node:
        node.end()
        put(file)
        before = described(folder)
        node = robot.restart()
        assert robot.is_active("/stop")
        assert f"{file} cannot be" in node.output()
        assert "not a regular file" in node.output()
        success, message = robot.reset()
        assert not success
        assert "not a regular file" in message
        assert robot.is_active("/stop")
        assert described(folder) == before


def test_the_state_file_of_another_node_means_stopped(robot: Robot, tmp_path: Path) -> None:
    """It says that nothing of the other one is active, which is nothing about this one."""
    file = tmp_path / "state"
    another = robot.start(NODE, [f"state_file:={file}"], name="another")
    robot.until(file.exists)
    robot.until(lambda: robot.states["/stop"])
    another.end()
    assert not robot.is_active("/stop")
    with robot.safety_node(f"state_file:={file}") as node:
        robot.until_stopped()
        assert f"{file} is damaged, or not of /{NODE}" in node.output()


def test_a_state_file_that_is_removed_while_the_node_runs_comes_back(
    robot: Robot, tmp_path: Path
) -> None:
    """A hand that tidies up undoes no stop."""
    file = tmp_path / "state"
    with robot.safety_node(f"state_file:={file}") as node:
        robot.violate()
        robot.until_alive()
        file.unlink()
        robot.until_alive()
        node.kill()
        robot.restart()
        assert robot.is_active("/stop"), "the stop was undone by a restart"


def test_a_link_that_is_put_there_while_the_node_runs_is_reported(
    robot: Robot, tmp_path: Path
) -> None:
    """The node can keep nothing from then on, and says so."""
    file = tmp_path / "state"
    with robot.safety_node(f"state_file:={file}") as node:
        link(file)
        robot.until(lambda: "it is a symbolic link, not a regular file" in node.output())
        assert file.is_symlink()


def test_a_folder_that_is_missing_is_made(robot: Robot, tmp_path: Path) -> None:
    """It belongs to the user alone, and the latch is in it."""
    folder = tmp_path / "made" / "for"
    with robot.safety_node(f"state_file:={folder / 'state'}") as node:
        assert stat.S_IMODE(folder.stat().st_mode) == 0o700
        assert not robot.is_active("/stop")
        robot.violate()
        robot.until_alive()
        node.kill()
        robot.restart()
        assert robot.is_active("/stop")


def test_a_folder_that_cannot_be_made_means_stopped(robot: Robot, tmp_path: Path) -> None:
    """Where nothing can be kept, nothing may be forgotten."""
    (tmp_path / "file").write_text("")
    with robot.safety_node(f"state_file:={tmp_path / 'file' / 'folder' / 'state'}") as node:
        robot.until_stopped()
        assert "cannot be" in node.output()


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
