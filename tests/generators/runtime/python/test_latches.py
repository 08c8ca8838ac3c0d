"""The file in which latched actions outlive the process."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from deros.generators.runtime.python.deros_runtime.latches import Latches, LatchFile, default_path

KNOWN = ("halt", "stop")


class Told:
    """Collects what is told of the file; the last text is what is wrong now."""

    def __init__(self) -> None:
        """Begin with nothing told."""
        self.texts: list[str] = []

    def __call__(self, subject: str, text: str) -> None:
        """Take a text."""
        assert subject == "latches"
        self.texts.append(text)


def file_in(folder: Path, owner: str = "/robot_safety") -> LatchFile:
    """Return the file of a node, in a folder that is yet to be made."""
    return LatchFile(folder / "deros" / "robot.latches", owner)


def latches_in(folder: Path) -> tuple[Latches, Told]:
    """Return what a node that starts reads from the file, and what it tells."""
    told = Told()
    return Latches(file_in(folder), KNOWN, told), told


def without_space(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have every file written fail as on a full disk."""

    def full(_descriptor: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)


def test_without_a_file_nothing_is_active(tmp_path: Path) -> None:
    """The first start of a node is no fault."""
    latches, told = latches_in(tmp_path)
    assert latches.active == frozenset()
    assert told.texts == []


def test_what_is_being_done_when_the_process_ends_is_active(tmp_path: Path) -> None:
    """Between the trigger and the save all actions count as active; a save ends the doubt."""
    latches, _ = latches_in(tmp_path)
    latches.mark_pending("beep")
    assert file_in(tmp_path).load(KNOWN) == (frozenset(), "")
    latches.mark_pending("stop")
    active, problem = file_in(tmp_path).load(KNOWN)
    assert active == frozenset(KNOWN)
    assert "is damaged" in problem
    latches.record("trigger", "stop")
    assert latches.persist() == ""
    latches.mark_pending("stop")
    assert file_in(tmp_path).load(KNOWN) == (frozenset({"stop"}), "")


def test_what_was_active_is_active_after_a_restart(tmp_path: Path) -> None:
    """The file says what the last process knew, no more and no less."""
    latches, _ = latches_in(tmp_path)
    latches.record("trigger", "stop")
    latches.record("trigger", "beep")
    assert latches.persist() == ""
    again, told = latches_in(tmp_path)
    assert again.active == {"stop"}
    assert told.texts == []
    again.record("reset", "stop")
    again.persist()
    assert latches_in(tmp_path)[0].active == frozenset()


@pytest.mark.parametrize("damage", [b"", b"deros latches 1\n", b"\xff\xfe", b"\n" * 5])
def test_a_damaged_file_counts_as_active(tmp_path: Path, damage: bytes) -> None:
    """Whatever cannot be trusted keeps the robot where it is."""
    file_in(tmp_path).save(frozenset())
    file_in(tmp_path).path.write_bytes(damage)
    latches, told = latches_in(tmp_path)
    assert latches.active == set(KNOWN)
    (text,) = told.texts
    assert text.endswith("all latched actions are active")


