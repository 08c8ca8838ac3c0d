"""Traces: recorded messages, one JSON object a line, for simulation and tests.

A line is ``{"t": "1.5", "topic": "/imu", "data": {"angular_velocity.z": 0.2}}``: the time in
seconds, read exactly, as text or as a number; the topic; and the fields that matter, nested or
dotted, array elements as ``position[2]``. All other fields have the defaults of the message
definition. ``NaN``, ``Infinity`` and ``-Infinity`` may be written as texts. Empty lines are
skipped.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from decimal import Decimal
from typing import Any

from deros import codes
from deros.diagnostics import Diagnostic, SourceFile, Span, report
from deros.interfaces.names import did_you_mean, near
from deros.interfaces.store import InterfaceStore
from deros.monitor.ir import Leaf, Program
from deros.monitor.state import LeafValue
from deros.monitor.trace_values import DataError, MessageReader

_SECONDS = re.compile(r"\d{1,30}(\.\d{0,30})?", re.ASCII)
_NS_PER_S = 10**9
_LAST_NS = 2**63 - 1  # of ROS's time


@dataclass(frozen=True, slots=True)
class TraceMessage:
    """One message: its time, its topic, and the value of each leaf of that topic's inputs."""

    t_ns: int
    topic: str
    leaves: Mapping[int, LeafValue]


@dataclass(frozen=True, slots=True)
class Trace:
    """What a trace holds for one program, and what is wrong with it."""

    messages: tuple[TraceMessage, ...]
    diagnostics: tuple[Diagnostic, ...]


def read_trace(source: SourceFile, program: Program, store: InterfaceStore) -> Trace:
    """Read a trace for a program; messages on topics that it does not read are left out.

    Every faulty line is reported, and left out as well.
    """
    reader = _Reader(source, program, store)
    messages = tuple(reader.messages())
    return Trace(messages, tuple(reader.diagnostics))


def nanoseconds(seconds: str) -> int | None:
    """Return a time, given in seconds as a decimal number, or ``None`` for what is no such time.

    Times are not negative, not finer than a nanosecond and not beyond 64 bits, as ROS has them.
    """
    if not _SECONDS.fullmatch(seconds):
        return None
    whole, _, fraction = seconds.partition(".")
    if fraction[9:].strip("0"):
        return None
    result = int(whole) * _NS_PER_S + int(fraction[:9].ljust(9, "0"))
    return result if result <= _LAST_NS else None


class _Fault(Exception):  # noqa: N818 - it carries a finding, and is no fault of the program
    def __init__(self, diagnostic: Diagnostic) -> None:
        super().__init__(diagnostic.message)
        self.diagnostic = diagnostic


class _Reader:
    def __init__(self, source: SourceFile, program: Program, store: InterfaceStore) -> None:
        self._source = source
        self._topics = program.topics
        self._readers = {topic: MessageReader(store, kind) for topic, kind in self._topics.items()}
        self._leaves: dict[str, list[Leaf]] = {topic: [] for topic in self._topics}
        for leaf in program.leaves:
            self._leaves[program.inputs[leaf.input].topic].append(leaf)
        self._unread: set[str] = set()
        self.diagnostics: list[Diagnostic] = []

    def messages(self) -> Iterator[TraceMessage]:
        start = 0
        for line in self._source.text.split("\n"):
            if line.strip():
                span = Span(self._source, start, start + len(line.rstrip()))
                try:
                    message = self._message(line, span)
                except _Fault as fault:
                    self.diagnostics.append(fault.diagnostic)
                else:
                    if message is not None:
                        yield message
            start += len(line) + 1

    def _message(self, line: str, span: Span) -> TraceMessage | None:
        record = _record(line, span)
        t_ns = _time(record, span)
        topic = record["topic"]
        if topic not in self._topics:
            self._report_unread(topic, span)
            return None
        reader = self._readers[topic]
        try:
            message = reader.read(record.get("data", {}))
        except DataError as error:
            code = codes.UNKNOWN_TRACE_FIELD if error.unknown else codes.WRONG_TRACE_VALUE
            where = _find_last(span, error.key.rpartition(".")[2])
            raise _Fault(report(code, str(error), where, error.hint)) from error
        leaves = {leaf.index: reader.leaf(message, leaf.path) for leaf in self._leaves[topic]}
        return TraceMessage(t_ns, topic, leaves)

    def _report_unread(self, topic: str, span: Span) -> None:
        if topic in self._unread:
            return
        self._unread.add(topic)
        hint = did_you_mean(near(topic, self._topics))
        text = f"no rule reads '{topic}', so its messages are left out"
        self.diagnostics.append(report(codes.UNREAD_TRACE_TOPIC, text, _find(span, topic), hint))


def _record(line: str, span: Span) -> Mapping[str, Any]:
    try:
        record = json.loads(line, parse_float=Decimal)
    except json.JSONDecodeError as error:
        place = min(span.start + error.pos, max(span.start, span.end - 1))
        where = Span(span.source, place, min(place + 1, span.end))
        raise _Fault(report(codes.BAD_TRACE_LINE, f"no JSON: {error.msg}", where)) from error
    except (ValueError, RecursionError, ArithmeticError) as error:
        text = "the line's numbers are too long, or it is nested too deeply"
        raise _Fault(report(codes.BAD_TRACE_LINE, text, span)) from error
    if not isinstance(record, dict):
        raise _Fault(report(codes.BAD_TRACE_LINE, "the line is no object {…}", span))
    for key in ("t", "topic"):
        if key not in record:
            raise _Fault(report(codes.BAD_TRACE_LINE, f"the message lacks '{key}'", span))
    if not isinstance(record["topic"], str):
        where = _find(span, "topic")
        raise _Fault(report(codes.BAD_TRACE_LINE, "'topic' is no text", where))
    if not isinstance(record.get("data", {}), dict):
        where = _find(span, "data")
        raise _Fault(report(codes.BAD_TRACE_LINE, "'data' is no object {…}", where))
    return record


def _time(record: Mapping[str, Any], span: Span) -> int:
    given = record["t"]
    is_number = isinstance(given, int | Decimal) and not isinstance(given, bool)
    text = _plain(given) if is_number else given
    t_ns = nanoseconds(text) if isinstance(text, str) else None
    if t_ns is None:
        message = "'t' is no time: it needs seconds, as \"1.25\", not negative"
        hint = "the finest step is a nanosecond, the latest time 9223372036.854775807"
        raise _Fault(report(codes.BAD_TRACE_TIME, message, _find(span, "t"), hint))
    return t_ns


def _plain(number: int | Decimal) -> str:
    """Return a number without exponent; one far beyond any time stays as it is."""
    if isinstance(number, Decimal) and abs(number.adjusted()) < 30:
        return f"{number:f}"
    return str(number)


def _find(span: Span, text: str) -> Span:
    """Return the place of a JSON string in a line, or the whole line if it is not written so."""
    quoted = json.dumps(text, ensure_ascii=False)
    return _part(span, span.text.find(quoted), len(quoted))


def _find_last(span: Span, text: str) -> Span:
    quoted = json.dumps(text, ensure_ascii=False)
    return _part(span, span.text.rfind(quoted), len(quoted))


def _part(span: Span, place: int, length: int) -> Span:
    start = span.start + place
    return span if place < 0 else Span(span.source, start, start + length)
