"""The files of a revision of a git repository, in a folder of their own.

Nothing is checked out: the objects are read as they are, without filters and hooks, so the user's
tree and its index stay as they are.
"""

from __future__ import annotations

import os
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

_MOST_BYTES = 16 * 2**20
"""No file that a check reads is larger."""

_FILES = {"100644", "100755"}
_LINK = "120000"


class NoRevision(Exception):  # noqa: N818 - it is a mistake of the user
    """The revision cannot be read; the message says why."""


@dataclass(frozen=True, slots=True)
class Revision:
    """The files of a revision.

    Attributes:
        name: as the user named it.
        folder: where they are, as the repository has them.
        path: there, of the path that the user named.
    """

    name: str
    folder: Path
    path: Path

    def shown(self, path: str) -> str:
        """Return a path in the folder as git names it, ``main:robots/base.rnd``."""
        try:
            return f"{self.name}:{Path(path).relative_to(self.folder).as_posix()}"
        except ValueError:
            return path


@contextmanager
def revision(name: str, path: str) -> Iterator[Revision]:
    """Provide the files of revision ``name`` of the repository that holds ``path``.

    Files that are larger than any model may be are left out.

    Raises:
        NoRevision: there is no git, no repository, no such revision, or no such path in it.
    """
    here = Path(path).absolute()
    start = here if here.is_dir() else here.parent
    top = Path(_git(start, "rev-parse", "--show-toplevel").decode().strip())
    # Resolved here, so that a name that looks like an option is none.
    commit = _git(start, "rev-parse", "--verify", "--end-of-options", f"{name}^{{commit}}")
    inside = Path(os.path.relpath(here.resolve(), top.resolve()))
    with TemporaryDirectory(prefix="deros-diff-") as temporary:
        folder = Path(temporary).resolve()
        try:
            _write(top, commit.decode().split()[-1], folder)
        except OSError as error:
            raise NoRevision(f"cannot write the files of '{name}': {error.strerror}") from None
        there = Revision(name, folder, folder / inside)
        if not there.path.exists():
            raise NoRevision(f"'{path}' is not in revision '{name}'")
        yield there


def _write(top: Path, commit: str, folder: Path) -> None:
    listed = _git(top, "ls-tree", "-r", "-l", "-z", "--full-tree", commit).decode(
        errors="surrogateescape"
    )
    wanted: list[tuple[str, str, str]] = []
    for entry in filter(None, listed.split("\0")):
        about, _, path = entry.partition("\t")
        mode, kind, identifier, size = about.split()
        is_inside = os.pardir not in Path(path).parts  # git refuses others; a forged tree has them
        if kind == "blob" and is_inside and int(size) <= _MOST_BYTES and mode in {*_FILES, _LINK}:
            wanted.append((mode, identifier, path))
    wanted.sort(key=lambda each: each[0] == _LINK)  # so that no file is written through a link
    contents = _contents(top, [identifier for _, identifier, _ in wanted])
    for (mode, _, path), content in zip(wanted, contents, strict=True):
        target = folder / path
        target.parent.mkdir(parents=True, exist_ok=True)
        if mode in _FILES:
            target.write_bytes(content)
        elif _stays_inside(path, os.fsdecode(content)):
            target.symlink_to(os.fsdecode(content))


def _stays_inside(path: str, link: str) -> bool:
    """Return whether a symbolic link leads to a place in the revision."""
    found = Path(os.path.normpath(Path(path).parent / link))
    return not found.is_absolute() and os.pardir not in found.parts


def _contents(top: Path, identifiers: Sequence[str]) -> Iterator[bytes]:
    asked = "".join(f"{each}\n" for each in identifiers).encode()
    answer = _git(top, "cat-file", "--batch", asked=asked)
    position = 0
    for _ in identifiers:
        end = answer.index(b"\n", position)
        start, size = end + 1, int(answer[position:end].split()[2])
        yield answer[start : start + size]
        position = start + size + 1


def _git(folder: Path, *arguments: str, asked: bytes | None = None) -> bytes:
    command = ["git", "-C", str(folder), *arguments]
    try:
        done = subprocess.run(command, input=asked, capture_output=True, check=False)
    except FileNotFoundError:
        raise NoRevision("git is not installed") from None
    if done.returncode:
        why = done.stderr.decode(errors="replace").strip().removeprefix("fatal: ")
        raise NoRevision(f"git: {why}")
    return done.stdout
