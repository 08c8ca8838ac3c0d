"""Terms of safety rules: what stands on either side of a comparison.

They are part of :mod:`deros.models.rules`, from where they are imported.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from decimal import Decimal
from typing import Literal

from deros.diagnostics import Span
from deros.models.common import Name

ArithmeticOperator = Literal["+", "-", "*", "/"]


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


@dataclass(frozen=True, slots=True)
class Call:
    """``TERM.function(arguments)``; ``toRad(10 deg)`` and ``max(a, b)`` have no ``receiver``."""

    function: Name
    receiver: Term | None
    arguments: tuple[Term, ...]
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Negative:
    """``-term``."""

    operand: Term
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Arithmetic:
    """``left + right``, and so on; operators that bind alike are applied from left to right."""

    operator: ArithmeticOperator
    left: Term
    right: Term
    span: Span = field(compare=False, repr=False)
    operator_span: Span = field(compare=False, repr=False)


Term = Number | Boolean | String | TopicPath | NamePath | Call | Negative | Arithmetic
