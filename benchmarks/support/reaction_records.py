"""What safety nodes tell of themselves on ``~/events``."""

from __future__ import annotations

from collections.abc import Iterable

from diagnostic_msgs.msg import DiagnosticStatus
from rclpy.serialization import deserialize_message

from support.samples import Trigger

_STOP = "stop_"


def triggers(records: Iterable[bytes]) -> list[Trigger]:
    """Return the stops among the events of a safety node."""
    found = []
    for record in records:
        status = deserialize_message(record, DiagnosticStatus)
        values = {pair.key: pair.value for pair in status.values}
        if values.get("kind") == "trigger" and values["action"].startswith(_STOP):
            lane = values["action"].removeprefix(_STOP)
            found.append(Trigger(lane, int(values["time_ns"]), int(values["published_ns"])))
    return found
