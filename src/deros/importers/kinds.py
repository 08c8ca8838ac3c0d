"""The kinds of files that models can be imported from: a row each."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from deros.importers.readers import Kind
from deros.importers.recordings.reading import read_recordings
from deros.importers.recordings.recognized import is_recording

KINDS: tuple[Kind, ...] = (
    Kind(
        "recording",
        "a recording of rosbag2: its folder, or an .mcap or .db3 file",
        is_recording,
        read_recordings,
    ),
)


def kinds_of(files: Sequence[Path]) -> Iterator[Kind | None]:
    """Yield the kind of each file, ``None`` for one that is of none."""
    for file in files:
        yield next((kind for kind in KINDS if kind.is_one(file)), None)
