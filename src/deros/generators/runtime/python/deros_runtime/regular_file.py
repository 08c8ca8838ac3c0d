"""Opens regular files, and nothing else."""

from __future__ import annotations

import contextlib
import os
from pathlib import Path
import stat

_KINDS = {
    stat.S_IFLNK: 'symbolic link',
    stat.S_IFDIR: 'directory',
    stat.S_IFIFO: 'pipe',
    stat.S_IFSOCK: 'socket',
    stat.S_IFCHR: 'device',
    stat.S_IFBLK: 'device',
}


def open_regular(path: Path, flags: int, mode: int = 0o600) -> int:
    """
    Open a regular file and return its descriptor; it never waits.

    Anything else is not even opened, because opening a device can have an effect. Raises OSError.
    """
    check_replaceable(path)
    flags |= os.O_NOFOLLOW | os.O_NONBLOCK | os.O_NOCTTY | os.O_CLOEXEC
    descriptor = os.open(path, flags, mode)
    try:
        _check(os.fstat(descriptor))  # it may have been replaced after the first check
    except OSError:
        os.close(descriptor)
        raise
    return descriptor


def check_replaceable(path: Path) -> None:
    """Raise OSError if there is something that is not a regular file."""
    with contextlib.suppress(FileNotFoundError):
        _check(path.lstat())


def is_same(path: Path, descriptor: int) -> bool:
    """Return whether a path still refers to an open file."""
    try:
        found = path.lstat()
    except OSError:
        return False
    return os.path.samestat(found, os.fstat(descriptor))


def _check(found: os.stat_result) -> None:
    if not stat.S_ISREG(found.st_mode):
        kind = _KINDS.get(stat.S_IFMT(found.st_mode), 'special file')
        raise OSError(f'it is a {kind}, not a regular file')
