"""Traces: the messages of a robot, one JSON object per line, for simulation and tests.

A message is ``{"t": "1.5", "topic": "/imu", "data": {"angular_velocity.z": 0.2}}``: the time in
seconds, read exactly, as text or as a number; the topic; and the fields that matter, nested or
dotted, array elements as ``position[2]``. All other fields have the defaults of the message
definition. ``NaN``, ``Infinity`` and ``-Infinity`` may be written as texts. ``"publishers": 2``
beside ``data`` tells how many publishers the topic has then; without it there is one. Empty lines
are skipped. Times count from the start of the run, or from 1970 where the first one does.

Other lines have, in place of ``topic``: ``"reset": true`` (of the latched actions) or ``"reset":
"/cmd_vel"`` (of the gate to that topic), ``"enable": "NAME"`` or ``"disable": "NAME"`` (of an
optional behaviour), ``"heartbeat": false`` or ``true`` (whether the gates hear the safety node).
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from typing import Any

from deros import codes
from deros.diagnostics import Diagnostic, SourceFile, Span, report
from deros.interfaces.durations import LONGEST_NS, NS_PER_S
from deros.interfaces.fields import FieldPath
from deros.interfaces.store import InterfaceStore
from deros.names.names import did_you_mean, near
from deros.names.topic_likeness import likely_topics
from deros.rules.engine.state import LeafValue
from deros.rules.program import walk
from deros.rules.program.commands import Message
from deros.rules.program.ir import PUBLISHER, RECEIPT, Leaf, Program
from deros.simulation.trace_values import DataError, MessageReader

_UNIX_NS = 10**9 * NS_PER_S  # the year 2001, and longer than any run
_SECONDS = re.compile(r"\d{1,30}(\.\d{0,30})?", re.ASCII)
_KINDS = ("topic", "reset", "enable", "disable", "heartbeat")


@dataclass(frozen=True, slots=True)
class TraceMessage:
    """One message: its time, its topic, and the value of each leaf of that topic's inputs.

    ``command`` is the whole message, on a topic that a gate reads commands or limits from;
    ``is_input`` tells whether the rules read it, too.
    """

    t_ns: int
    topic: str
    leaves: Mapping[int, LeafValue]
    command: Message | None = None
    is_input: bool = True


@dataclass(frozen=True, slots=True)
class TraceReset:
    """A reset of the latched actions or, with its target topic, of a ``gate``."""

    t_ns: int
    gate: str | None = None


@dataclass(frozen=True, slots=True)
class TraceSwitch:
    """An optional behaviour is enabled, or disabled."""

    t_ns: int
    behaviour: str
    enabled: bool


@dataclass(frozen=True, slots=True)
class TraceHeartbeat:
    """The gates receive the safety node's states and heartbeat from now on, or do not."""

    t_ns: int
    heard: bool


@dataclass(frozen=True, slots=True)
class TraceTime:
    """The clock shows a time, and nothing else happens; no line of a trace says so."""

    t_ns: int


TraceLine = TraceMessage | TraceReset | TraceSwitch | TraceHeartbeat | TraceTime
"""What a line of a trace stands for."""


@dataclass(frozen=True, slots=True)
class Trace:
    """The contents of a trace for one program, and its faults."""

    lines: tuple[TraceLine, ...]
    diagnostics: tuple[Diagnostic, ...]

    @property
    def messages(self) -> tuple[TraceMessage, ...]:
        """The lines that are messages."""
        return tuple(each for each in self.lines if isinstance(each, TraceMessage))


def read_trace(source: SourceFile, program: Program, store: InterfaceStore) -> Trace:
    """Read a trace for a program; messages on topics that it does not read are left out.

    Every faulty line is reported, and left out as well.
    """
    reader = _Reader(source, program, store)
    lines = tuple(reader.lines())
    return Trace(lines, tuple(reader.diagnostics))


def nanoseconds(seconds: str) -> int | None:
    """Return a time, given in seconds as a decimal number, or ``None`` if it is not valid.

    Times are not negative, not finer than a nanosecond and not beyond 64 bits, as ROS has them.
    """
    if not _SECONDS.fullmatch(seconds):
        return None
    whole, _, fraction = seconds.partition(".")
    if fraction[9:].strip("0"):
        return None
    result = int(whole) * NS_PER_S + int(fraction[:9].ljust(9, "0"))
    return result if result <= LONGEST_NS else None


def start_of(lines: Sequence[TraceLine]) -> int:
    """Return the time at which a run over lines starts: 0, or the first one if it is Unix time."""
    return lines[0].t_ns if lines and lines[0].t_ns >= _UNIX_NS else 0


class _Fault(Exception):  # noqa: N818 - it carries a finding, and is no fault of the program
    def __init__(self, diagnostic: Diagnostic) -> None:
        super().__init__(diagnostic.message)
        self.diagnostic = diagnostic


