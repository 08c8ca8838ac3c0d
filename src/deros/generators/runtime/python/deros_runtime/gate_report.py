"""Reports what a gate does and why, on /diagnostics and in the log."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.node import Node
from rclpy.serialization import deserialize_message

from .clock_choice import USE_SIM_TIME
from .gate_logic import Gate
from .one_shot_timer import NodeClock, OneShotTimer, steady_clock
from .publishers import PublisherCheck
from .target_publishers import TargetPublisherCheck

OK, WARN, ERROR = DiagnosticStatus.OK, DiagnosticStatus.WARN, DiagnosticStatus.ERROR
PERIOD = 1_000_000_000  # ns
HARDWARE_ID = 'deros gate'  # by which its reports are told from those of other nodes
WAITS = 'waits for /clock: simulated time has not begun'
SOON = 50_000_000  # ns from a change to its message, in which further changes are collected


def decoded(data: bytes, kind: type) -> Any:
    """Return the message, or None if the data is not of this type."""
    try:
        return deserialize_message(data, kind)
    except Exception:  # each type of message may find another kind of fault in it
        return None


class GateReport:
    """Publishes one status, regularly and soon after a change, which it also logs."""

    def __init__(
        self,
        node: Node,
        gate: Gate,
        clock: NodeClock,
        publish: Callable[[DiagnosticArray], None],
        target: str,
    ) -> None:
        """Start; clock is that of the gate, target is a topic."""
        self.refused = 0
        self.faults: dict[str, str] = {}  # by what they are about
        self._node = node
        self._gate = gate
        self._texts = gate.table.reports
        self._clock = clock
        self._publish = publish
        self._reported: tuple[bool, ...] = ()
        self._source = ''  # in the last report
        self._cause = ''
        self._is_simulated = bool(node.get_parameter(USE_SIM_TIME).value)
        self._publishers = PublisherCheck(node, self.fault)
        self._target = TargetPublisherCheck(node, target, self.fault)
        self._steady = steady_clock(node)
        self._timer = OneShotTimer(self._steady, self._fire)
        self._timer.schedule(0)

    def check(self) -> None:
        """Report soon if another line or source applies; this takes next to no time."""
        if self._gate.applying is not self._reported or self._gate.source_name != self._source:
            self._hurry()

    def refuse(self, cause: str) -> None:
        """Count a command that was refused."""
        self.refused += 1
        self._cause = cause
        self._hurry()

    def answer(self, against: Sequence[int]) -> str:
        """Log a reset, and return the answer to it; against: numbers of lines that refuse it."""
        if against:
            refusing = '; '.join(self._texts[number] for number in against)
            text = f'not reset, because this applies: {refusing}'
            self._node.get_logger().warning(text)
        else:
            text = f'reset: {"; ".join(self._applying()) or self._passes()}'
            self._node.get_logger().info(text)
        return text

    def fault(self, subject: str, text: str) -> None:
        """Set or, with an empty text, clear what is wrong with something."""
        if self.faults.get(subject, '') == text:
            return
        self.faults.pop(subject, None)
        if text:
            self.faults[subject] = text
            self._node.get_logger().error(f'{subject}: {text}')
        self._hurry()

    def _hurry(self) -> None:
        soon = self._steady.now() + SOON
        if not self._timer.is_scheduled or self._timer.due > soon:
            self._timer.schedule(soon)

    def _fire(self) -> None:
        self._timer.schedule(self._steady.now() + PERIOD)
        if (self._gate.applying, self._gate.source_name) != (self._reported, self._source):
            self._log()
        self._reported, self._source = self._gate.applying, self._gate.source_name
        message = DiagnosticArray(status=[self._status()])
        message.header.stamp = self._node.get_clock().now().to_msg()
        self._publish(message)
        self._publishers.check()
        self._target.check()

    def _awaits_clock(self) -> bool:
        """Return whether no message of /clock has come yet, on which the node's time depends."""
        return self._is_simulated and self._node.get_clock().now().nanoseconds == 0

    def _log(self) -> None:
        applying = '; '.join(self._applying())
        if applying:
            name = self._gate.source_name
            self._node.get_logger().warning(f'{applying} (source: {name})' if name else applying)
        else:
            self._node.get_logger().info(self._passes())

    def _passes(self) -> str:
        name = self._gate.source_name
        return f'commands of {name} pass' if name else 'commands pass'

    def _applying(self) -> Iterator[str]:
        for text, applies in zip(self._texts, self._gate.applying, strict=True):
            if applies:
                yield text

    def _status(self) -> DiagnosticStatus:
        waits = [WAITS] if self._awaits_clock() else []
        applying = [*waits, *self._applying()]
        lines = enumerate(self._gate.table.lines)
        is_severe = any(line.is_severe and self._gate.applying[number] for number, line in lines)
        level = ERROR if self.faults or is_severe else WARN if applying else OK
        ago = max(self._clock.now() - self._gate.since, 0) / 1e9
        values = {
            'since': f'{ago:.3f} s ago',
            'since_ns': self._gate.since + self._clock.origin,
            'refused': self.refused,
            'refused_last': self._cause,
            **({'source': self._gate.source_name or 'none'} if self._gate.table.sources else {}),
            **self.faults,
        }
        return DiagnosticStatus(
            level=level,
            name=self._node.get_fully_qualified_name(),
            message='; '.join([*self.faults.values(), *applying]) or self._passes(),
            hardware_id=HARDWARE_ID,
            values=[KeyValue(key=key, value=str(value)) for key, value in values.items()],
        )
