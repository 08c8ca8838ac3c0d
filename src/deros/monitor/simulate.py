"""Running a monitor over a trace, without ROS and as fast as it goes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any, Protocol

from deros.monitor.engine import Event
from deros.monitor.state import LeafValue
from deros.monitor.trace import TraceMessage


class Monitor(Protocol):
    """What runs a program: the reference engine, or something generated that is driven like it."""

    def message(self, t_ns: int, topic: str, leaves: Mapping[int, LeafValue]) -> list[Event]:
        """Take a message and return what happened."""
        ...

    def advance(self, t_ns: int) -> list[Event]:
        """Settle what is due and return what happened."""
        ...


def simulate(
    monitor: Monitor, messages: Iterable[TraceMessage], until_ns: int | None = None
) -> Iterator[Event]:
    """Yield what happens when the messages come at their times.

    Args:
        monitor: what runs the rules, started at 0.
        messages: in the order in which they arrive.
        until_ns: the time up to which the clock runs on. The first message beyond it ends the run;
            ``None`` ends it with the last message.
    """
    for message in messages:
        if until_ns is not None and message.t_ns > until_ns:
            break
        yield from monitor.message(message.t_ns, message.topic, message.leaves)
    if until_ns is not None:
        yield from monitor.advance(until_ns)


def event_record(event: Event) -> dict[str, Any]:
    """Return an event as it is written in JSON; the time is exact, in seconds."""
    record: dict[str, Any] = {
        "t": seconds(event.t_ns),
        "event": event.kind,
        "action": event.action,
    }
    if event.behaviour is not None:
        record["behaviour"] = event.behaviour
    if event.kind == "trigger" and event.action == "log_state":
        record["text"] = event.arguments[0]
    elif event.arguments:
        record["arguments"] = list(event.arguments)
    if event.kind == "refused":
        record |= {"holding": list(event.holding), "unknown": list(event.unknown)}
    if event.span is not None:
        record |= {"file": event.span.file, "line": event.span.line}
    return record


def seconds(t_ns: int) -> str:
    """Return nanoseconds as seconds with all nine digits."""
    return f"{t_ns // 10**9}.{t_ns % 10**9:09d}"
