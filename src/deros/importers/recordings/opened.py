"""What recordings say of themselves: topics, types, QoS, definitions, how many messages.

Messages are not decoded. Files are untrusted: whatever is wrong with one is an
:class:`~deros.importers.readers.UnreadableError`.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import quote

from deros.generators.text.prose import printable_line
from deros.importers.readers import UnreadableError
from deros.importers.recordings.bounded import Allowance, bounded_chunks, unpacked
from deros.importers.recordings.mended import MendedFile, is_cut_off
from deros.importers.recordings.recognized import METADATA, SUFFIXES, storage_files
from deros.importers.results import Missing
from deros.interfaces.durations import LONGEST_NS
from deros.interfaces.files import entries, is_file, is_folder, read_regular, status
from deros.models.common import QosProfile

_LONGEST_METADATA = 16 << 20
_FOREVER_S = 2**31 - 1
"""A time of QoS in seconds that some middleware, or all of them, take as infinite."""

_MOST = 2**63
"""The limit of what is counted, and of times in ns: those of the format."""

_COMPRESSED = tuple(f"{suffix}.zstd" for suffix in SUFFIXES)


@dataclass(frozen=True, slots=True)
class Channel:
    """A topic of a recording, as one type with one set of QoS.

    Attributes:
        type: as the recording spells it.
        messages: how many.
        offered: the QoS of the publishers, each profile once; as far as the language has it.
        language: ``msg`` or ``idl``, of the definition; empty if there is none.
        definition: of the type and of those in it, one behind the other.
    """

    topic: str
    type: str
    messages: int
    offered: tuple[QosProfile, ...]
    language: str
    definition: str


@dataclass(frozen=True, slots=True)
class Recording:
    """A recording, or one of its files.

    Attributes:
        path: of what was read.
        duration_ns: from the first message to the last one.
    """

    path: Path
    channels: tuple[Channel, ...]
    duration_ns: int


def opened(path: Path) -> tuple[list[Recording], list[Missing]]:
    """Return the recordings at a path, and what is not read of them.

    A folder whose ``metadata.yaml`` is missing or of no use is one recording for each file in it.

    Raises:
        UnreadableError: if nothing can be read.
    """
    if not is_folder(path):
        recording, cut = _file(path)
        return [recording], cut
    missing: list[Missing] = []
    try:
        if not is_file(path / METADATA):
            raise UnreadableError(f"{path}: there is no {METADATA} in it")
        return [_folder(path)], []
    except UnreadableError as error:
        files = storage_files(path)
        if not files:
            raise
        why = str(error).removeprefix(f"{path}: ")
        missing.append(Missing(METADATA, f"is of no use: {why}", str(path)))
    recordings = []
    for file in files:
        recording, more = _file(file)
        recordings.append(recording)
        missing += more
    return recordings, missing


def _folder(path: Path) -> Recording:
    try:
        read_regular(path / METADATA, _LONGEST_METADATA)
    except OSError as error:
        raise UnreadableError(f"{path / METADATA}: {error.strerror or error}") from error
    return _read("dir", path, path)


def _file(path: Path) -> tuple[Recording, list[Missing]]:
    if path.name.endswith(_COMPRESSED):
        raise UnreadableError(
            f"{path}: is compressed as a whole: name its folder, with {METADATA}, instead"
        )
    kind = status(path)
    if kind != "file":
        raise UnreadableError(f"{path}: {'is not a file' if kind else 'there is no such file'}")
    if path.suffix not in SUFFIXES:
        raise UnreadableError(f"{path}: is neither {' nor '.join(SUFFIXES)} by its name")
    try:
        mended = MendedFile(path) if is_cut_off(path) else None
    except OSError as error:
        raise UnreadableError(f"{path}: {error.strerror or error}") from error
    if mended is None:
        # rosbags makes a URI of the path of a database, and does not quote it.
        source = Path(quote(str(path))) if path.suffix == ".db3" else path
        return _read(path.suffix, source, path), []
    recording = _read(path.suffix, mended, path)
    why = "is missing: the file was cut off"
    return recording, [Missing(f"what was behind byte {mended.kept}", why, str(path))]


def _read(plugin: str, source: Any, path: Path) -> Recording:
    """Read a recording with the reader of rosbags for its kind."""
    from rosbags.rosbag2 import Reader

    try:
        with ExitStack() as opened_now:
            allowance = Allowance(_size(path))
            opened_now.enter_context(bounded_chunks(allowance))
            if plugin == "dir":
                source = opened_now.enter_context(unpacked(path, allowance))
            reader: Any = Reader.STORAGE_PLUGINS[plugin](source)
            reader.open()
            opened_now.callback(reader.close)
            duration = _count(reader.metadata.duration)
            channels = tuple(_channels(reader.connections))
        # The reader counts the nanosecond of the last message, too.
        return Recording(path, channels, max(duration - 1, 0))
    # Bytes that are not what they should be end anywhere in rosbags and what it builds on.
    except Exception as error:
        reason = printable_line(str(error)) or type(error).__name__
        raise UnreadableError(f"{path}: is not a recording that can be read: {reason}") from error


def _size(path: Path) -> int:
    """Return how many bytes a file has, or the files of a folder."""
    files = (path / each.name for each in entries(path) if not each.is_folder)
    return sum(each.stat().st_size for each in (files if is_folder(path) else [path]))


def _channels(connections: Any) -> Iterator[Channel]:
    from rosbags.interfaces import MessageDefinitionFormat

    languages = {MessageDefinitionFormat.MSG: "msg", MessageDefinitionFormat.IDL: "idl"}
    for each in connections:
        if not isinstance(each.topic, str) or not isinstance(each.msgtype, str):
            raise TypeError(f"the topic {each.topic!r} of type {each.msgtype!r} is not in words")
        offered = dict.fromkeys(map(_profile, each.ext.offered_qos_profiles))
        language = languages.get(each.msgdef.format, "")
        text = each.msgdef.data if language else ""
        messages = _count(each.msgcount)
        yield Channel(each.topic, each.msgtype, messages, tuple(offered), language, text)


def _count(number: Any) -> int:
    """Return a number of a file.

    Raises:
        ValueError: if it is none, or cannot be right.
    """
    if not isinstance(number, int) or not 0 <= number < _MOST:
        raise ValueError(f"{number!r:.40} is not a number of messages or nanoseconds")
    return number


def _profile(qos: Any) -> QosProfile:
    """Return what a publisher offers, without its queue, which no subscription sees."""
    reliability = qos.reliability.name.lower()
    durability = qos.durability.name.lower()
    liveliness = qos.liveliness.name.lower()
    lease = _finite(qos.liveliness_lease_duration)
    if liveliness not in ("automatic", "manual_by_topic"):
        liveliness = lease = None
    return QosProfile(
        reliability=reliability if reliability in ("reliable", "best_effort") else None,
        durability=durability if durability in ("volatile", "transient_local") else None,
        deadline_ns=_finite(qos.deadline),
        lifespan_ns=_finite(qos.lifespan),
        liveliness=None if liveliness == "automatic" and lease is None else liveliness,
        lease_ns=lease,
    )


def _finite(time: Any) -> int | None:
    """Return a time in ns, or ``None`` if it is infinite or not said."""
    seconds, nanoseconds = int(time.sec), int(time.nsec)
    total = seconds * 10**9 + nanoseconds
    return total if 0 < total < LONGEST_NS and seconds < _FOREVER_S else None
