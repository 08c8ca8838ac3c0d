"""Recordings of rosbag2, written by rosbags."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from rosbags.interfaces import (
    Qos,
    QosDurability,
    QosHistory,
    QosLiveliness,
    QosReliability,
    QosTime,
)
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

SEPARATOR = "=" * 80
"""The line between two definitions in a recording."""

_FOREVER = QosTime(9223372036, 854775807)


def qos(
    reliability: QosReliability = QosReliability.RELIABLE,
    durability: QosDurability = QosDurability.VOLATILE,
    deadline: QosTime = _FOREVER,
    liveliness: QosLiveliness = QosLiveliness.AUTOMATIC,
    lease: QosTime = _FOREVER,
) -> Qos:
    """Return what a publisher offers, as recorders write it."""
    return Qos(
        QosHistory.UNKNOWN, 0, reliability, durability, deadline, _FOREVER, liveliness, lease, False
    )


BEST_EFFORT = qos(QosReliability.BEST_EFFORT)
LATCHED = qos(durability=QosDurability.TRANSIENT_LOCAL)


class Topic(NamedTuple):
    """A topic to record; messages are at 0 s, then one each period."""

    name: str
    type: str
    messages: int = 1
    period_ms: int = 100
    offered: Sequence[Qos] = (qos(),)
    definition: str | None = None  # by default that of Jazzy


def record(
    path: Path,
    *topics: Topic,
    storage: StoragePlugin = StoragePlugin.MCAP,
    compression: CompressionMode = CompressionMode.NONE,
    version: int = 9,
) -> Path:
    """Write a recording, and return its folder. The bytes of messages are all zero."""
    writer = Writer(path, version=8 if version == 8 else 9, storage_plugin=storage)
    writer.set_compression(compression, CompressionFormat.ZSTD)
    store = get_typestore(Stores.ROS2_JAZZY)
    with writer:
        messages = []
        for topic in topics:
            connection = writer.add_connection(
                topic.name,
                topic.type,
                msgdef=topic.definition or store.generate_msgdef(topic.type, ros_version=2)[0],
                rihs01="RIHS01_" + "0" * 64,
                offered_qos_profiles=topic.offered,
            )
            messages += [(at * topic.period_ms, connection) for at in range(topic.messages)]
        for at, connection in sorted(messages, key=lambda each: each[0]):
            writer.write(connection, 10**18 + at * 10**6, bytes(16))
    return path


def storage_file(folder: Path) -> Path:
    """Return the only file with messages of a recording."""
    (found,) = (each for each in folder.iterdir() if each.name != "metadata.yaml")
    return found
