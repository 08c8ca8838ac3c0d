"""The writer writes all files or none, and keeps files that are not its own."""

from __future__ import annotations

import errno
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from deros.generators.api.protocol import File, Owner
from deros.generators.output.writer import Outcome, WriteError, write

PYTHON = "x = 1\n"


def snapshot(folder: Path) -> dict[str, tuple[bytes, int, int]]:
    """Return content, mode and time of every file below ``folder``, including hidden ones."""
    return {
        path.relative_to(folder).as_posix(): (
            path.read_bytes(),
            path.stat().st_mode,
            path.stat().st_mtime_ns,
        )
        for path in folder.rglob("*")
        if path.is_file()
    }


def test_files_are_written_with_folders_and_modes(tmp_path: Path) -> None:
    """Missing folders are created, text is written as given, executables can be run."""
    files = {"a/b/c.py": File(PYTHON), "run.sh": File("#!/bin/sh\n", executable=True)}
    report = write(files, tmp_path / "new" / "out")
    assert report.of(Outcome.WRITTEN) == ("a/b/c.py", "run.sh")
    assert (tmp_path / "new/out/a/b/c.py").read_text().endswith(PYTHON)
    assert os.access(tmp_path / "new/out/run.sh", os.X_OK)
    assert not os.access(tmp_path / "new/out/a/b/c.py", os.X_OK)
    assert sorted(p.name for p in (tmp_path / "new/out").iterdir()) == ["a", "run.sh"]


def test_second_run_changes_nothing(tmp_path: Path) -> None:
    """Unchanged files keep even their modification time."""
    files = {"a.py": File(PYTHON), "marker": File(""), "b.py": File(PYTHON, Owner.USER)}
    write(files, tmp_path)
    before = snapshot(tmp_path)
    report = write(files, tmp_path)
    assert snapshot(tmp_path) == before
    assert report.of(Outcome.UNCHANGED) == ("a.py", "marker")


def test_unedited_files_are_refreshed(tmp_path: Path) -> None:
    """A file as generated gets the new text."""
    write({"a.py": File(PYTHON)}, tmp_path)
    report = write({"a.py": File("x = 2\n")}, tmp_path)
    assert report.of(Outcome.WRITTEN) == ("a.py",)
    assert (tmp_path / "a.py").read_text().endswith("x = 2\n")


def test_line_endings_are_not_an_edit(tmp_path: Path) -> None:
    """A checkout with other line endings does not count as edited."""
    write({"a.py": File(PYTHON)}, tmp_path)
    path = tmp_path / "a.py"
    path.write_bytes(path.read_bytes().replace(b"\n", b"\r\n"))
    assert write({"a.py": File("x = 2\n")}, tmp_path).of(Outcome.WRITTEN) == ("a.py",)


def test_edited_files_are_kept_and_reported(tmp_path: Path) -> None:
    """An edit survives a new run, with a warning that names the file."""
    write({"a.py": File(PYTHON)}, tmp_path)
    edited = (tmp_path / "a.py").read_text() + "y = 3\n"
    (tmp_path / "a.py").write_text(edited)
    report = write({"a.py": File("x = 2\n")}, tmp_path)
    assert (tmp_path / "a.py").read_text() == edited
    (warning,) = report.diagnostics
    assert warning.code.name == "DRS403"
    assert warning.span.file == str(tmp_path / "a.py")
    assert not warning.is_error


def test_overwrite_replaces_edited_files(tmp_path: Path) -> None:
    """With overwrite the generated text is written, but never over a user file."""
    (tmp_path / "a.py").write_text("mine\n")
    (tmp_path / "b.py").write_text("mine\n")
    files = {"a.py": File(PYTHON), "b.py": File(PYTHON, Owner.USER)}
    report = write(files, tmp_path, overwrite=True)
    assert (tmp_path / "a.py").read_text() != "mine\n"
    assert (tmp_path / "b.py").read_text() == "mine\n"
    assert report.of(Outcome.USER) == ("b.py",)


def test_user_files_are_written_once(tmp_path: Path) -> None:
    """A user file is created without a banner, and then left alone, even if empty."""
    write({"a.py": File(PYTHON, Owner.USER)}, tmp_path)
    assert (tmp_path / "a.py").read_text() == PYTHON
    (tmp_path / "a.py").write_text("")
    write({"a.py": File(PYTHON, Owner.USER)}, tmp_path)
    assert (tmp_path / "a.py").read_text() == ""


@pytest.mark.parametrize(
    "path", ["../a.py", "a/../../b.py", "/etc/a.py", "", ".", "a//b.py", "a/./b.py", "a\0b"]
)
def test_paths_stay_in_the_output_directory(tmp_path: Path, path: str) -> None:
    """A path that leads outside, or is not normalised, is rejected before anything is written."""
    with pytest.raises(WriteError, match="not a plain path"):
        write({"good.py": File(PYTHON), path: File(PYTHON)}, tmp_path / "out")
    assert list(tmp_path.iterdir()) == []


def test_links_out_of_the_directory_are_not_followed(tmp_path: Path) -> None:
    """A symbolic link to another folder is rejected."""
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "out").mkdir()
    (tmp_path / "out/link").symlink_to(tmp_path / "elsewhere")
    with pytest.raises(WriteError, match="symbolic link"):
        write({"link/a.py": File(PYTHON)}, tmp_path / "out")
    assert list((tmp_path / "elsewhere").iterdir()) == []