def test_every_flipped_bit_is_noticed(tmp_path: Path) -> None:
    """No single error of the disk makes an active action inactive."""
    file = file_in(tmp_path)
    file.save(frozenset({"stop"}))
    whole = file.path.read_bytes()
    for position in range(len(whole) * 8):
        damaged = bytearray(whole)
        damaged[position // 8] ^= 1 << position % 8
        file.path.write_bytes(damaged)
        active, problem = file_in(tmp_path).load(KNOWN)
        assert active == set(KNOWN)
        assert problem


def test_every_shorter_file_is_noticed(tmp_path: Path) -> None:
    """Half a file is none."""
    file = file_in(tmp_path)
    file.save(frozenset())
    whole = file.path.read_bytes()
    for length in range(len(whole)):
        file.path.write_bytes(whole[:length])
        assert file_in(tmp_path).load(KNOWN)[0] == set(KNOWN)


def test_the_file_of_another_node_is_not_believed(tmp_path: Path) -> None:
    """Two nodes that are given one file by mistake do not take each other's state."""
    file_in(tmp_path, "/other").save(frozenset())
    assert latches_in(tmp_path)[0].active == set(KNOWN)


def test_an_action_that_is_gone_from_the_rules_leaves_all_active(tmp_path: Path) -> None:
    """It may have got another name, under which it is still to hold the robot."""
    file_in(tmp_path).save(frozenset({"freeze"}))
    latches, told = latches_in(tmp_path)
    assert latches.active == set(KNOWN)
    assert "freeze" in told.texts[0]


def test_a_file_that_cannot_be_written_at_the_start_counts_as_active(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nothing could be remembered, so nothing may be forgotten."""
    without_space(monkeypatch)
    latches, told = latches_in(tmp_path)
    assert latches.active == set(KNOWN)
    assert "No space left" in told.texts[0]


def test_when_the_disk_is_full_a_restart_finds_all_active(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The old file, which says 'inactive', does not outlive the trigger that it does not know."""
    latches, told = latches_in(tmp_path)
    latches.record("trigger", "stop")
    with monkeypatch.context() as full:
        without_space(full)
        assert "No space left" in latches.persist()
    assert file_in(tmp_path).load(KNOWN)[0] == set(KNOWN)
    assert latches.persist() == ""
    assert told.texts[-1] == ""
    assert file_in(tmp_path).load(KNOWN) == (frozenset({"stop"}), "")


def test_a_reset_that_cannot_be_kept_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Who has reset the robot must not find it stopped again after a restart, nor the reverse."""
    latches, _ = latches_in(tmp_path)
    latches.record("trigger", "stop")
    latches.persist()
    with monkeypatch.context() as full:
        without_space(full)
        assert latches.allow_reset(frozenset()).startswith("nothing is reset, because")
    assert latches.active == {"stop"}
    assert latches_in(tmp_path)[0].active >= {"stop"}
    assert latches.allow_reset(frozenset()) == ""
    assert latches_in(tmp_path)[0].active == frozenset()


def test_no_half_written_file_is_left(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A full disk is not filled further."""
    latches, _ = latches_in(tmp_path)
    latches.record("trigger", "stop")
    without_space(monkeypatch)
    latches.persist()
    assert [path.name for path in (tmp_path / "deros").iterdir()] == ["robot.latches"]


def test_what_a_killed_process_left_half_written_is_removed(tmp_path: Path) -> None:
    """Only that: other files in the folder are not the node's."""
    latches_in(tmp_path)
    folder = tmp_path / "deros"
    kept = {"robot.latches", "robot.latches.new", "other.latches.0123456789abcdef.new"}
    for name in (*kept, "robot.latches.0123456789abcdef.new"):
        (folder / name).touch()
    (folder / "robot.latches.fedcba9876543210.new").symlink_to(folder / "robot.latches")
    latches_in(tmp_path)
    assert {path.name for path in folder.iterdir()} == {
        *kept,
        "robot.latches.fedcba9876543210.new",
    }


def test_a_file_without_end_is_not_read_to_the_end(tmp_path: Path) -> None:
    """It cannot fill the memory of a node that starts."""
    file_in(tmp_path).save(frozenset())
    with file_in(tmp_path).path.open("r+b") as file:
        file.truncate(1 << 40)
    latches, told = latches_in(tmp_path)
    assert latches.active == set(KNOWN)
    assert "it is longer than" in told.texts[0]


def test_what_is_saved_is_not_written_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """persist() may be called at every heartbeat."""
    latches, _ = latches_in(tmp_path)
    without_space(monkeypatch)
    assert latches.persist() == ""


@pytest.mark.parametrize(("home", "expected"), [("/ros", "/ros"), ("", "~/.ros")])
def test_the_usual_place_is_in_the_home_of_ros(
    monkeypatch: pytest.MonkeyPatch, home: str, expected: str
) -> None:
    """ROS_HOME if it is set, as for the logs."""
    monkeypatch.setenv("ROS_HOME", home)
    path = Path(expected).expanduser() / "deros" / "robot_safety.0.latches"
    assert default_path("robot_safety.0") == path
