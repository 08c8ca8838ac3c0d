"""Recordings of some kilobytes that unpack to more than a machine has."""

from __future__ import annotations

import io
import struct
import tempfile
import tracemalloc
from collections.abc import Callable
from pathlib import Path
from typing import Any

import lz4.frame  # type: ignore[import-untyped]
import pytest
from rosbags.rosbag2 import CompressionMode, storage_mcap

from deros.importers.readers import UnreadableError
from deros.importers.recordings import bounded
from tests.support.recorded import Topic, read, record, storage_file, topics

MIB = 1 << 20
ZEROS = bytes(MIB)
ZSTD: Any = vars(storage_mcap)["zstd"]


def zstd_zeros(mebibytes: int) -> bytes:
    """Return so much, packed a piece at a time."""
    packed = io.BytesIO()
    with ZSTD.open(packed, "wb") as stream:
        for _ in range(mebibytes):
            stream.write(ZEROS)
    return packed.getvalue()


def lz4_zeros(mebibytes: int) -> bytes:
    """Return so much, packed a piece at a time."""
    with lz4.frame.LZ4FrameCompressor() as packer:
        pieces = [packer.begin(), *(packer.compress(ZEROS) for _ in range(mebibytes))]
        return bytes(b"".join([*pieces, packer.flush()]))


BOMBS: dict[str, Callable[[int], bytes]] = {"zstd": zstd_zeros, "lz4": lz4_zeros}


def cut_off(folder: Path, *chunks: tuple[str, int, bytes]) -> Path:
    """Write a file in MCAP that has no end: its chunks are unpacked when it is read.

    Args:
        folder: where.
        chunks: how each is packed, the size that it says it has, and its content.
    """
    content = storage_file(record(folder / "bag", Topic("/a", "std_msgs/msg/Bool"))).read_bytes()
    file = folder / "bomb.mcap"
    with file.open("wb") as target:
        target.write(content[: 17 + struct.unpack_from("<Q", content, 9)[0]])
        for name, size, packed in chunks:
            head = struct.pack("<QQQII", 0, 0, size, 0, len(name)) + name.encode()
            chunk = head + struct.pack("<Q", len(packed)) + packed
            target.write(b"\x06" + struct.pack("<Q", len(chunk)) + chunk)
    return file


@pytest.mark.parametrize("packing", BOMBS)
@pytest.mark.parametrize(
    ("said", "why"),
    [(600 * MIB, "a chunk of it has 629145600 bytes"), (1000, "expected 1000 bytes, got 1001")],
    ids=["honest", "lying"],
)
def test_chunk_takes_no_more_memory_than_is_allowed(
    said: int, why: str, packing: str, tmp_path: Path
) -> None:
    """Whatever size it says it has."""
    file = cut_off(tmp_path, (packing, said, BOMBS[packing](600)))
    assert file.stat().st_size < 8 * MIB
    tracemalloc.start()
    try:
        with pytest.raises(UnreadableError, match=rf"bomb\.mcap: is not a recording .*{why}"):
            read(file)
        assert tracemalloc.get_traced_memory()[1] < 64 * MIB
    finally:
        tracemalloc.stop()


def test_many_chunks_count_together(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each of them may be allowed; records of a kind that nobody knows are skipped."""
    skipped = b"\x7f" + struct.pack("<Q", MIB) + ZEROS
    with ZSTD.open(tmp_path / "chunk", "wb") as stream:
        stream.write(skipped)
    chunk = ("zstd", len(skipped), (tmp_path / "chunk").read_bytes())
    file = cut_off(tmp_path, *[chunk] * 12)
    with pytest.raises(UnreadableError, match="no topic but those of ROS 2"):
        read(file)
    monkeypatch.setattr(bounded, "LEAST", 10 * MIB)
    with pytest.raises(UnreadableError, match="unpacks to more than 10485760 bytes, which are not"):
        read(file)


def test_file_that_is_packed_as_a_whole_does_not_fill_the_disk(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is unpacked up to the limit, and the temporary folder is removed."""
    path = record(
        tmp_path / "bag", Topic("/a", "std_msgs/msg/Bool", 3), compression=CompressionMode.FILE
    )
    scratch = tmp_path / "scratch"
    scratch.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(scratch))
    whole = topics(read(path))
    assert whole[0].endswith("// 3 messages, 10 Hz")
    storage_file(path).write_bytes(zstd_zeros(64))
    monkeypatch.setattr(bounded, "LEAST", 10 * MIB)
    with pytest.raises(UnreadableError, match=r"bag: .* unpacks to more than 10485760 bytes"):
        read(path)
    assert list(scratch.iterdir()) == []


def test_large_recordings_may_unpack_to_more() -> None:
    """The limit grows with the file."""
    allowance = bounded.Allowance(bounded.LEAST)
    assert allowance.left == bounded.LEAST * bounded.MOST_TIMES
    assert bounded.Allowance(0).left == bounded.LEAST


def test_limits_end_with_the_reading(tmp_path: Path) -> None:
    """Other users of rosbags in the process have none."""
    before = dict(storage_mcap.DECOMPRESSORS)
    with pytest.raises(UnreadableError):
        read(cut_off(tmp_path, ("zstd", 600 * MIB, b"")))
    assert before == storage_mcap.DECOMPRESSORS
