"""The terms of safety rules that have no others inside them.

They are part of :mod:`deros.models.rules`, from where they are imported.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from decimal import Decimal

from deros.diagnostics import Span
from deros.models.common import Name


@dataclass(frozen=True, slots=True)
class Number:
    """A number as written, exactly, with its unit if one follows (``0.5 m/s``)."""

    value: Decimal
    span: Span = field(compare=False, repr=False)
    unit: str | None = None
    unit_span: Span | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Boolean:
    """``true`` or ``false``."""

    value: bool
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class String:
    """A quoted text, escapes already replaced."""

    value: str
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class TopicPath:
    """``topic /imu.orientation``, or the same without the keyword inside a rule.

    ``path`` holds field names and array indices: ``position[2]`` is ``("position", 2)``.
    """

    topic: Name
    path: tuple[str | int, ...]
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class NamePath:
    """A name with a path: an input, a constant, a message constant, or a field of an input."""

    name: Name
    path: tuple[str | int, ...]
    span: Span = field(compare=False, repr=False)
