"""The file in which latched actions survive the process."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from deros.generators.runtime.python.deros_runtime.latches import Latches, LatchFile, default_path

KNOWN = ("halt", "stop")


class ReportCollector:
    """Collects reports about the file; the last text is the current problem."""

    def __init__(self) -> None:
        """Start without reports."""
        self.texts: list[str] = []

    def __call__(self, subject: str, text: str) -> None:
        """Store a report."""
        assert subject == "latches"
        self.texts.append(text)


def file_in(folder: Path, owner: str = "/robot_safety") -> LatchFile:
    """Return the file of a node, in a folder that does not exist yet."""
    return LatchFile(folder / "deros" / "robot.latches", owner)


def latches_in(folder: Path) -> tuple[Latches, ReportCollector]:
    """Return the latches that a starting node reads from the file, and its reports."""
    reports = ReportCollector()
    return Latches(file_in(folder), KNOWN, reports), reports


def without_space(monkeypatch: pytest.MonkeyPatch) -> None:
    """Make every write fail as on a full disk."""

    def full(_descriptor: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)


def test_nothing_is_active_without_a_file(tmp_path: Path) -> None:
    """The first start of a node is not an error."""
    latches, reports = latches_in(tmp_path)
    assert latches.active == frozenset()
    assert reports.texts == []


def test_pending_change_counts_as_active(tmp_path: Path) -> None:
    """Between trigger and save all actions count as active; a save ends this."""
    latches, _ = latches_in(tmp_path)
    latches.mark_pending("beep")
    assert file_in(tmp_path).load(KNOWN) == (frozenset(), "")
    latches.mark_pending("stop")
    active, problem = file_in(tmp_path).load(KNOWN)
    assert active == frozenset(KNOWN)
    assert "is damaged" in problem
    latches.record("stop", active=True)
    assert latches.persist() == ""
    latches.mark_pending("stop")
    assert file_in(tmp_path).load(KNOWN) == (frozenset({"stop"}), "")


def test_active_actions_survive_a_restart(tmp_path: Path) -> None:
    """The file contains exactly the state of the last process."""
    latches, _ = latches_in(tmp_path)
    latches.record("stop", active=True)
    latches.record("beep", active=True)
    assert latches.persist() == ""
    again, reports = latches_in(tmp_path)
    assert again.active == {"stop"}
    assert reports.texts == []
    again.record("stop", active=False)
    again.persist()
    assert latches_in(tmp_path)[0].active == frozenset()


@pytest.mark.parametrize("damage", [b"", b"deros latches 1\n", b"\xff\xfe", b"\n" * 5])
def test_damaged_file_counts_as_active(tmp_path: Path, damage: bytes) -> None:
    """A file that cannot be trusted keeps the robot stopped."""
    file_in(tmp_path).save(frozenset())
    file_in(tmp_path).path.write_bytes(damage)
    latches, reports = latches_in(tmp_path)
    assert latches.active == set(KNOWN)
    (text,) = reports.texts
    assert text.endswith("all latched actions are active")


def test_every_flipped_bit_is_detected(tmp_path: Path) -> None:
    """No single disk error makes an active action inactive."""
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


def test_every_truncation_is_detected(tmp_path: Path) -> None:
    """A part of a file is invalid."""
    file = file_in(tmp_path)
    file.save(frozenset())
    whole = file.path.read_bytes()
    for length in range(len(whole)):
        file.path.write_bytes(whole[:length])
        assert file_in(tmp_path).load(KNOWN)[0] == set(KNOWN)


def test_file_of_another_node_is_rejected(tmp_path: Path) -> None:
    """Two nodes with one file by mistake do not use each other's state."""
    file_in(tmp_path, "/other").save(frozenset())
    assert latches_in(tmp_path)[0].active == set(KNOWN)


def test_action_missing_from_the_rules_makes_all_active(tmp_path: Path) -> None:
    """It may have been renamed, and must still hold the robot."""
    file_in(tmp_path).save(frozenset({"freeze"}))
    latches, reports = latches_in(tmp_path)
    assert latches.active == set(KNOWN)
    assert "freeze" in reports.texts[0]


def test_unwritable_file_at_the_start_counts_as_active(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The node could not store a stop."""
    without_space(monkeypatch)
    latches, reports = latches_in(tmp_path)
    assert latches.active == set(KNOWN)
    assert "No space left" in reports.texts[0]


def test_full_disk_makes_all_active_after_a_restart(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The old file, without the trigger, must not remain valid."""
    latches, reports = latches_in(tmp_path)
    latches.record("stop", active=True)
    with monkeypatch.context() as full:
        without_space(full)
        assert "No space left" in latches.persist()
    assert file_in(tmp_path).load(KNOWN)[0] == set(KNOWN)
    assert latches.persist() == ""
    assert reports.texts[-1] == ""
    assert file_in(tmp_path).load(KNOWN) == (frozenset({"stop"}), "")


def test_reset_that_cannot_be_stored_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The state before and after a restart must agree."""
    latches, _ = latches_in(tmp_path)
    latches.record("stop", active=True)
    latches.persist()
    with monkeypatch.context() as full:
        without_space(full)
        assert latches.allow_reset(frozenset()).startswith("nothing is reset, because")
    assert latches.active == {"stop"}
    assert latches_in(tmp_path)[0].active >= {"stop"}
    assert latches.allow_reset(frozenset()) == ""
    assert latches_in(tmp_path)[0].active == frozenset()


def test_no_partial_file_is_left(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A full disk is not filled further."""
    latches, _ = latches_in(tmp_path)
    latches.record("stop", active=True)
    without_space(monkeypatch)
    latches.persist()
    assert [path.name for path in (tmp_path / "deros").iterdir()] == ["robot.latches"]


def test_partial_files_of_a_killed_process_are_removed(tmp_path: Path) -> None:
    """Other files in the folder are kept."""
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


def test_huge_file_is_not_read_completely(tmp_path: Path) -> None:
    """It cannot exhaust the memory of a starting node."""
    file_in(tmp_path).save(frozenset())
    with file_in(tmp_path).path.open("r+b") as file:
        file.truncate(1 << 40)
    latches, reports = latches_in(tmp_path)
    assert latches.active == set(KNOWN)
    assert "it is longer than" in reports.texts[0]


def test_stored_state_is_not_written_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """persist() may be called at every heartbeat."""
    latches, _ = latches_in(tmp_path)
    without_space(monkeypatch)
    assert latches.persist() == ""


@pytest.mark.parametrize(("home", "expected"), [("/ros", "/ros"), ("", "~/.ros")])
def test_default_path_is_in_ros_home(
    monkeypatch: pytest.MonkeyPatch, home: str, expected: str
) -> None:
    """ROS_HOME is used if set, as for the logs."""
    monkeypatch.setenv("ROS_HOME", home)
    path = Path(expected).expanduser() / "deros" / "robot_safety.0.latches"
    assert default_path("robot_safety.0") == path
