"""How much of a recording is unpacked: a file of some kilobytes can hold zeros for any machine."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path, PurePath
from tempfile import TemporaryDirectory
from typing import Any, BinaryIO

from deros.importers.recordings.recognized import METADATA
from deros.interfaces.files import is_file

LARGEST_CHUNK = 256 << 20
"""Bytes of a chunk, which is unpacked in memory. Recorders write some megabytes, or one message."""

LEAST = 1 << 30
MOST_TIMES = 100
"""A recording may unpack to :data:`LEAST` bytes, or to so many times what it is, if that is more.

Recorded sensors shrink to a half or a tenth, and maps that are mostly empty to a fiftieth.
"""

_PIECE = 1 << 20
_INFORMATION = "rosbag2_bagfile_information"


class TooLargeError(Exception):
    """Some of a recording unpacks to more than is read; the text says how much that is."""


class Allowance:
    """What may be unpacked of one recording, and how much of it is left, in bytes."""

    def __init__(self, packed: int) -> None:
        """Begin with a recording that has so many bytes."""
        self.left = self._most = max(LEAST, MOST_TIMES * packed)

    def chunk(self, stream: BinaryIO, size: int) -> bytes:
        """Return what a stream unpacks to, and of one that is longer than it says no more.

        Args:
            stream: unpacks as much as is asked for.
            size: what the file says.

        Raises:
            TooLargeError: that is more than is allowed.
        """
        if size > LARGEST_CHUNK:
            raise TooLargeError(f"a chunk of it has {size} bytes, and {LARGEST_CHUNK} may be read")
        self._take(size)
        return stream.read(size + 1)

    def copy(self, packed: BinaryIO, target: BinaryIO) -> None:
        """Copy what a stream unpacks to, piece by piece; raises as :meth:`chunk`."""
        while piece := packed.read(_PIECE):
            self._take(len(piece))
            target.write(piece)

    def _take(self, size: int) -> None:
        self.left -= size
        if self.left < 0:
            raise TooLargeError(f"it unpacks to more than {self._most} bytes, which are not read")


@contextmanager
def bounded_chunks(allowance: Allowance) -> Iterator[None]:
    """Have rosbags unpack chunks of MCAP within an allowance.

    It unpacks those of a file without a summary, and has no limit of its own.
    """
    from lz4 import frame as lz4  # type: ignore[import-untyped]
    from rosbags.rosbag2 import storage_mcap

    def bounded(opened: Callable[..., BinaryIO]) -> Callable[[bytes, int], bytes]:
        def unpack(data: bytes, size: int) -> bytes:
            with opened(io.BytesIO(data), "rb") as stream:
                return allowance.chunk(stream, size)

        return unpack

    table: dict[str, Any] = storage_mcap.DECOMPRESSORS
    before = dict(table)
    table.update(lz4=bounded(lz4.open), zstd=bounded(_zstd().open))
    try:
        yield
    finally:
        table.update(before)


def _zstd() -> Any:
    """Return the library that rosbags unpacks with, which depends on the versions."""
    return vars(import_module("rosbags.rosbag2.storage_mcap"))["zstd"]


@contextmanager
def unpacked(folder: Path, allowance: Allowance) -> Iterator[Path]:
    """Give the folder of a recording whose files are not compressed as a whole.

    If they are, it is a temporary one, with the same in it.

    Raises:
        TooLargeError: the files unpack to more than is allowed.
        OSError: a file cannot be read, or there is no room for it.
        ValueError: the files are compressed in another way than with zstd.
    """
    from ruamel.yaml import YAML

    yaml: Any = YAML(typ="safe")
    document = yaml.load((folder / METADATA).read_text(encoding="utf-8"))
    said = document.get(_INFORMATION) if isinstance(document, dict) else None
    mode = said.get("compression_mode") if isinstance(said, dict) else None
    if said is None or str(mode).lower() != "file":
        yield folder
        return
    if (how := said.get("compression_format")) != "zstd":
        raise ValueError(f"its files are compressed in {how!r:.40}, and zstd alone can be read")
    with TemporaryDirectory(prefix="deros-") as made:
        names = []
        for each in said["relative_file_paths"]:
            packed = folder / PurePath(each).name
            if not is_file(packed):
                raise FileNotFoundError(f"there is no file {packed.name} in it")
            names.append(packed.stem)
            with _zstd().open(packed) as stream, Path(made, packed.stem).open("wb") as target:
                allowance.copy(stream, target)
        said |= {"compression_mode": "none", "relative_file_paths": names}
        with Path(made, METADATA).open("w", encoding="utf-8") as metadata:
            yaml.dump(document, metadata)
        yield Path(made)
