"""Faults of the state file: damaged, unreadable, replaced, disk full."""

from __future__ import annotations

import os
import socket
import stat
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.support.faults import NODE, Robot
from tests.support.needs import needs
from tests.support.preload import Disk
from tests.support.profiles import slow

pytestmark = pytest.mark.ros


def truncate(file: Path) -> None:
    """Keep only half of the file, as after a crash of the machine."""
    file.write_bytes(file.read_bytes()[: file.stat().st_size // 2])


def flip(file: Path) -> None:
    """Flip one bit, as on a worn disk."""
    data = bytearray(file.read_bytes())
    data[len(data) // 2] ^= 1
    file.write_bytes(data)


def empty(file: Path) -> None:
    """Empty the file, as by a file system that had not written it yet."""
    file.write_bytes(b"")


def write_garbage(file: Path) -> None:
    """Write bytes that are not text."""
    file.write_bytes(bytes(range(256)) * 16)


def put_unreadable(file: Path) -> None:
    """Replace the file by something unreadable."""
    file.unlink()
    file.mkdir()


@pytest.mark.parametrize(
    "damage", [flip, *map(slow, (empty, truncate, write_garbage, put_unreadable))]
)
def test_damaged_state_file_means_stopped(
    robot: Robot, tmp_path: Path, damage: Callable[[Path], object]
) -> None:
    """A node that cannot know whether the robot was stopped assumes it, and reports why."""
    file = tmp_path / "state"
    with robot.safety_node(f"state_file:={file}") as node:
        node.end()
        damage(file)
        node = robot.restart()
        assert robot.is_active("/stop")
        assert str(file) in node.output()


def put_link(file: Path) -> None:
    """Replace the file by a link to one without active actions."""
    other = file.with_name("other")
    file.rename(other)
    file.symlink_to(other)


def put_dangling_link(file: Path) -> None:
    """Replace the file by a dangling link."""
    file.unlink()
    file.symlink_to(file.with_name("nowhere"))


def put_pipe(file: Path) -> None:
    """Replace the file by a pipe without a writer."""
    file.unlink()
    os.mkfifo(file)


def put_socket(file: Path) -> None:
    """Replace the file by a socket."""
    file.unlink()
    with socket.socket(socket.AF_UNIX) as server:
        server.bind(str(file))


def put_device(file: Path) -> None:
    """Replace the file by a device (root only): the null device under another name."""
    file.unlink()
    try:
        os.mknod(file, 0o666 | stat.S_IFCHR, os.makedev(1, 3))
    except PermissionError:
        pytest.skip("only root can create a device")


def described(folder: Path) -> list[tuple[str, int, bytes]]:
    """Return the contents of a folder: names, types, and data of regular files."""
    return [
        (path.name, stat.S_IFMT(path.lstat().st_mode), path.read_bytes() if is_file else b"")
        for path in sorted(folder.iterdir())
        for is_file in [stat.S_ISREG(path.lstat().st_mode)]
    ]


@pytest.mark.parametrize(
    "put",
    [
        put_link,
        *map(slow, (put_pipe, put_dangling_link, put_socket, put_device, put_unreadable)),
    ],
)
def test_irregular_state_file_means_stopped_and_is_kept(
    robot: Robot, tmp_path: Path, put: Callable[[Path], object]
) -> None:
    """It is neither followed nor waited for nor replaced, not even by root, at any start."""
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


@pytest.mark.slow
def test_state_file_of_another_node_means_stopped(robot: Robot, tmp_path: Path) -> None:
    """A file without active actions of another node does not apply to this one."""
    file = tmp_path / "state"
    another = robot.start(NODE, [f"state_file:={file}"], name="another")
    robot.until(file.exists)
    robot.until(lambda: robot.states["/stop"])
    another.end()
    assert not robot.is_active("/stop")
    with robot.safety_node(f"state_file:={file}") as node:
        robot.until_stopped()
        assert f"{file} is damaged, or not of /{NODE}" in node.output()


@pytest.mark.slow
def test_state_file_removed_at_run_time_is_recreated(robot: Robot, tmp_path: Path) -> None:
    """Removing the file does not undo a stop."""
    file = tmp_path / "state"
    with robot.safety_node(f"state_file:={file}") as node:
        robot.violate()
        robot.until_alive()
        file.unlink()
        robot.until_alive()
        node.kill()
        robot.restart()
        assert robot.is_active("/stop"), "the stop was undone by a restart"


@pytest.mark.slow
def test_link_created_at_run_time_is_reported(robot: Robot, tmp_path: Path) -> None:
    """From then on the node cannot store anything, and reports it."""
    file = tmp_path / "state"
    with robot.safety_node(f"state_file:={file}") as node:
        put_link(file)
        robot.until(lambda: "it is a symbolic link, not a regular file" in node.output())
        assert file.is_symlink()


@pytest.mark.slow
def test_missing_folder_is_created(robot: Robot, tmp_path: Path) -> None:
    """It is private to the user, and the latch is in it."""
    folder = tmp_path / "made" / "for"
    with robot.safety_node(f"state_file:={folder / 'state'}") as node:
        assert stat.S_IMODE(folder.stat().st_mode) == 0o700
        assert not robot.is_active("/stop")
        robot.violate()
        robot.until_alive()
        node.kill()
        robot.restart()
        assert robot.is_active("/stop")


@pytest.mark.slow
def test_folder_that_cannot_be_created_means_stopped(robot: Robot, tmp_path: Path) -> None:
    """If nothing can be stored, the robot stays stopped."""
    (tmp_path / "file").write_text("")
    with robot.safety_node(f"state_file:={tmp_path / 'file' / 'folder' / 'state'}") as node:
        robot.until_stopped()
        assert "cannot be" in node.output()


@needs("gcc")
def test_full_disk_does_not_prevent_a_stop(robot: Robot, tmp_path: Path) -> None:
    """The stop is published, and a restart finds it although it could not be written."""
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


@needs("gcc")
@pytest.mark.slow
def test_full_disk_refuses_the_reset(robot: Robot, tmp_path: Path) -> None:
    """A reset that a restart would undo is refused until there is space again."""
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

        def is_refused_for_space() -> bool:
            success, message = robot.reset()
            assert not success
            return "No space left on device" in message

        robot.until(is_refused_for_space)  # once it knows that the rule is satisfied again
        assert robot.is_active("/stop")
        disk.clear()
        robot.until(lambda: robot.reset()[0])
        robot.until(lambda: not robot.is_active("/stop"))


@needs("gcc")
@pytest.mark.slow
def test_disk_full_from_the_start_means_stopped(robot: Robot, tmp_path: Path) -> None:
    """A node that could not store a stop starts stopped."""
    folder = tmp_path / "disk"
    folder.mkdir()
    disk = Disk(folder, tmp_path)
    disk.fill()
    with robot.safety_node(f"state_file:={folder / 'state'}", **disk.env):
        robot.until_stopped()
