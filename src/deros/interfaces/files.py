"""Questions to the file system: what a file holds, what a folder lists, what a path leads to.

Whatever decides about the findings on a model is asked here, so that a run can record its questions
and their answers, and a later one can tell whether all answers are still the same. Files are
untrusted: reading them does not block, and has a limit of size.
"""

from __future__ import annotations

import contextlib
import errno
import hashlib
import os
import stat
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

Question = tuple[str, str, int]
"""The kind of answer, the path, and of a content how many bytes it may have."""

Recorded = dict[Question, str]
"""Questions with their answers: short texts that differ if the answers do."""

_records: list[Recorded] = []
_unsaved: dict[str, bytes] = {}

UNKNOWN = "unknown"
"""The status of what cannot be looked at."""

_CHANGED = "changed"
"""The answer to what has been asked twice in one run, and was answered differently."""


class Entry(NamedTuple):
    """One name that a folder lists; ``path`` begins with that of the folder.

    A link to a folder is both.
    """

    name: str
    path: str
    is_folder: bool
    is_link: bool


@contextlib.contextmanager
def recorded() -> Iterator[Recorded]:
    """Record all questions until the context ends."""
    record: Recorded = {}
    _records.append(record)
    try:
        yield record
    finally:
        _records.remove(record)


@contextlib.contextmanager
def unsaved(contents: Mapping[str, bytes]) -> Iterator[None]:
    """Have files hold what an editor has not saved yet, until the context ends.

    Args:
        contents: by the paths of the files, without symbolic links.
    """
    before = dict(_unsaved)
    _unsaved.update(contents)
    try:
        yield
    finally:
        _unsaved.clear()
        _unsaved.update(before)


def answer_again(question: Question) -> str:
    """Return the answer that a recorded question has now."""
    kind, path, most = question
    return _ANSWERS[kind](path, most)


def asks_elsewhere(program: str) -> None:
    """Record that a program that is no part of deros has a say, and may ask whatever it likes."""
    _record("program", program, "")


def read_regular(path: Path | str, most: int) -> bytes:
    """Read a regular file, or what a symbolic link to one leads to.

    Pipes and devices are rejected: they may block, or never end.

    Args:
        path: the file.
        most: how many bytes it may hold.

    Raises:
        OSError: the file cannot be read, is not a regular file, or holds more than ``most`` bytes
            (``EFBIG``).
        ValueError: the path holds a NUL.
    """
    found = _content(path, most)
    _record("content", path, _of_content(found), most)
    if isinstance(found, bytes):
        return found
    raise found


def status(path: Path | str) -> str:
    """Return ``file``, ``folder`` or ``other``; nothing if there is none, else :data:`UNKNOWN`."""
    found = _status(str(path))
    _record("status", path, found)
    return found


def is_file(path: Path | str) -> bool:
    """Return whether there is a regular file, or a link to one."""
    return status(path) == "file"


def is_folder(path: Path | str) -> bool:
    """Return whether there is a folder, or a link to one."""
    return status(path) == "folder"


def is_named(path: Path | str) -> bool:
    """Return whether its folder lists the path, be it a link that leads nowhere."""
    found = os.path.lexists(path)
    _record("name", path, str(found))
    return found


def real_path(path: Path | str) -> str:
    """Return the path without symbolic links.

    Raises:
        ValueError: the path holds a NUL.
    """
    found = os.path.realpath(path)
    _record("real path", path, found)
    return found


def identity(path: Path | str) -> tuple[int, int] | None:
    """Return by which a folder is known under all its names; ``None`` of what is not there."""
    found = _identity(str(path))
    _record("identity", path, str(found))
    return found


def entries(folder: Path | str) -> list[Entry]:
    """Return what a folder lists, by name; nothing if it cannot be read."""
    found = _entries(str(folder))
    _record("entries", folder, _of_entries(found))
    return found


