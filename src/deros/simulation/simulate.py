"""Runs a monitor over a trace, without ROS and as fast as possible."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import takewhile
from pathlib import PurePath
from typing import Any, Protocol

from deros.diagnostics import Span
from deros.interfaces.durations import NS_PER_S
from deros.rules.engine.engine import Event
from deros.rules.engine.explain import Explanation
from deros.rules.engine.state import LeafValue
from deros.simulation.gate_simulation import AnswerKind, GateAnswer, GateSimulation
from deros.simulation.trace import (
    TraceHeartbeat,
    TraceLine,
    TraceMessage,
    TraceReset,
    TraceSwitch,
    TraceTime,
)


class Monitor(Protocol):
    """The interface of a monitor: the reference engine, or a generated monitor."""

    events: list[Event]

    @property
    def next_deadline(self) -> int | None:
        """When to call :meth:`advance` at the latest."""
        ...

    @property
    def waiting(self) -> bool:
        """Whether an input with a timeout waits for its first message and is not missing yet."""
        ...

    def message(self, t_ns: int, topic: str, leaves: Mapping[int, LeafValue]) -> list[Event]:
        """Process a message and return the events."""
        ...

    def advance(self, t_ns: int) -> list[Event]:
        """Process what is due and return the events."""
        ...

    def reset(self, t_ns: int) -> bool:
        """Reset every latched action that is active, unless a condition refuses it."""
        ...

    def enable(self, t_ns: int, behaviour: str, enabled: bool) -> list[Event]:
        """Enable or disable an optional behaviour and return the events."""
        ...

    def explain(self) -> Explanation:
        """Return the verdict of each rule as of the last event, and why each behaviour holds."""
        ...


@dataclass(frozen=True, slots=True)
class Explained:
    """An event, and the causes of the behaviours that it names, if there are some."""

    event: Event
    causes: Mapping[str, str] = field(default_factory=dict)


def simulate(
    monitor: Monitor, lines: Iterable[TraceLine], until_ns: int | None = None
) -> Iterator[Event]:
    """Yield the events when the lines of a trace arrive at their times.

    Args:
        monitor: what runs the rules, started at :func:`deros.simulation.trace.start_of` the lines.
        lines: in the order in which they happen.
        until_ns: the time up to which the clock runs on. The first line beyond it ends the run;
            ``None`` ends it with the last line.
    """
    for each in play(monitor, lines, until_ns):
        if isinstance(each, Explained):
            yield each.event


def play(
    monitor: Monitor,
    lines: Iterable[TraceLine],
    until_ns: int | None = None,
    gates: GateSimulation | None = None,
) -> Iterator[Explained | GateAnswer]:
    """Yield the events of :func:`simulate` with their causes, and those of the gates."""
    yield from play_all(monitor, played(lines, until_ns), until_ns, gates)


def play_all(
    monitor: Monitor,
    lines: Iterable[TraceLine],
    until_ns: int | None,
    gates: GateSimulation | None = None,
) -> Iterator[Explained | GateAnswer]:
    """Yield what happens when all lines arrive, and the clock runs on after them."""
    player = _Player(monitor, gates)
    for line in lines:
        yield from player.run_to(line.t_ns)
        yield from player.take(line)
    if until_ns is not None:
        yield from player.run_to(until_ns)


def played(lines: Iterable[TraceLine], until_ns: int | None = None) -> Iterator[TraceLine]:
    """Yield the lines of a trace that :func:`simulate` plays: those before the first beyond."""
    return takewhile(lambda line: until_ns is None or line.t_ns <= until_ns, lines)


class _Player:
    """Processes one point in time after the other, so that each is explained by the state then."""

    def __init__(self, monitor: Monitor, gates: GateSimulation | None) -> None:
        self._monitor = monitor
        self._gates = gates
        self._now_ns = 0

    def run_to(self, t_ns: int) -> Iterator[Explained | GateAnswer]:
        if t_ns < self._now_ns:
            yield from self._after(t_ns, self._monitor.advance(t_ns))
        while (due_ns := self._next_ns()) is not None and due_ns <= t_ns:
            yield from self._after(due_ns, self._monitor.advance(due_ns))
        yield from self._after(t_ns, self._monitor.advance(t_ns))

    def take(self, line: TraceLine) -> Iterator[Explained | GateAnswer]:
        monitor, gates, t_ns = self._monitor, self._gates, line.t_ns
        match line:
            case TraceMessage():
                # A gate is faster than the safety node's verdict on the command that it passes.
                if gates is not None and line.command is not None:
                    yield from gates.command(t_ns, line.topic, line.command)
                if line.is_input:
                    yield from self._after(t_ns, monitor.message(t_ns, line.topic, line.leaves))
            case TraceReset(gate=str(gate)):
                if gates is not None:
                    yield from gates.reset(t_ns, gate)
            case TraceReset():
                before = len(monitor.events)
                monitor.reset(t_ns)
                yield from self._after(t_ns, monitor.events[before:])
            case TraceSwitch():
                events = monitor.enable(t_ns, line.behaviour, line.enabled)
                yield from self._after(t_ns, events)
            case TraceHeartbeat():
                if gates is not None:
                    gates.heard = line.heard
            case TraceTime():
                pass

    def _next_ns(self) -> int | None:
        """Return the next time at which something happens without a message, if there is one."""
        found = [self._monitor.next_deadline, self._gates.next_ns if self._gates else None]
        return min((each for each in found if each is not None), default=None)

    def _after(self, t_ns: int, events: Sequence[Event]) -> Iterator[Explained | GateAnswer]:
        """Tell of an instant of the monitor, and have the gates hear of it."""
        stepped = t_ns < self._now_ns
        self._now_ns = t_ns
        if events:
            causes = self._monitor.explain().causes
            for event in events:
                names = (event.behaviour or "", *event.holding, *event.unknown, *event.coming)
                told = {name: "; ".join(causes[name]) for name in names if name in causes}
                yield Explained(event, told)
        if self._gates is not None:
            yield from self._gates.settle(t_ns, events, self._monitor.waiting, stepped)


# Records ------------------------------------------------------------------------------------------


def event_record(event: Event, causes: Mapping[str, str] | None = None) -> dict[str, Any]:
    """Return an event as a JSON record; the time is exact, in seconds.

    ``causes`` are those of the behaviours that it names.
    """
    record: dict[str, Any] = {
        "t": seconds(event.t_ns),
        "event": event.kind,
        "action": event.action,
    }
    causes = causes or {}
    if event.behaviour is not None:
        record["behaviour"] = event.behaviour
        if event.behaviour in causes:
            record["cause"] = causes[event.behaviour]
    if event.kind == "trigger" and event.action == "log_state":
        record["text"] = event.arguments[0]
    elif event.arguments:
        record["arguments"] = list(event.arguments)
    if event.kind == "refused":
        record |= {"holding": list(event.holding), "unknown": list(event.unknown)}
        record |= {"coming": list(event.coming)}
        if causes:
            record["causes"] = dict(causes)
    if event.span is not None:
        record |= {"file": event.span.file, "line": event.span.line}
    return record


def event_line(event: Event, causes: Mapping[str, str]) -> str:
    """Return an event as one line of text."""
    if event.kind == "reset":
        text = f"{event.action} is reset"
    elif event.kind == "refused":
        holding = [_because(name, causes) for name in event.holding]
        reasons = [f"called for by {', '.join(holding)}"] if holding else []
        if event.coming:
            coming = [_because(name, causes) for name in event.coming]
            reasons.append(f"on its way: {', '.join(coming)}")
        if event.unknown:
            unknown = [
                f"{each} ({causes[each]})" if each in causes else each for each in event.unknown
            ]
            reasons.append(f"not known to be false: {', '.join(unknown)}")
        text = f"{event.action} stays active, {'; '.join(reasons)}"
    else:
        what = event.arguments[0] if event.action == "log_state" else event.action
        place = f" ({file_label(event.span)}:{event.span.line})" if event.span else ""
        text = f"{what}, by {_because(event.behaviour or '', causes, place)}"
    return f"{seconds(event.t_ns)} {text}"


def answer_record(answer: GateAnswer) -> dict[str, Any]:
    """Return an event of a gate as a JSON record."""
    record: dict[str, Any] = {"t": seconds(answer.t_ns), "event": answer.event}
    record |= {"gate": answer.gate, "why": list(answer.why)}
    if answer.message is not None:
        record["data"] = answer.message
    return record


def answer_line(answer: GateAnswer) -> str:
    """Return an event of a gate as one line of text."""
    why = f", {'; '.join(answer.why)}" if answer.why else ""
    return f"{seconds(answer.t_ns)} {answer.gate}: {_SHOWN[answer.event]}{why}"


_SHOWN: dict[AnswerKind, str] = {
    "passed": "commands pass",
    "limited": "commands are limited",
    "zero": "zero",
    "sent": "sends",
    "held": "holds",
    "command_refused": "a command is refused",
    "gate_reset": "is reset",
    "gate_reset_refused": "reset refused",
}


def _because(behaviour: str, causes: Mapping[str, str], place: str = "") -> str:
    return f"{behaviour}{place}" + (f": {causes[behaviour]}" if behaviour in causes else "")


def file_label(span: Span) -> str:
    """Return the name of a span's file, without its folder."""
    return PurePath(span.file).name


def seconds(t_ns: int) -> str:
    """Return nanoseconds as seconds with all nine digits."""
    return f"{t_ns // NS_PER_S}.{t_ns % NS_PER_S:09d}"
