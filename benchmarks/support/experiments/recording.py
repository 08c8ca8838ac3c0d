"""Recordings in MCAP: what the recorder and the safety node write, and how it is read again."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import TracebackType
from typing import Any

from mcap.exceptions import McapError
from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer

RECORDER, NODE = "recorder.mcap", "node.mcap"
"""The two files of a run: what was on the topics, and what the safety node took of it, and when."""

MONITOR = "/monitor"
"""The topic of :data:`NODE` with what else the rules were given: their start, and resets."""

_JSON = "deros/monitor"


class RecordingError(Exception):
    """A recording cannot be read, or lacks something."""


@dataclass(frozen=True, slots=True)
class Recorded:
    """A recorded message, with the times of its receipt and of its sending, in ns."""

    topic: str
    type: str
    received: int
    sent: int
    data: bytes


@cache
def _types() -> Any:
    # Where it is used: the safety node under test imports this module, and is measured.
    from rosbags.typesys import Stores, get_typestore

    return get_typestore(Stores.ROS2_JAZZY)


def decode(message: Recorded) -> Any:
    """Return a recorded message as an object with its fields."""
    return _types().deserialize_cdr(message.data, message.type)


class Recording:
    """Writes one file; use it as a context manager."""

    def __init__(self, path: Path) -> None:
        """Begin the file."""
        self._file = path.open("wb")
        self._writer = Writer(self._file, compression=CompressionType.NONE)
        self._channels: dict[str, int] = {}

    def __enter__(self) -> Recording:
        """Write the head of the file."""
        self._writer.start(profile="ros2", library="deros benchmarks")
        return self

    def __exit__(
        self,
        _kind: type[BaseException] | None,
        _error: BaseException | None,
        _trace: TracebackType | None,
    ) -> None:
        """Write the summary, and close the file."""
        self._writer.finish()  # type: ignore[no-untyped-call]
        self._file.close()

    def add(self, message: Recorded) -> None:
        """Add a message of ROS 2."""
        if message.topic not in self._channels:
            definition = _types().generate_msgdef(message.type, ros_version=2)[0]
            schema = self._writer.register_schema(message.type, "ros2msg", definition.encode())
            self._channels[message.topic] = self._writer.register_channel(
                message.topic, "cdr", schema
            )
        channel = self._channels[message.topic]
        self._writer.add_message(channel, message.received, message.data, message.sent)

    def add_monitor(self, at: int, what: Mapping[str, Any]) -> None:
        """Add what the rules were given besides messages, at a time in ns."""
        if MONITOR not in self._channels:
            schema = self._writer.register_schema(_JSON, "jsonschema", b'{"type": "object"}')
            self._channels[MONITOR] = self._writer.register_channel(MONITOR, "json", schema)
        self._writer.add_message(self._channels[MONITOR], at, json.dumps(what).encode(), at)


def read(path: Path) -> list[Recorded]:
    """Return the messages of a file in the order in which they were added.

    Raises:
        RecordingError: if it cannot be read, or has none.
    """
    try:
        with path.open("rb") as file:
            found = [
                Recorded(
                    channel.topic,
                    "" if schema is None else schema.name,
                    message.log_time,
                    message.publish_time,
                    message.data,
                )
                for schema, channel, message in make_reader(file).iter_messages(
                    log_time_order=False
                )
            ]
    except (OSError, McapError) as error:
        raise RecordingError(f"{path}: cannot be read: {error}") from error
    if not found:
        raise RecordingError(f"{path}: has no messages")
    return found
