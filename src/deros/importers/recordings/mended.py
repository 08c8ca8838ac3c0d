"""Files in MCAP that were cut off: of a recorder that was killed, or a copy that was interrupted.

What is whole is followed by an end as MCAP has it, so that any reader accepts the file.
Source: MCAP specification, "File Structure" and "Records".
"""

from __future__ import annotations

import io
import struct
from pathlib import Path
from typing import BinaryIO

_MAGIC = b"\x89MCAP0\r\n"
_END = struct.pack("<BQQQI", 0x02, 20, 0, 0, 0) + _MAGIC
"""A footer that refers to no summary."""

_LENGTH = struct.Struct("<BQ")
"""The head of a record: what it is, and the length of what follows, in bytes."""

_DATA_END, _FOOTER = 0x0F, 0x02


def is_cut_off(path: Path) -> bool:
    """Return whether a file begins as MCAP and does not end so.

    Raises:
        OSError: if it cannot be read.
    """
    with path.open("rb") as file:
        if file.read(len(_MAGIC)) != _MAGIC:
            return False
        size = file.seek(0, io.SEEK_END)
        file.seek(max(size - len(_MAGIC), 0))
        return size < 2 * len(_MAGIC) or file.read() != _MAGIC


class MendedFile:
    """A file that was cut off, as the path of one that ends behind its last whole record.

    Attributes:
        kept: the size of what is whole, in bytes.
    """

    def __init__(self, path: Path) -> None:
        """Find the last whole record.

        Raises:
            OSError: if the file cannot be read.
        """
        self._path = path
        with path.open("rb") as file:
            self.kept = _whole(file)

    def open(self, mode: str) -> BinaryIO:
        """Open the file for reading bytes, which is the only mode."""
        assert mode == "rb"
        return io.BufferedReader(_Mended(self._path.open("rb"), self.kept))

    def __str__(self) -> str:
        """Return the path of the file that was cut off."""
        return str(self._path)


def _whole(file: BinaryIO) -> int:
    """Return where the last whole record ends that belongs to the data."""
    size = file.seek(0, io.SEEK_END)
    end = file.seek(len(_MAGIC))
    while len(head := file.read(_LENGTH.size)) == _LENGTH.size:
        operation, length = _LENGTH.unpack(head)
        following = end + _LENGTH.size + length
        # Behind the data there are indexes, which are of no use without their end.
        if operation in (_DATA_END, _FOOTER) or following > size:
            break
        end = file.seek(following)
    return end


class _Mended(io.RawIOBase):
    """The first bytes of a file, with an end behind them."""

    def __init__(self, file: BinaryIO, kept: int) -> None:
        self._file = file
        self._kept = kept
        self._at = 0

    def readable(self) -> bool:
        return True

    def seekable(self) -> bool:
        return True

    def seek(self, offset: int, whence: int = io.SEEK_SET) -> int:
        start = {io.SEEK_SET: 0, io.SEEK_CUR: self._at, io.SEEK_END: self._kept + len(_END)}
        self._at = max(start[whence] + offset, 0)
        return self._at

    def tell(self) -> int:
        return self._at

    def readinto(self, buffer: memoryview) -> int:  # type: ignore[override]
        if self._at < self._kept:
            self._file.seek(self._at)
            data = self._file.read(min(len(buffer), self._kept - self._at))
        else:
            start = self._at - self._kept
            data = _END[start : start + len(buffer)]
        buffer[: len(data)] = data
        self._at += len(data)
        return len(data)

    def close(self) -> None:
        self._file.close()
        super().close()
