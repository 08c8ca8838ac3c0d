"""Reading of untrusted file names: without blocking, and up to a size limit."""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path


def read_regular(path: Path, most: int) -> bytes:
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
    descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC | os.O_NOCTTY)
    with os.fdopen(descriptor, "rb") as stream:
        status = os.fstat(descriptor)
        if stat.S_ISDIR(status.st_mode):
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
        if not stat.S_ISREG(status.st_mode):
            raise OSError(errno.EINVAL, "not a regular file", str(path))
        # Some files of the kernel say that they hold nothing, and go on for ever.
        data = stream.read(most + 1)
    if len(data) > most:
        raise OSError(errno.EFBIG, f"longer than {most} bytes", str(path))
    return data
