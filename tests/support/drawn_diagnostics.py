"""Messages of diagnostics and events, made of plain values."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

Drawn = tuple[str, int, str, Mapping[str, str]]
"""Name, level, message and values of a status."""


def status(name: str, level: int, message: str, values: Mapping[str, str]) -> Any:
    """Return a ``diagnostic_msgs/DiagnosticStatus``."""
    from diagnostic_msgs.msg import DiagnosticStatus, KeyValue

    pairs = [KeyValue(key=key, value=value) for key, value in values.items()]
    return DiagnosticStatus(name=name, level=bytes([level]), message=message, values=pairs)


def array(*statuses: Drawn) -> Any:
    """Return a ``diagnostic_msgs/DiagnosticArray``."""
    from diagnostic_msgs.msg import DiagnosticArray

    return DiagnosticArray(status=[status(*each) for each in statuses])
