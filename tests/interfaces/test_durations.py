"""Durations and times in nanoseconds."""

from __future__ import annotations

from fractions import Fraction

import pytest

from deros.interfaces.durations import (
    LONGEST_NS,
    NS_PER_S,
    duration_text,
    greatest_unit,
    seconds_text,
    whole_nanoseconds,
)


@pytest.mark.parametrize(
    ("seconds", "expected"),
    [
        (Fraction(0), 0),
        (Fraction(1, NS_PER_S), 1),
        (Fraction(3, 2), 1_500_000_000),
        (Fraction(LONGEST_NS, NS_PER_S), LONGEST_NS),
    ],
)
def test_exact_seconds_become_nanoseconds(seconds: Fraction, expected: int) -> None:
    """Nothing is rounded, up to the longest duration of ROS 2."""
    assert whole_nanoseconds(seconds) == expected


@pytest.mark.parametrize(
    ("seconds", "message"),
    [
        (Fraction(-1), "is negative"),
        (Fraction(1, 2 * NS_PER_S), "is not a whole number of nanoseconds"),
        (Fraction(LONGEST_NS + 1, NS_PER_S), "is longer than 292 years"),
    ],
)
def test_invalid_durations_are_rejected(seconds: Fraction, message: str) -> None:
    """The message completes a sentence."""
    with pytest.raises(ValueError, match=message):
        whole_nanoseconds(seconds)


@pytest.mark.parametrize(
    ("nanoseconds", "text"),
    [
        (1, "1 ns"),
        (1500, "1500 ns"),
        (100_000_000, "100 ms"),
        (60 * NS_PER_S, "1 min"),
        (90 * NS_PER_S, "90 sec"),
        (7_200 * NS_PER_S, "2 h"),
    ],
)
def test_durations_use_the_largest_whole_unit(nanoseconds: int, text: str) -> None:
    """The largest unit without a fraction is used."""
    assert duration_text(nanoseconds) == text


def test_largest_unit_can_be_bounded() -> None:
    """For example, the period of a timer is not given in minutes."""
    assert greatest_unit(120 * NS_PER_S, "sec") == (120, "sec")
    assert greatest_unit(20_000_000, "sec") == (20, "ms")


def test_seconds_have_as_many_digits_as_needed() -> None:
    """There are no trailing zeros, and at most nine significant digits."""
    assert seconds_text(500_000_000) == "0.5 sec"
    assert seconds_text(1_000_000_001) == "1 sec"
    assert seconds_text(2_000_000) == "0.002 sec"
