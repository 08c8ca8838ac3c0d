"""Differences as ``diagnostic_msgs/DiagnosticArray``, for the tools that show diagnostics."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import Any

from deros.live.observer import Observer
from deros.live.verify.differences import Difference, Kind
from deros.live.verify.texts import line
from deros.report.text import counted

PERIOD_S = 1.0
"""Seconds between two messages."""

_TOPIC = "/diagnostics"


class DiagnosticsPublisher:
    """Publishes a status for each kind, whether something differs or not, so that none is stale."""

    def __init__(self, observer: Observer, system: str) -> None:
        """Start to publish for a system, which the names of the statuses begin with."""
        from diagnostic_msgs.msg import DiagnosticArray

        self._node = observer.node
        self._system = system
        self._publisher = self._node.create_publisher(DiagnosticArray, _TOPIC, 10)
        self._due = 0.0

    def publish_if_due(self, reported: Sequence[Difference]) -> None:
        """Publish what is reported by now, if the last message is a period ago."""
        from diagnostic_msgs.msg import DiagnosticArray

        now = time.monotonic()
        if now < self._due:
            return
        self._due = now + PERIOD_S
        message = DiagnosticArray()
        message.header.stamp = self._node.get_clock().now().to_msg()
        message.status = [self._status(kind, reported) for kind in Kind]
        self._publisher.publish(message)

    def _status(self, kind: Kind, reported: Sequence[Difference]) -> Any:
        from diagnostic_msgs.msg import DiagnosticStatus, KeyValue

        found = [each for each in reported if each.kind is kind]
        level = DiagnosticStatus.OK
        if found:
            is_error = kind.severity == "error"
            level = DiagnosticStatus.ERROR if is_error else DiagnosticStatus.WARN
        return DiagnosticStatus(
            level=level,
            name=f"{self._system} as modelled: {kind.word}",
            message=counted(len(found), "difference") if found else "none",
            values=[KeyValue(key=_key(each), value=line(each)) for each in found],
        )


def _key(found: Difference) -> str:
    return f"{found.node}, {found.subject}" if found.subject else found.node