class _Reader:
    def __init__(self, source: SourceFile, program: Program, store: InterfaceStore) -> None:
        self._source = source
        self._program = program
        self._commands = {topic: each.type for each in program.gates for topic in each.topics}
        for gate in program.gates:
            self._commands |= gate.input_types
        self._topics = self._commands | program.topics
        self._readers = {topic: MessageReader(store, kind) for topic, kind in self._topics.items()}
        self._leaves: dict[str, list[Leaf]] = {topic: [] for topic in self._topics}
        for leaf in program.leaves:
            self._leaves[program.inputs[leaf.input].topic].append(leaf)
        self._unread: set[str] = set()
        self.diagnostics: list[Diagnostic] = []

    def lines(self) -> Iterator[TraceLine]:
        start = 0
        for text in self._source.text.split("\n"):
            if text.strip():
                span = Span(self._source, start, start + len(text.rstrip()))
                try:
                    line = self._line(text, span)
                except _Fault as fault:
                    self.diagnostics.append(fault.diagnostic)
                else:
                    if line is not None:
                        yield line
            start += len(text) + 1

    def _line(self, text: str, span: Span) -> TraceLine | None:
        record = _record(text, span)
        t_ns = _time(record, span)
        match _kind(record, span):
            case "reset":
                return TraceReset(t_ns, self._reset(record["reset"], span))
            case "enable" | "disable" as kind:
                behaviour = self._optional(kind, record[kind], span)
                return TraceSwitch(t_ns, behaviour, kind == "enable")
            case "heartbeat":
                return TraceHeartbeat(t_ns, self._heard(record["heartbeat"], span))
            case _:
                return self._message(record, t_ns, span)

    def _message(self, record: Mapping[str, Any], t_ns: int, span: Span) -> TraceMessage | None:
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
        beside: dict[FieldPath, LeafValue] = {
            RECEIPT: t_ns,
            PUBLISHER: _has_one_publisher(record, span) or None,
        }
        leaves = {
            leaf.index: beside[leaf.path]
            if leaf.path in beside
            else reader.leaf(message, leaf.path)
            for leaf in self._leaves[topic]
        }
        command = reader.whole(message) if topic in self._commands else None
        return TraceMessage(t_ns, topic, leaves, command, topic in self._program.topics)

    def _reset(self, given: Any, span: Span) -> str | None:
        """Return the gate that is reset; ``None`` is the safety node."""
        if given is True:
            if not any(each.latched for each in self._program.actions):
                raise _fault("no action is 'latched', so there is nothing to reset", "reset", span)
            return None
        gates = {each.target: each for each in self._program.gates}
        if not isinstance(given, str):
            hint = "true resets the latched actions, the target topic of a gate that gate"
            raise _fault("'reset' is true or a text", "reset", span, hint)
        if given not in gates:
            hint = did_you_mean(near(given, gates)) or _listed("gates lead to", gates)
            raise _fault(f"no gate leads to '{given}'", given, span, hint)
        if not gates[given].is_latching:
            text = f"the gate to '{given}' has no line 'until reset', so there is nothing to reset"
            raise _fault(text, given, span)
        return given

    def _optional(self, kind: str, given: Any, span: Span) -> str:
        everyone = {each.name: each.optional for each in walk.behaviours(self._program)}
        if not isinstance(given, str):
            raise _fault(f"'{kind}' is the name of an optional behaviour", kind, span)
        if given not in everyone:
            optional = [name for name, is_optional in everyone.items() if is_optional]
            hint = did_you_mean(near(given, everyone)) or _listed("optional are", optional)
            raise _fault(f"no behaviour '{given}'", given, span, hint)
        if not everyone[given]:
            hint = f"write 'optional behaviour {given}: if ...' in the rules"
            raise _fault(f"the behaviour '{given}' is not optional", given, span, hint)
        return given

    def _heard(self, given: Any, span: Span) -> bool:
        if not isinstance(given, bool):
            hint = "false: from now on the gates do not hear the safety node; true: they do again"
            raise _fault("'heartbeat' is true or false", "heartbeat", span, hint)
        if not self._program.gates:
            raise _fault("the rules have no gate that hears the heartbeat", "heartbeat", span)
        return given

    def _report_unread(self, topic: str, span: Span) -> None:
        if topic in self._unread:
            return
        self._unread.add(topic)
        hint = did_you_mean(likely_topics(topic, self._topics))
        text = f"no rule reads '{topic}', so its messages are left out"
        self.diagnostics.append(report(codes.UNREAD_TRACE_TOPIC, text, _find(span, topic), hint))


def _fault(text: str, key: str, span: Span, hint: str = "") -> _Fault:
    return _Fault(report(codes.BAD_TRACE_LINE, text, _find_last(span, key), hint))


def _listed(what: str, names: Iterable[str]) -> str:
    listed = ", ".join(names)
    return f"{what} {listed}" if listed else ""


def _kind(record: Mapping[str, Any], span: Span) -> str:
    """Return the kind of a line, by the key that only such lines have."""
    kinds = [each for each in _KINDS if each in record]
    if len(kinds) > 1:
        text = f"one line has both '{kinds[0]}' and '{kinds[1]}'"
        raise _fault(text, kinds[1], span, "write two lines, with the same time")
    return kinds[0]


def _has_one_publisher(record: Mapping[str, Any], span: Span) -> bool:
    """Return whether a topic has one publisher while its message arrives, as where none is told."""
    count = record.get("publishers", 1)
    if not isinstance(count, int) or isinstance(count, bool) or count < 1:
        raise _fault("'publishers' is how many the topic has, 1 or more", "publishers", span)
    return count == 1


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
    if "t" not in record:
        raise _Fault(report(codes.BAD_TRACE_LINE, "the line lacks 't'", span))
    if not any(each in record for each in _KINDS):
        hint = did_you_mean(key for each in record for key in near(each, _KINDS))
        text = "the line lacks 'topic', and is no 'reset', 'enable', 'disable' or 'heartbeat'"
        raise _Fault(report(codes.BAD_TRACE_LINE, text, span, hint))
    known = ("t", "topic", "data", "publishers") if "topic" in record else ("t", *_KINDS)
    for key in record:
        if key not in known and key not in _KINDS:
            hint = 'its fields stand in \'data\': {"t": …, "topic": …, "data": {…}}'
            text = f"a line has no '{key}'"
            raise _fault(text, key, span, hint if "topic" in record else "")
    if not isinstance(record.get("topic", ""), str):
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
