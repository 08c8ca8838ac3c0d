"""The conditions of rules, and the terms that they compare, as written."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from decimal import Decimal
from typing import Literal

from deros.diagnostics import Span
from deros.interfaces.fields import FieldPath
from deros.models.common import Name

ArithmeticOperator = Literal["+", "-", "*", "/"]
ComparisonOperator = Literal["=", "!=", "<", "<=", ">", ">="]
EntriesWord = Literal["any", "all", "count"]


# Terms ------------------------------------------------------------------------------------------


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

    ``path`` holds field names, and indices and keys of arrays: ``position[2]`` is ``("position",
    2)``.
    """

    topic: Name
    path: FieldPath
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class NamePath:
    """A name with a path: an input, a constant, a message constant, or a field of an input."""

    name: Name
    path: FieldPath
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


@dataclass(frozen=True, slots=True)
class Entries:
    """``any(condition)``, ``all(condition)`` or ``count(condition)`` of the entries of arrays.

    In the condition, the name of an array stands for each of its entries.
    """

    word: EntriesWord
    condition: Condition
    span: Span = field(compare=False, repr=False)


Term = Number | Boolean | String | TopicPath | NamePath | Call | Negative | Arithmetic | Entries


# Conditions -------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Membership:
    """``operand [not] in`` an interval, each end closed or open."""

    operand: Term
    negated: bool
    lower: Term
    upper: Term
    lower_closed: bool
    upper_closed: bool
    span: Span = field(compare=False, repr=False)
    interval_span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Comparison:
    """``left OP right``; ``==`` reads as ``=``."""

    left: Term
    operator: ComparisonOperator
    right: Term
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Truth:
    """A term that stands alone as a condition: a boolean field, ``missing()``, ``unknown()``.

    In the condition of a behaviour, ``entity.rule`` is such a term too: a :class:`NamePath`.
    """

    operand: Term
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Not:
    """``not`` a condition."""

    operand: Condition
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class And:
    """All of two or more conditions."""

    operands: tuple[Condition, ...]
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Or:
    """Any of two or more conditions."""

    operands: tuple[Condition, ...]
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class For:
    """``operand for DURATION``."""

    operand: Condition
    duration: Number
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Since:
    """``operand since cause``: it holds from the cause on, as long as the operand does."""

    operand: Condition
    cause: Condition
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Once:
    """``operand within DURATION``: the operand holds, or did so less than the duration ago."""

    operand: Condition
    duration: Number
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Times:
    """``operand COUNT times within DURATION``: it turned true as often in so long a time."""

    operand: Condition
    count: Number
    duration: Number
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Begins:
    """``operand begins``: the event at which the operand turns true."""

    operand: Condition
    span: Span = field(compare=False, repr=False)


Condition = Comparison | Membership | Truth | Not | And | Or | For | Since | Once | Times | Begins


def operands(condition: Condition) -> tuple[Condition, ...]:
    """Return the conditions that a condition is made of, in the order written."""
    match condition:
        case And() | Or():
            return condition.operands
        case Since():
            return condition.operand, condition.cause
        case Comparison() | Membership() | Truth():
            return ()
        case _:
            return (condition.operand,)


def leaves(condition: Condition) -> Iterator[Condition]:
    """Yield the conditions in a condition that are made of no others, in the order written."""
    waiting = [condition]
    while waiting:
        each = waiting.pop()
        inner = operands(each)
        if inner:
            waiting.extend(reversed(inner))
        else:
            yield each
