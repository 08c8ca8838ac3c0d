"""The table of a gate: all that distinguishes it from others, but for the type of its commands."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal

Limit = tuple[float, float]  # the least and the greatest value


@dataclass(frozen=True)
class Bound:
    """
    An end of a limit that messages, or a parameter, give.

    It is the number of an input of the table, or of a parameter, times factor: in the unit of the
    field, and as the field's type holds it. An unknown number stands for 0. text is for readers.
    """

    text: str
    number: int | None = None
    parameter: str = ''
    factor: float = 1.0
    kind: str = 'float64'


OpenLimit = tuple[float | Bound, float | Bound]


@dataclass(frozen=True)
class Stop:
    """
    What a gate publishes while it stops.

    ramps are the rates at which fields go to zero, in their units per second; sends holds the
    fields that are not zero, for the reader: the functions for commands set them.
    """

    what: Literal['zero', 'send', 'hold', 'silence']
    ramps: Mapping[str, float] = field(default_factory=dict)
    sends: Mapping[str, object] = field(default_factory=dict)


ZERO, HOLD, SILENCE = Stop('zero'), Stop('hold'), Stop('silence')


@dataclass(frozen=True)
class Line:
    """
    One line of a gate: when it applies, and what it does to the command then.

    Either action is the name of an action, or lost says what has to be silent for lost_ns; without
    either, the line stands: its limits always apply. Either the line has a stop, perhaps
    until_reset, or limits holds intervals by the names of fields, or what moves waits for wait_ns
    of the action. bounds holds those intervals of a standing line that have ends from elsewhere.
    text is the line as it is reported, with its place; is_severe makes the report an error.
    """

    text: str
    action: str = ''
    lost: Literal['', 'heartbeat', 'input'] = ''
    lost_ns: int = 0
    stop: Stop | None = None
    until_reset: bool = False
    wait_ns: int = 0
    limits: Mapping[str, Limit] = field(default_factory=dict)
    is_severe: bool = False
    bounds: Mapping[str, OpenLimit] = field(default_factory=dict)

    @property
    def is_standing(self) -> bool:
        """Return whether it always applies."""
        return not (self.action or self.lost)


@dataclass(frozen=True)
class Source:
    """
    A topic whose commands pass while the last one is younger than silent_ns.

    from_zero: each time it takes over, its commands pass from the first one that is zero.
    """

    topic: str
    silent_ns: int
    from_zero: bool = False


@dataclass(frozen=True)
class Input:
    """
    A number that messages hold, for bounds.

    It is unknown before the first message that holds one, silent_ns after the last such message
    (0: never), and as soon as a message holds NaN instead, or is unreadable.
    """

    name: str
    silent_ns: int


@dataclass(frozen=True)
class Table:
    """
    All that distinguishes a gate from others, but for the type of its commands.

    actions are those that the lines name, and fields those with limits or ramps; period_ns is the
    time between two messages while the gate stops. sources are those with a time of their own: a
    single one needs none, as the lines about the lost input have it. Earlier lines, and sources,
    take precedence. inputs are those that bounds name.
    """

    lines: tuple[Line, ...]
    actions: tuple[str, ...]
    fields: tuple[str, ...]
    period_ns: int
    resume_on_zero: bool = False
    sources: tuple[Source, ...] = ()
    inputs: tuple[Input, ...] = ()

    @cached_property
    def latching(self) -> tuple[int, ...]:
        """Return the numbers of the lines that stop until a reset."""
        return tuple(number for number, line in enumerate(self.lines) if line.until_reset)

    @cached_property
    def waiting(self) -> tuple[int, ...]:
        """Return the numbers of the lines that wait before moving."""
        return tuple(number for number, line in enumerate(self.lines) if line.wait_ns)

    @cached_property
    def awaited(self) -> frozenset[str]:
        """Return the actions that those lines wait for."""
        return frozenset(self.lines[number].action for number in self.waiting)

    @cached_property
    def waits_for_zero(self) -> bool:
        """Return whether the gate may wait for a zero command."""
        return self.resume_on_zero or any(source.from_zero for source in self.sources)

    @cached_property
    def reports(self) -> tuple[str, ...]:
        """Return the texts of Gate.applying."""
        waits = ('waits for a zero command',) if self.waits_for_zero else ()
        return (
            *(line.text for line in self.lines),
            *(f'waits for a reset, after {self.lines[number].text}' for number in self.latching),
            *waits,
            *(f'input {each.name} is unknown, so its bounds are 0' for each in self.inputs),
        )
