"""The timelines: rules, a trace, and what must happen, worked out by hand."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from deros.diagnostics import SourceFile
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.metamodels.rules import Rules
from deros.monitor.build import build
from deros.monitor.engine import Event
from deros.monitor.ir import Program
from deros.monitor.trace import TraceMessage, nanoseconds, read_trace

DIRECTORY = Path(__file__).resolve().parents[1] / "data" / "timelines"
Happening = tuple[int, str, str]
"""When, of which action, what: ``trigger``, ``reset`` or ``refused``."""


@dataclass(frozen=True)
class Timeline:
    """One case. ``trace`` holds JSON texts, one a message."""

    name: str
    why: str
    rules: str
    trace: tuple[str, ...]
    until: str
    expect: tuple[Happening, ...]

    @property
    def until_ns(self) -> int:
        """The time up to which the clock runs on."""
        return _ns(self.until)

    def program(self) -> Program:
        """Load and build the rules."""
        return program(self.rules, self.name)

    def messages(self, program: Program) -> tuple[TraceMessage, ...]:
        """Read the trace, which must be faultless."""
        return messages(program, *self.trace)


def program(rules: str, name: str = "rules") -> Program:
    """Load and build rules on the system of the timelines; they must be faultless."""
    repository = Repository()
    model = repository.load_text(DIRECTORY / f"{name}.deros", rules).model
    assert isinstance(model, Rules), repository.diagnostics
    result = build(model, InterfaceStore())
    assert result.program is not None, result.diagnostics
    return result.program


def messages(program: Program, *lines: str) -> tuple[TraceMessage, ...]:
    """Read the lines of a trace, which must be faultless."""
    trace = read_trace(SourceFile("trace", "\n".join(lines)), program, InterfaceStore())
    assert not trace.diagnostics, trace.diagnostics
    return trace.messages


def happenings(events: list[Event]) -> tuple[Happening, ...]:
    """Return events as timelines list them, without steps of the clock."""
    return tuple((e.t_ns, e.action, e.kind) for e in events if e.kind != "clock_step")


def load(file: str) -> list[Timeline]:
    """Return the timelines of a file; those of ``timelines.json`` are the given ones."""
    return [_timeline(each) for each in json.loads((DIRECTORY / file).read_text())]


def _timeline(case: dict[str, Any]) -> Timeline:
    return Timeline(
        case["name"],
        case["why"],
        case["rules"],
        tuple(json.dumps(message) for message in case["trace"]),
        case["until"],
        tuple((_ns(each["t"]), each["action"], each["event"]) for each in case["expect"]),
    )


def _ns(seconds: str) -> int:
    t_ns = nanoseconds(seconds)
    assert t_ns is not None
    return t_ns


GIVEN = load("timelines.json")
ALL = [
    *GIVEN,
    *(
        each
        for file in ("more", "named_rules", "since", "within", "arithmetic", "previous")
        for each in load(f"{file}.json")
    ),
]
