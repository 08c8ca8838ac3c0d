"""Messages of diagnostics and events, made of plain values."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

Drawn = tuple[str, int, str, Mapping[str, str]]
"""Name, level, message and values of a status."""


def status(
    name: str,
    level: int,
    message: str,
    values: Mapping[str, str],
    hardware_id: str | None = None,
) -> Any:
    """Return a ``diagnostic_msgs/DiagnosticStatus``, of a gate or safety node by default."""
    from diagnostic_msgs.msg import DiagnosticStatus, KeyValue

    pairs = [KeyValue(key=key, value=value) for key, value in values.items()]
    if hardware_id is None:
        own = {"refused": "deros gate", "state": "deros safety node"}
        hardware_id = next((own[each] for each in own if each in values), "")
    return DiagnosticStatus(
        name=name, level=bytes([level]), message=message, hardware_id=hardware_id, values=pairs
    )


def array(*statuses: Drawn, hardware_id: str | None = None) -> Any:
    """Return a ``diagnostic_msgs/DiagnosticArray``."""
    from diagnostic_msgs.msg import DiagnosticArray

    return DiagnosticArray(status=[status(*each, hardware_id) for each in statuses])
