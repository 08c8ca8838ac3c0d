"""Classes that the typed models of all languages share."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

from deros.diagnostics import Span

Scalar = bool | int | float | str
Value = Scalar | tuple[Scalar, ...]
"""A parameter's value: a scalar or, for array parameters, a tuple of scalars."""


@dataclass(frozen=True, slots=True)
class Name:
    """A name as written, with its place."""

    text: str
    span: Span = field(compare=False, repr=False)

    def __str__(self) -> str:
        """Return the name alone."""
        return self.text


@dataclass(frozen=True, slots=True)
class Interval:
    """A range of numbers, each end closed or open."""

    lower: float
    upper: float
    lower_closed: bool = True
    upper_closed: bool = True

    def __contains__(self, value: float) -> bool:
        """Return whether ``value`` lies within."""
        above = value >= self.lower if self.lower_closed else value > self.lower
        below = value <= self.upper if self.upper_closed else value < self.upper
        return above and below

    @property
    def is_empty(self) -> bool:
        """Whether no number lies within."""
        return self.lower > self.upper or (
            self.lower == self.upper and not (self.lower_closed and self.upper_closed)
        )

    @property
    def one_sided(self) -> bool:
        """Whether one of its ends is infinite."""
        return math.isinf(self.lower) or math.isinf(self.upper)

    def spelled(self, bound: Callable[[float], str] = repr) -> str:
        """Return the interval in the notation of the languages, ``[0.1, 2.0)`` or ``>= 0.1``."""
        if math.isinf(self.upper):
            return f"{'>=' if self.lower_closed else '>'} {bound(self.lower)}"
        if math.isinf(self.lower):
            return f"{'<=' if self.upper_closed else '<'} {bound(self.upper)}"
        opening = "[" if self.lower_closed else "("
        closing = "]" if self.upper_closed else ")"
        return f"{opening}{bound(self.lower)}, {bound(self.upper)}{closing}"

    def clause(self, bound: Callable[[float], str] = repr) -> str:
        """Return the interval as a clause of a description, ``in [0.1, 2.0)`` or ``>= 0.1``."""
        return f"{'' if self.one_sided else 'in '}{self.spelled(bound)}"


@dataclass(frozen=True, slots=True)
class QosProfile:
    """The QoS policies that a model states; ``None`` leaves a policy to the preset or the default.

    Durations are nanoseconds. Source: ROS 2 design, "About Quality of Service settings".
    """

    preset: str | None = None  # sensor_data, services, parameters, system_default
    reliability: str | None = None  # reliable, best_effort
    durability: str | None = None  # volatile, transient_local
    depth: int | None = None
    keep_all: bool = False
    deadline_ns: int | None = None
    lifespan_ns: int | None = None
    liveliness: str | None = None  # automatic, manual_by_topic
    lease_ns: int | None = None
    span: Span | None = field(default=None, compare=False, repr=False)
