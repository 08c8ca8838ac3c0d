"""Questions to the file system and their answers, which change when what they are about does."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest

from deros.interfaces.files import (
    answer_again,
    asks_elsewhere,
    entries,
    identity,
    is_file,
    is_folder,
    is_named,
    read_regular,
    real_path,
    recorded,
    status,
    unsaved,
    walk,
)

MOST = 1000


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a folder with a file, a folder with another, and a link to each of these."""
    (tmp_path / "file").write_text("some")
    (tmp_path / "below").mkdir()
    (tmp_path / "below/inner").write_text("text")
    (tmp_path / "to_file").symlink_to("file")
    (tmp_path / "to_below").symlink_to("below")
    return tmp_path


def _rewrite(folder: Path) -> None:
    """Change a content, and neither its size nor its time."""
    file = folder / "file"
    before = file.stat()
    file.write_text("same")
    os.utime(file, ns=(before.st_atime_ns, before.st_mtime_ns))


def _turn(folder: Path) -> None:
    (folder / "to_file").unlink()
    (folder / "to_file").symlink_to("below/inner")


def _replace(folder: Path) -> None:
    (folder / "file").unlink()
    (folder / "file").mkdir()


CHANGES: list[tuple[Callable[[Path], object], Callable[[Path], object]]] = [
    (lambda here: read_regular(here / "file", MOST), _rewrite),
    (lambda here: read_regular(here / "file", MOST), lambda here: (here / "file").unlink()),
    (lambda here: read_regular(here / "to_file", MOST), _turn),
    (lambda here: is_file(here / "file"), _replace),
    (lambda here: is_folder(here / "new"), lambda here: (here / "new").mkdir()),
    (lambda here: status(here / "new"), lambda here: (here / "new").touch()),
    (lambda here: is_named(here / "new"), lambda here: (here / "new").symlink_to("nowhere")),
    (lambda here: real_path(here / "to_file"), _turn),
    (lambda here: identity(here / "new"), lambda here: (here / "new").mkdir()),
    (lambda here: entries(here), lambda here: (here / "new").touch()),
    (lambda here: entries(here), _replace),
    (lambda here: entries(here / "new"), lambda here: (here / "below").rename(here / "new")),
    (lambda here: list(walk(here)), lambda here: (here / "below/new").touch()),
]


@pytest.mark.parametrize(("ask", "change"), CHANGES)
def test_answers_change_with_what_they_are_about(
    folder: Path, ask: Callable[[Path], object], change: Callable[[Path], object]
) -> None:
    """Until then they are the same."""
    with recorded() as answers:
        ask(folder)
    assert answers
    assert all(answer_again(each) == answer for each, answer in answers.items())
    change(folder)
    assert any(answer_again(each) != answer for each, answer in answers.items())


def test_refusals_are_answers(folder: Path) -> None:
    """What could not be read may be there later."""
    with recorded() as answers:
        for name in ("new", "below"):
            with pytest.raises(OSError, match=name):
                read_regular(folder / name, MOST)
        with pytest.raises(OSError, match="longer than 3 bytes"):
            read_regular(folder / "file", 3)
    assert len(answers) == 3
    assert all(answer_again(each) == answer for each, answer in answers.items())
    (folder / "new").touch()
    assert any(answer_again(each) != answer for each, answer in answers.items())


def test_two_answers_in_one_run_are_none(folder: Path) -> None:
    """A file that changes meanwhile may have been used in both forms."""
    with recorded() as answers:
        read_regular(folder / "file", MOST)
        _rewrite(folder)
        read_regular(folder / "file", MOST)
    assert all(answer_again(each) != answer for each, answer in answers.items())


def test_programs_of_others_answer_for_nothing() -> None:
    """They may ask whatever they like, without a record of it."""
    with recorded() as answers:
        asks_elsewhere("somebody")
    assert [answer_again(each) == answer for each, answer in answers.items()] == [False]


def test_nothing_is_recorded_outside(folder: Path) -> None:
    """The record ends with its context."""
    with recorded() as answers:
        pass
    is_file(folder)
    assert answers == {}


def test_folders_are_walked_by_name_and_not_through_links(folder: Path) -> None:
    """A link to a folder is listed as one, and not followed."""
    assert list(walk(folder)) == [
        (str(folder), ["below", "to_below"], ["file", "to_file"]),
        (str(folder / "below"), [], ["inner"]),
    ]


def test_folders_are_closed_again(folder: Path) -> None:
    """A run may meet many of them in place of files."""
    before = len(list(Path("/proc/self/fd").iterdir()))
    for _ in range(5):
        with pytest.raises(IsADirectoryError):
            read_regular(folder, MOST)
    assert len(list(Path("/proc/self/fd").iterdir())) == before


def test_pipes_are_not_waited_for(tmp_path: Path) -> None:
    """They are no regular files."""
    os.mkfifo(tmp_path / "pipe")
    assert status(tmp_path / "pipe") == "other"
    with pytest.raises(OSError, match="not a regular file"):
        read_regular(tmp_path / "pipe", MOST)


def test_unsaved_texts_stand_for_what_the_disk_holds(folder: Path) -> None:
    """Under all names of the file, with the same limit, and until the editor lets go of it."""
    file, link = folder / "unsaved", folder / "link to it"
    file.write_bytes(b"on the disk")
    link.symlink_to(file)
    with recorded() as answers:
        read_regular(link, MOST)
    (asked,) = answers
    with unsaved({real_path(file): b"in the editor"}):
        assert read_regular(file, MOST) == read_regular(link, MOST) == b"in the editor"
        assert answer_again(asked) != answers[asked]
        with pytest.raises(OSError, match="longer than 3 bytes"):
            read_regular(file, 3)
    assert read_regular(file, MOST) == b"on the disk"
    assert answer_again(asked) == answers[asked]
