"""Comparisons of frequencies: times in whole nanoseconds that are exact."""

from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deros.rules.compiler.frequencies import elapsed_at
from deros.rules.engine.evaluate import COMPARE
from deros.rules.program import ir
from tests.support.rules import condition, findings

INPUT = "input v = topic /speed.data"

messages = st.integers(1, 100)
bounds = st.fractions(Fraction(1, 10**6), 10**10, max_denominator=10**6)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("v.frequency(10) <= 8 Hz", ir.Frequency(0, 10, 1_250_000_000)),
        ("v.frequency(10) < 8 Hz", ir.Frequency(0, 10, 1_250_000_001)),
        ("8 Hz > v.frequency(10)", ir.Frequency(0, 10, 1_250_000_001)),
        ("v.frequency(10) > 8", ir.Not(ir.Frequency(0, 10, 1_250_000_000))),
        ("v.frequency(10) >= 0.008 kHz", ir.Not(ir.Frequency(0, 10, 1_250_000_001))),
        ("v.frequency(1) <= 3 Hz", ir.Frequency(0, 1, 333_333_334)),
        ("v.frequency(1) < 3 Hz", ir.Frequency(0, 1, 333_333_334)),
        ("v.frequency(2) <= 0.7 / 1 min", ir.Frequency(0, 2, 171_428_571_429)),
        (
            "v.frequency(2) in (1 Hz, 2 Hz]",
            ir.And(
                (
                    ir.Not(ir.Frequency(0, 2, 2_000_000_000)),
                    ir.Frequency(0, 2, 1_000_000_000),
                )
            ),
        ),
    ],
)
def test_frequency_is_compared_by_the_time_that_its_messages_take(
    text: str, expected: ir.Condition
) -> None:
    """Of a high frequency it is the opposite; a plain number is in Hz."""
    assert condition(text, INPUT) == expected


@given(messages, st.sampled_from(("<", "<=")), bounds)
def test_time_is_the_least_at_which_the_comparison_holds(
    count: int, operator: ir.Operator, hertz: Fraction
) -> None:
    """One nanosecond less gives a frequency that is not low: no target rounds another way."""
    elapsed_ns = elapsed_at(count, operator, hertz)
    assert elapsed_ns >= 1
    assert COMPARE[operator](Fraction(count * 10**9, elapsed_ns), hertz)
    if elapsed_ns > 1:
        assert not COMPARE[operator](Fraction(count * 10**9, elapsed_ns - 1), hertz)


def test_frequency_answers_a_timeout() -> None:
    """A sensor that falls silent has a frequency that falls, so that its loss is noticed."""
    rules = """action stop latched;
    input v = topic /speed.data timeout 1 sec
    entity e {{ fast: v > 0.5; slow: {slow}; }}
    if e.fast or e.slow then {{ stop; }};"""
    unnoticed = [code for code, *_ in findings(rules.format(slow="v < 0.1"))]
    noticed = [code for code, *_ in findings(rules.format(slow="v.frequency(5) < 8 Hz"))]
    assert "DRS349" in unnoticed
    assert "DRS349" not in noticed


def test_frequency_needs_no_timeout() -> None:
    """It reads no value, and is known from the start on."""
    rules = """action stop latched;
    input v = topic /speed.data
    entity e { slow: v.frequency(5) < 8 Hz; }
    if e.slow then { stop; };"""
    assert "DRS317" not in [code for code, *_ in findings(rules)]
