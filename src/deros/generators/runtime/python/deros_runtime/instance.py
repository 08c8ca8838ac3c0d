"""Single-instance lock: one node of a name on a machine."""

from __future__ import annotations

import fcntl
import hashlib
import os
from pathlib import Path
import stat
import tempfile
from typing import TextIO

from .regular_file import is_same, open_regular


class Refusal(Exception):  # noqa: N818 - not an error of the program
    """The node must not run; the text says why."""


def claim(name: str, domain: int, folder: Path | None = None) -> TextIO:
    """
    Acquire the lock of a node, by its fully qualified name, until the process ends.

    Keep the file that is returned. Locks are in a folder of the user: nodes of other users, and on
    other machines, are not detected. Raises Refusal if another process holds the lock, and OSError
    if there can be no lock.
    """
    folder = folder or Path(tempfile.gettempdir()) / f'deros-{os.getuid()}'
    folder.mkdir(mode=0o700, exist_ok=True)
    _check_own(folder)
    path = folder / f'{file_stem(name, domain)}.lock'
    while True:
        lock = os.fdopen(open_regular(path, os.O_RDWR | os.O_CREAT), 'r+', encoding='ascii')
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            holder = lock.read(32).strip() or 'unknown'
            lock.close()
            raise Refusal(
                f'{name} runs already in domain {domain}, as process {holder}: '
                'this second one ends now'
            ) from None
        if is_same(path, lock.fileno()):
            break
        lock.close()  # it was removed in between, and another process may hold a new one
    lock.truncate(0)
    lock.write(f'{os.getpid()}\n')
    lock.flush()
    return lock


def _check_own(folder: Path) -> None:
    """Raise OSError unless a folder is the user's own, so that nobody else can hold its locks."""
    found = folder.lstat()
    if not stat.S_ISDIR(found.st_mode):
        raise NotADirectoryError(f'{folder} is not a folder')
    if found.st_uid != os.getuid():
        raise PermissionError(f'{folder} belongs to another user')
    if found.st_mode & (stat.S_IWGRP | stat.S_IWOTH):
        raise PermissionError(f'others may write in {folder}')


def file_stem(name: str, domain: int) -> str:
    """Return the stem of the names of a node's files, which no other node has."""
    stem = name.strip('/').replace('/', '.')
    if len(stem) > 200:  # a file name ends at 255 bytes
        stem = f'{stem[:100]}-{hashlib.sha256(stem.encode()).hexdigest()[:16]}'
    return f'{stem}.{domain}'
