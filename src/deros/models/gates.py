"""The gates of rules, as written."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from deros.diagnostics import Span
from deros.interfaces.fields import FieldPath
from deros.interfaces.types import InterfaceType
from deros.models.common import Name
from deros.models.terms import Number, Term


@dataclass(frozen=True, slots=True)
class GateLimit:
    """``linear.x to [-0.1, 0.1] m/s``: a field of the command and the interval it is kept in.

    ``unit`` follows the interval and is that of both ends; an end may have its own instead.
    """

    path: FieldPath
    lower: Term
    upper: Term
    lower_closed: bool
    upper_closed: bool
    span: Span = field(compare=False, repr=False)
    path_span: Span = field(compare=False, repr=False)
    interval_span: Span = field(compare=False, repr=False)
    unit: str | None = None
    unit_span: Span | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class StopField:
    """``linear.x 1 m/s2``, a ramp, or ``data = false``, which is sent; none empties an array."""

    path: FieldPath
    value: Term | None
    span: Span = field(compare=False, repr=False)
    path_span: Span = field(compare=False, repr=False)


StopKind = Literal["zero", "send", "hold", "silence"]


@dataclass(frozen=True, slots=True)
class GateStop:
    """What a gate publishes to stop: zeros, along ``ramps``, what ``sent`` says, or the like."""

    kind: StopKind
    span: Span = field(compare=False, repr=False)
    ramps: tuple[StopField, ...] = ()
    sent: tuple[StopField, ...] = ()


@dataclass(frozen=True, slots=True)
class GateLine:
    """One line of a gate: its condition, and its effect on the command.

    It applies while ``action`` is active or, without one, when what ``lost`` names has been silent
    for ``duration``; without either it is a standing one, which always applies. It has either a
    ``stop`` or ``limits``, or it has the gate ``wait`` while the action is active. ``until_reset``:
    the stop lasts until a reset of the gate, however long the line applies.
    """

    action: Name | None
    lost: Literal["heartbeat", "input"] | None
    duration: Number | None
    limits: tuple[GateLimit, ...]
    span: Span = field(compare=False, repr=False)
    until_reset: bool = False
    stop: GateStop | None = None
    wait: Number | None = None

    @property
    def is_standing(self) -> bool:
        """Whether it always applies."""
        return self.action is None and self.lost is None


@dataclass(frozen=True, slots=True)
class GateSource:
    """``/joy for 0.5 sec from zero``: a topic of commands, and how long the last one counts."""

    topic: Name
    duration: Number | None = None
    from_zero: bool = False


@dataclass(frozen=True, slots=True)
class Gate:
    """``gate SOURCE over SOURCE -> TARGET : TYPE rate R { … }``: a filter for commands.

    Earlier sources take precedence. ``resume`` is where ``resume on zero command`` stands, if it
    does.
    """

    sources: tuple[GateSource, ...]
    target: Name
    type: InterfaceType
    rate: Number
    lines: tuple[GateLine, ...]
    span: Span = field(compare=False, repr=False)
    type_span: Span = field(compare=False, repr=False)
    description: str = ""
    resume: Span | None = field(default=None, repr=False)
