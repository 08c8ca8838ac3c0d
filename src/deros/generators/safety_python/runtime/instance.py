"""One node of a name on this machine, and no second one."""

from __future__ import annotations

import fcntl
import hashlib
import os
from pathlib import Path
import tempfile
from typing import TextIO


class Refusal(Exception):  # noqa: N818 - it is no error of the program
    """The node must not run; the text says why."""


def claim(name: str, domain: int, folder: Path | None = None) -> TextIO:
    """
    Hold the lock of a node, by its fully qualified name, until the process ends, however it ends.

    Keep what is returned. A lock in a folder is a user's own: those of other users, and of other
    machines, are not known here. Raises Refusal if another process holds the lock, and OSError if
    there can be no lock.
    """
    folder = folder or Path(tempfile.gettempdir()) / f'deros-{os.getuid()}'
    folder.mkdir(mode=0o700, exist_ok=True)
    if folder.lstat().st_uid != os.getuid():
        raise PermissionError(f'{folder} belongs to another user')
    path = folder / f'{file_stem(name, domain)}.lock'
    lock = path.open('a+', encoding='ascii')
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        lock.seek(0)
        holder = lock.read().strip() or 'unknown'
        lock.close()
        raise Refusal(
            f'{name} runs already in domain {domain}, as process {holder}: '
            'this second one ends now'
        ) from None
    lock.truncate(0)
    lock.write(f'{os.getpid()}\n')
    lock.flush()
    return lock


def file_stem(name: str, domain: int) -> str:
    """Return what tells the files of a node from those of all others."""
    stem = name.strip('/').replace('/', '.')
    if len(stem) > 200:  # a file name ends at 255 bytes
        stem = f'{stem[:100]}-{hashlib.sha256(stem.encode()).hexdigest()[:16]}'
    return f'{stem}.{domain}'
