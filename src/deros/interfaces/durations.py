"""Durations and times in nanoseconds: how they are read, and how they are shown to people."""

from __future__ import annotations

from fractions import Fraction

NS_PER_S = 10**9

LONGEST_NS = 2**63 - 1
"""The longest duration of ROS 2 (``RMW_DURATION_INFINITE``), and its latest time."""

LATEST_NS = 2**62 - 1
"""The latest time and the longest duration in emitted C and C++: a sum of two fits 64 bits."""

_WORDS = (
    (3_600 * NS_PER_S, "h"),
    (60 * NS_PER_S, "min"),
    (NS_PER_S, "sec"),
    (10**6, "ms"),
    (10**3, "us"),
    (1, "ns"),
)


def whole_nanoseconds(seconds: Fraction) -> int:
    """Return a duration in nanoseconds.

    Raises:
        ValueError: if it is negative, not a whole number of nanoseconds, or longer than 64 bits of
            them; the message completes "the duration …".
    """
    exact = seconds * NS_PER_S
    if exact < 0:
        raise ValueError("is negative")
    if exact.denominator != 1:
        raise ValueError("is not a whole number of nanoseconds")
    if exact > LONGEST_NS:
        raise ValueError("is longer than 292 years")
    return int(exact)


def greatest_unit(nanoseconds: int, largest: str = "h") -> tuple[int, str]:
    """Return a duration in the greatest unit that needs no fraction: the count, and the unit.

    Args:
        nanoseconds: the duration.
        largest: the greatest unit that may be used.
    """
    known = [unit for _, unit in _WORDS]
    units = _WORDS[known.index(largest) :]
    size, unit = next((size, unit) for size, unit in units if nanoseconds % size == 0)
    return nanoseconds // size, unit


def duration_text(nanoseconds: int) -> str:
    """Return a duration as the languages write it, in the greatest unit without a fraction."""
    count, unit = greatest_unit(nanoseconds)
    return f"{count} {unit}"


def seconds_text(nanoseconds: int) -> str:
    """Return a duration in seconds, with as many digits as it needs: ``0.5 sec``."""
    return f"{nanoseconds / NS_PER_S:.9g} sec"


def with_unit_of_time(number: str) -> str:
    """Return the hint for a duration without a unit: the readings, the likelier one first."""
    likely, other = ("ms", "sec") if abs(float(number)) >= _LIKELY_MS else ("sec", "ms")
    return f"write '{number} {likely}' or '{number} {other}'"


_LIKELY_MS = 10
"""From here on a number without a unit is more often one of milliseconds than of seconds."""
