"""A timeline: what comes at which time, and what must happen then."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

from deros.diagnostics import Span
from deros.interfaces.durations import NS_PER_S
from deros.interfaces.fields import FieldPath

Happening = tuple[int, str, str]
"""When, of which action, what: ``trigger``, ``reset`` or ``refused``."""


class Moment(NamedTuple):
    """A time on a clock that may step back: how often it has done so before, and its time."""

    steps: int
    t_ns: int


@dataclass(frozen=True, slots=True)
class Entry:
    """A line of a trace, as JSON, and the row that it is written in."""

    moment: Moment
    text: str
    span: Span


@dataclass(frozen=True, slots=True)
class Effect:
    """What a row expects of an action: ``trigger``, ``reset`` or ``refused``."""

    moment: Moment
    action: str
    kind: str
    span: Span

    @property
    def happening(self) -> Happening:
        """The same as events have it."""
        return self.moment.t_ns, self.action, self.kind


@dataclass(frozen=True, slots=True)
class Command:
    """What a row expects of a gate.

    Attributes:
        moment: when.
        gate: the topic that the gate publishes.
        event: what it does, as :class:`~deros.simulation.gate_simulation.GateAnswer` has it; or
            empty, and the last command that it published has a ``value`` in the field ``path``.
        path: of a field.
        value: of the field.
        span: the place.
    """

    moment: Moment
    gate: str
    event: str
    path: FieldPath
    value: Any
    span: Span


@dataclass(frozen=True)
class Timeline:
    """What comes, and what must happen.

    Attributes:
        name: the heading, and the label of the table if it has one.
        why: the prose at the table.
        span: of the label, or of the heading.
        entries: the trace, in the order in which it is played.
        effects: all that happens to actions, in order.
        commands: what some rows expect of gates.
        until: the end, when the clock stops.
    """

    name: str
    why: str
    span: Span
    entries: tuple[Entry, ...]
    effects: tuple[Effect, ...]
    commands: tuple[Command, ...]
    until: Moment

    @property
    def trace(self) -> tuple[str, ...]:
        """The lines of the trace."""
        return tuple(each.text for each in self.entries)


def decimal(t_ns: int) -> str:
    """Return a time in seconds, with the digits that count."""
    whole, rest = divmod(t_ns, NS_PER_S)
    return f"{whole}.{rest:09}".rstrip("0").rstrip(".")