def walk(folder: Path | str) -> Iterator[tuple[str, list[str], list[str]]]:
    """Yield each folder from one downwards, with the names of its folders and of other entries.

    The caller may change the list of folders, to go into these. Links are not followed.
    """
    listed = entries(folder)
    inside = {each.name: each for each in listed if each.is_folder}
    below = list(inside)
    yield str(folder), below, [each.name for each in listed if not each.is_folder]
    for name in below:
        if not inside[name].is_link:
            yield from walk(inside[name].path)


# Answers ------------------------------------------------------------------------------------------


def _record(kind: str, path: Path | str, answer: str, most: int = 0) -> None:
    for record in _records:
        question = kind, str(path), most
        if record.setdefault(question, answer) != answer:
            record[question] = _CHANGED


def _content(path: Path | str, most: int) -> bytes | OSError | ValueError:
    try:
        data = _unsaved.get(os.path.realpath(path)) if _may_be_unsaved(path) else None
        if data is None:
            data = _on_disk(path, most)
    except (OSError, ValueError) as error:
        return error
    if len(data) > most:
        return OSError(errno.EFBIG, f"longer than {most} bytes", str(path))
    return data


def _may_be_unsaved(path: Path | str) -> bool:
    """Return whether it is worth while to follow all links in a path; that takes a while."""
    if not _unsaved:
        return False
    name = os.path.basename(path)  # noqa: PTH119 - a path object takes longer than the answer
    return any(name == os.path.basename(each) for each in _unsaved) or os.path.islink(path)  # noqa: PTH114, PTH119


def _on_disk(path: Path | str, most: int) -> bytes:
    """Return the content of a regular file, and one byte more than ``most`` where it is longer."""
    descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC | os.O_NOCTTY)
    try:
        mode = os.fstat(descriptor).st_mode
        if stat.S_ISDIR(mode):
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
        if not stat.S_ISREG(mode):
            raise OSError(errno.EINVAL, "not a regular file", str(path))
        # Some files of the kernel say that they hold nothing, and go on for ever.
        with os.fdopen(descriptor, "rb", closefd=False) as stream:
            return stream.read(most + 1)
    finally:
        os.close(descriptor)


def _of_content(found: bytes | OSError | ValueError) -> str:
    if isinstance(found, bytes):
        return hashlib.sha256(found).hexdigest()
    return f"error {found.errno}" if isinstance(found, OSError) else "error"


def _status(path: str) -> str:
    try:
        mode = os.stat(path).st_mode  # noqa: PTH116
    except ValueError:
        return ""
    except OSError as error:
        return "" if error.errno in (errno.ENOENT, errno.ENOTDIR, errno.ELOOP) else UNKNOWN
    if stat.S_ISREG(mode):
        return "file"
    return "folder" if stat.S_ISDIR(mode) else "other"


def _identity(path: str) -> tuple[int, int] | None:
    try:
        found = os.stat(path)  # noqa: PTH116
    except OSError:
        return None
    return found.st_dev, found.st_ino


def _entries(folder: str) -> list[Entry]:
    try:
        with os.scandir(folder or ".") as found:
            return sorted(
                Entry(each.name, each.path, _is_folder(each), each.is_symlink()) for each in found
            )
    except (OSError, ValueError):
        return []


def _is_folder(entry: os.DirEntry[str]) -> bool:
    try:
        return entry.is_dir()
    except OSError:
        return False


def _of_entries(found: list[Entry]) -> str:
    listed = "\0".join(f"{each.name}{'/' * each.is_folder}{'@' * each.is_link}" for each in found)
    return hashlib.sha256(listed.encode(errors="surrogateescape")).hexdigest()


_ANSWERS: dict[str, Callable[[str, int], str]] = {
    "content": lambda path, most: _of_content(_content(path, most)),
    "status": lambda path, _: _status(path),
    "name": lambda path, _: str(os.path.lexists(path)),
    "real path": lambda path, _: os.path.realpath(path),
    "identity": lambda path, _: str(_identity(path)),
    "entries": lambda path, _: _of_entries(_entries(path)),
    "program": lambda _path, _most: _CHANGED,
}
