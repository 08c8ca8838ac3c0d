"""The requirements of a parameter's constraints, in words."""

from __future__ import annotations

import enum
import math
from collections.abc import Iterator
from dataclasses import dataclass

from deros.interfaces.types import INT64
from deros.models.common import Interval, Scalar
from deros.models.node import Parameter, ParameterType

_INTEGERS = (ParameterType.INTEGER, ParameterType.INTEGER_ARRAY)
_DOUBLES = (ParameterType.DOUBLE, ParameterType.DOUBLE_ARRAY)


class Check(enum.Enum):
    """A check of a value, which each target writes in its own language."""

    SIZE = "size"
    MIN_SIZE = "min_size"
    MAX_SIZE = "max_size"
    UNIQUE = "unique"
    CHOICES = "choices"
    RANGE = "range"


@dataclass(frozen=True, slots=True)
class Requirement:
    """One check, and its requirement: ``must have 3 elements``.

    Attributes:
        stated: whether the parameter's descriptor has to say so in words. Ranges it states itself,
            if they are closed; client libraries then check them, but not to the last bit.
    """

    check: Check
    text: str
    stated: bool = True


def requirements(parameter: Parameter) -> tuple[Requirement, ...]:
    """Return the checks of a parameter besides its type, in order."""
    return tuple(_requirements(parameter))


def _requirements(parameter: Parameter) -> Iterator[Requirement]:
    if parameter.size is not None:
        yield Requirement(Check.SIZE, f"must have {_count(parameter, parameter.size)}")
    least = max(parameter.min_size or 0, int(parameter.not_empty))
    if least == 1:
        yield Requirement(Check.MIN_SIZE, "must not be empty")
    elif least:
        yield Requirement(Check.MIN_SIZE, f"must have at least {_count(parameter, least)}")
    if parameter.max_size is not None:
        text = f"must have at most {_count(parameter, parameter.max_size)}"
        yield Requirement(Check.MAX_SIZE, text)
    if parameter.unique:
        yield Requirement(Check.UNIQUE, "must have no element twice")
    if parameter.choices is not None:
        listed = ", ".join(spelled(choice, parameter.type) for choice in parameter.choices)
        who = "must have all elements among" if parameter.type.is_array else "must be one of"
        yield Requirement(Check.CHOICES, f"{who} {listed}")
    if parameter.interval is not None and parameter.type is not ParameterType.INTEGER:
        yield _range(parameter.interval, parameter.type)


def _count(parameter: Parameter, number: int) -> str:
    what = "element" if parameter.type.is_array else "character"
    return f"{number} {what}{'' if number == 1 else 's'}"


def _range(interval: Interval, kind: ParameterType) -> Requirement:
    where = interval_clause(interval, kind)
    if kind.is_array:
        return Requirement(Check.RANGE, f"must have all elements {where}")
    closed = interval.lower_closed and interval.upper_closed
    verb = "be" if interval.one_sided else "lie"
    return Requirement(Check.RANGE, f"must {verb} {where}", stated=not closed)


def spelled(value: Scalar, kind: ParameterType) -> str:
    """Return a value as text for people."""
    if kind in _DOUBLES and not isinstance(value, str):
        return repr(float(value))
    if kind is ParameterType.BYTE_ARRAY and isinstance(value, int):
        return repr(bytes([value & 0xFF]))
    return repr(value)


def interval_clause(interval: Interval, kind: ParameterType) -> str:
    """Return an interval as text; the ends of an interval of integers have no fraction."""
    return interval.clause(lambda value: bound(value, kind))


def bound(value: float, kind: ParameterType) -> str:
    """Return an end of an interval; that of an interval of integers has no fraction if possible."""
    return str(int(value)) if kind in _INTEGERS and float(value).is_integer() else repr(value)


def integer_bounds(interval: Interval) -> tuple[int, int]:
    """Return the least and the greatest integer of an interval, which may be open."""
    low = math.ceil(max(interval.lower, INT64[0]))
    high = math.floor(min(interval.upper, INT64[-1]))
    low += low == interval.lower and not interval.lower_closed
    high -= high == interval.upper and not interval.upper_closed
    return max(low, INT64[0]), min(high, INT64[-1])
