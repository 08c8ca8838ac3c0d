"""Rounding of bounds to the type of a field, and the decimals that tell its values."""

from __future__ import annotations

import math
import struct
from decimal import Decimal
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deros.interfaces.types import FieldType
from deros.rules.program.bounds import as_float32, rounded_as, shortest_decimal

SINGLE, DOUBLE = FieldType("float32"), FieldType("float64")
SINGLES = st.floats(width=32, allow_nan=False, allow_infinity=False)


@given(st.fractions(max_denominator=10**12))
def test_rounding_gives_the_nearest_number(number: Fraction) -> None:
    """No other float32 is nearer; of two that are as near, the even one is taken."""
    found = rounded_as(number, SINGLE)
    assert as_float32(found) == found
    bits = struct.unpack("<i", struct.pack("<f", abs(found)))[0]
    for other in (bits - 1, bits + 1):
        if other >= 0:
            neighbour = struct.unpack("<f", struct.pack("<i", other))[0]
            distance = abs(abs(number) - Fraction(neighbour))
            nearest = abs(abs(number) - Fraction(abs(found)))
            assert nearest < distance or (nearest == distance and bits % 2 == 0)
    assert rounded_as(number, DOUBLE) == float(number)


@given(SINGLES)
def test_numbers_of_the_type_are_kept(number: float) -> None:
    """Subnormal ones too."""
    assert rounded_as(Fraction(number), SINGLE) == number


@pytest.mark.parametrize("number", [Fraction(10) ** 39, -(Fraction(10) ** 39), Fraction(10) ** 400])
def test_numbers_out_of_range_stay_out_of_range(number: Fraction) -> None:
    """No value of the field is as great."""
    greatest = struct.unpack("<f", b"\xff\xff\x7f\x7f")[0]
    assert abs(rounded_as(number, SINGLE)) > greatest


@given(SINGLES)
def test_decimal_identifies_the_number(number: float) -> None:
    """It is short, and gives the same float32 again."""
    found = shortest_decimal(number)
    assert as_float32(found) == number
    assert len(Decimal(str(found)).normalize().as_tuple().digits) <= 9


def test_decimal_is_as_written() -> None:
    """What is no float32 is told as it is."""
    assert shortest_decimal(as_float32(0.1)) == 0.1
    assert shortest_decimal(as_float32(51.2)) == 51.2
    assert shortest_decimal(0.1) == 0.1
    assert shortest_decimal(math.inf) == math.inf
    assert math.isnan(shortest_decimal(math.nan))
