"""Recordings of rosbag2, written by rosbags, and the models that they become."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
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

from deros.generators.output.writer import write
from deros.importers.kept.files import renewed
from deros.importers.readers import Request
from deros.importers.recordings.reading import read_recordings
from deros.importers.results import Imported
from deros.interfaces.store import InterfaceStore
from tests.support.checks import checked
from tests.support.rules import embedded_store

SEPARATOR = "=" * 80
"""The line between two definitions in a recording."""

OWN = f"""# A wheel
other_msgs/Part left  # [rad]
std_msgs/Header header
{SEPARATOR}
MSG: other_msgs/Part
float64 angle 1.5
string<=5[<=3] names
"""
"""A message that is not known here, with another one in it."""

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


MCAP, SQLITE = StoragePlugin.MCAP, StoragePlugin.SQLITE3
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
    with writer:
        messages = []
        for topic in topics:
            connection = writer.add_connection(
                topic.name,
                topic.type,
                msgdef=topic.definition or _definition(topic.type),
                rihs01="RIHS01_" + "0" * 64,
                offered_qos_profiles=topic.offered,
            )
            messages += [(at * topic.period_ms, connection) for at in range(topic.messages)]
        for at, connection in sorted(messages, key=lambda each: each[0]):
            writer.write(connection, 10**18 + at * 10**6, bytes(16))
    return path


@cache
def _definition(of_type: str) -> str:
    return get_typestore(Stores.ROS2_JAZZY).generate_msgdef(of_type, ros_version=2)[0]


def storage_file(folder: Path) -> Path:
    """Return the only file with messages of a recording."""
    (found,) = (each for each in folder.iterdir() if each.name != "metadata.yaml")
    return found


def read(*paths: Path, store: InterfaceStore | None = None) -> Imported:
    """Return the models of recordings; by default nothing is known but what ships with deros."""
    store = store or embedded_store()
    return read_recordings(Request(paths, None, Path(), store.exists, store))


def topics(imported: Imported) -> list[str]:
    """Return the lines of the system, without the keyword above them."""
    (parts,) = imported.files.values()
    first, *lines = parts.body.splitlines()
    assert first == "topics"
    return [line.strip() for line in lines]


def findings(imported: Imported, folder: Path) -> list[str]:
    """Write models, and return what a check says of them."""
    write(renewed(imported.files, folder).files, folder)
    for path, text in imported.interfaces.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text, encoding="utf-8")
    store = InterfaceStore([folder / "interfaces"], prefixes=())
    return [each.message for each in checked(folder / "robot.system", store=store)]