def test_path_cannot_be_file_and_folder(tmp_path: Path) -> None:
    """A generator that returns both is rejected."""
    with pytest.raises(WriteError, match="a is generated as a file"):
        write({"a": File("x"), "a/b": File("y")}, tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_folder_in_place_of_a_file_is_reported(tmp_path: Path) -> None:
    """Nothing is written."""
    (tmp_path / "b.py").mkdir()
    with pytest.raises(WriteError, match="it is a directory"):
        write({"a.py": File(PYTHON), "b.py": File(PYTHON)}, tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["b.py"]


def test_output_directory_cannot_be_a_file(tmp_path: Path) -> None:
    """The result is a message, not a traceback."""
    (tmp_path / "out").write_text("")
    with pytest.raises(WriteError, match="cannot write"):
        write({"a.py": File(PYTHON)}, tmp_path / "out")


def test_lone_surrogate_is_reported(tmp_path: Path) -> None:
    """UTF-8 cannot encode it, so there is a message and no file."""
    with pytest.raises(WriteError, match=r"half a character, '\\ud800'"):
        write({"a.py": File(PYTHON), "b.txt": File("x\ud800")}, tmp_path)
    assert list(tmp_path.iterdir()) == []


def failing_on(count: int, function: Callable[..., Any]) -> Callable[..., Any]:
    """Return ``function`` with its ``count``-th call failing as on a full disk."""
    calls = 0

    def wrapped(*args: Any, **kwargs: Any) -> Any:
        nonlocal calls
        calls += 1
        if calls == count:
            raise OSError(errno.ENOSPC, "No space left on device")
        return function(*args, **kwargs)

    return wrapped


FIRST = {
    "a.py": File(PYTHON),
    "pkg/b.py": File(PYTHON),
    "run.sh": File("#!/bin/sh\n", executable=True),
}
SECOND = {
    "a.py": File("x = 2\n"),
    "new/deep/c.py": File(PYTHON),
    "pkg/b.py": File("x = 2\n"),
    "run.sh": File("#!/bin/sh\ntrue\n", executable=True),
}


@pytest.mark.parametrize("step", ["fsync", "replace"])
@pytest.mark.parametrize("count", [1, 2, 3, 4])
def test_full_disk_leaves_the_directory_unchanged(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, step: str, count: int
) -> None:
    """Whichever step fails, every byte, mode and folder is as before."""
    write(FIRST, tmp_path)
    before = snapshot(tmp_path)
    folders = sorted(path for path in tmp_path.rglob("*") if path.is_dir())
    owner = os if step == "fsync" else Path
    with monkeypatch.context() as patch:
        patch.setattr(owner, step, failing_on(count, getattr(owner, step)))
        with pytest.raises(WriteError, match="No space left on device"):
            write(SECOND, tmp_path)
    assert snapshot(tmp_path) == before
    assert sorted(path for path in tmp_path.rglob("*") if path.is_dir()) == folders


def test_failure_removes_created_folders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """An output directory that did not exist does not exist afterwards."""
    monkeypatch.setattr(os, "fsync", failing_on(2, os.fsync))
    with pytest.raises(WriteError):
        write(SECOND, tmp_path / "deep" / "out")
    assert list(tmp_path.iterdir()) == []


def test_interrupt_is_rolled_back(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Ctrl-C between two files restores the first one, and is raised again."""
    write(FIRST, tmp_path)
    before = snapshot(tmp_path)
    replace = Path.replace

    def interrupted(self: Path, target: Path) -> Path:
        if target.name == "b.py":
            raise KeyboardInterrupt
        return replace(self, target)

    monkeypatch.setattr(Path, "replace", interrupted)
    with pytest.raises(KeyboardInterrupt):
        write(SECOND, tmp_path)
    assert snapshot(tmp_path) == before


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_directory_without_permission_is_reported(tmp_path: Path) -> None:
    """The message has the reason."""
    tmp_path.chmod(0o500)
    try:
        with pytest.raises(WriteError, match="Permission denied"):
            write({"a.py": File(PYTHON)}, tmp_path)
    finally:
        tmp_path.chmod(0o700)


def test_file_that_differs_only_in_case_is_rejected(tmp_path: Path) -> None:
    """On some file systems it would replace the other file."""
    write({"demo/Ab.py": File("x = 1\n")}, tmp_path)
    with pytest.raises(WriteError, match=r"differs from Ab\.py only in case"):
        write({"demo/ab.py": File("x = 2\n")}, tmp_path)
    with pytest.raises(WriteError, match="only in case"):
        write({"new/Cd.py": File(""), "new/cd.py": File("")}, tmp_path)
    assert [path.name for path in (tmp_path / "demo").iterdir()] == ["Ab.py"]
    assert not (tmp_path / "new").exists()


def test_existing_files_that_differ_only_in_case_are_refreshed(tmp_path: Path) -> None:
    """Neither is lost, unless one run writes both."""
    (tmp_path / "Ab.txt").write_text("by hand", encoding="utf-8")
    (tmp_path / "ab.txt").write_text("", encoding="utf-8")
    write({"ab.txt": File("x")}, tmp_path, overwrite=True)
    assert (tmp_path / "Ab.txt").read_text(encoding="utf-8") == "by hand"
