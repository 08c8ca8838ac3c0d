"""Parsing units and converting values."""

from __future__ import annotations

import functools
import json
import math
import subprocess
import sys
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any

import pint
import pytest
from hypothesis import given
from hypothesis import strategies as st

from deros.interfaces import units
from deros.interfaces.units import Unit, UnitRegistry

REGISTRY = UnitRegistry()
TABLE = json.loads(Path(units.__file__).with_suffix(".json").read_text(encoding="utf-8"))
WORDS = sorted(
    [*TABLE["bases"], *TABLE["units"], "ms", "us", "ns", "km", "cm", "mm", "kg", "mV", "kPa"]
)
OWN_WORDS = {
    "Nm": "N*m",
    "T": "tesla",
    "h": "hour",
    "t": "tonne",
    "sec": "s",
    "secs": "s",
    "msec": "ms",
}
OWN_WORDS |= {"usec": "us", "°C": "degC", "C": "coulomb", "rev": "revolution"}


@functools.cache
def _pint() -> Any:
    return pint.UnitRegistry(non_int_type=Fraction)


words = st.sampled_from(WORDS)
decimals = st.decimals(
    allow_nan=False, allow_infinity=False, min_value=-(10**9), max_value=10**9, places=9
)


def unit(text: str) -> Unit:
    """Parse a unit that must be known."""
    parsed = REGISTRY.parse(text)
    assert parsed is not None, text
    return parsed


def test_table_agrees_with_pint() -> None:
    """Each unit of the table has the value that pint gives, with angles as their own dimension."""
    for word in WORDS:
        theirs = _pint().Quantity(Fraction(1), OWN_WORDS.get(word, word)).to_root_units()
        ours = unit(word)
        assert math.isclose(theirs.magnitude, ours.factor + ours.offset, rel_tol=1e-12), word
        names = {"meter": "m", "gram": "g", "second": "s", "ampere": "A", "kelvin": "K"}
        names |= {"mole": "mol", "candela": "cd", "radian": "rad"}
        dimension = {names.get(base, base): power for base, power in theirs.unit_items()}
        assert dimension == dict(ours.exponents), word


DIMENSIONS = (
    ("m/s", "length/time"),
    ("m/s^2", "length/time^2"),
    ("m/s**2", "length/time^2"),
    ("m·s⁻²", "length/time^2"),
    (" m / ( s * s ) ", "length/time^2"),
    ("rad/s", "angle/time"),
    ("1/s", "1/time"),
    ("1", "number"),
    ("%", "number"),
    ("m/m", "number"),
    ("N*m", "mass*length^2/time^2"),
    ("furlong", "length"),
)


def test_units_have_a_dimension() -> None:
    """Products, quotients and powers are parsed in the usual spellings."""
    for text, dimension in DIMENSIONS:
        assert unit(text).dimension == dimension, text


INVALID = (
    "",
    "m//s",
    "m/",
    "/s",
    "m s",
    "(m",
    "m)",
    "no_such",
    "m^",
    "m^9999",
    "2 m",
    "m^1.5",
    "**",
    "dB",
)


def test_invalid_unit_is_none() -> None:
    """An unknown or malformed unit returns None and does not raise."""
    for text in INVALID:
        assert REGISTRY.parse(text) is None, text


@given(st.text(max_size=8))
def test_arbitrary_text_does_not_raise(text: str) -> None:
    """Any text gives a unit with a positive factor or None."""
    parsed = REGISTRY.parse(text)
    assert parsed is None or parsed.factor > 0


def test_deep_nesting_is_rejected() -> None:
    """Thousands of parentheses are not a unit, and do not overflow the stack."""
    assert REGISTRY.parse("(" * 5000 + "m" + ")" * 5000) is None


DURATIONS = (
    ("0.1", "sec", 100_000_000),
    ("0.4", "s", 400_000_000),
    ("4", "sec", 4_000_000_000),
    ("1.5", "min", 90_000_000_000),
    ("2", "h", 7_200_000_000_000),
    ("250", "ms", 250_000_000),
    ("0.000000001", "s", 1),
    ("0", "s", 0),
    ("0.0000000001", "s", None),
    ("-1", "s", None),
    ("1", "m", None),
    ("1", "1/s", None),
    ("1e12", "s", None),
    ("1e999999", "s", None),
    ("NaN", "s", None),
)


def test_durations_are_exact() -> None:
    """A duration is a whole number of nanoseconds of 64 bits, or None."""
    for value, text, nanoseconds in DURATIONS:
        assert REGISTRY.duration_ns(Decimal(value), unit(text)) == nanoseconds, (value, text)


def test_angles_are_their_own_dimension() -> None:
    """An angle is not a ratio, and an angle per second is not a frequency."""
    assert not REGISTRY.compatible(unit("rad"), unit("1"))
    assert not REGISTRY.compatible(unit("rad/s"), unit("Hz"))
    assert not REGISTRY.compatible(unit("rad"), unit("m/s"))
    assert REGISTRY.compatible(unit("rad"), unit("deg"))
    assert REGISTRY.compatible(unit("rpm"), unit("deg/s"))


CONVERSIONS = (
    ("0.4", "sec", "ns", 400_000_000.0),
    ("10", "deg", "rad", math.radians(10)),
    ("180", "deg", "rad", math.pi),
    ("3.6", "km/h", "m/s", 1.0),
    ("20", "%", "1", 0.2),
    ("25", "degC", "K", 298.15),
    ("25", "degC", "degF", 77.0),
    ("1", "degC/s", "K/s", 1.0),
    ("1", "bar", "kPa", 100.0),
    ("1e999999", "m", "cm", math.inf),
    ("-1e999999", "m", "cm", -math.inf),
    ("1e308", "km", "mm", math.inf),
    ("0e999999", "km", "mm", 0.0),
)


def test_conversions_round_once() -> None:
    """A converted value is the double nearest to the exact one."""
    for value, source, target, result in CONVERSIONS:
        converted = REGISTRY.convert(Decimal(value), unit(source), unit(target))
        assert converted == result, (value, source, target)


def test_infinity_and_nan_are_not_converted() -> None:
    """Conversion applies to finite numbers only."""
    assert REGISTRY.convert(-math.inf, unit("m"), unit("cm")) == -math.inf
    assert math.isnan(REGISTRY.convert(math.nan, unit("m"), unit("cm")))


@given(words, words, decimals)
def test_conversions_round_trip(source: str, target: str, value: Decimal) -> None:
    """Converting there and back gives the same value, up to the rounding of one double."""
    a, b = unit(source), unit(target)
    if not REGISTRY.compatible(a, b):
        return
    there = REGISTRY.convert(value, a, b)
    back = REGISTRY.convert(there, b, a)
    slack = max(abs(float(value)), abs(float((b.offset - a.offset) / a.factor)), 1e-300)
    assert math.isclose(back, float(value), rel_tol=1e-15, abs_tol=4e-16 * slack)


@given(words, words, decimals)
def test_factor_agrees_with_convert(source: str, target: str, value: Decimal) -> None:
    """Factor and offset of two units give the result of ``convert``."""
    a, b = unit(source), unit(target)
    if not REGISTRY.compatible(a, b):
        return
    factor, offset = REGISTRY.factor(a, b)
    converted = REGISTRY.convert(value, a, b)
    slack = abs(float(value) * factor) + abs(offset)
    assert math.isclose(float(value) * factor + offset, converted, rel_tol=0, abs_tol=1e-15 * slack)


@given(words, decimals)
def test_conversion_to_the_same_unit_is_exact(word: str, value: Decimal) -> None:
    """A value in the unit of the field is not changed."""
    assert REGISTRY.convert(value, unit(word), unit(word)) == float(value)
    assert REGISTRY.factor(unit(word), unit(word)) == (1.0, 0.0)


def test_user_defined_units_may_refer_to_each_other() -> None:
    """They may refer to each other in any order, be part of compounds, and hide no known one."""
    registry = UnitRegistry(
        {
            "lap": (Decimal("2"), "round"),
            "round": (Decimal("400"), "m"),
            "knot": (Decimal("0.5"), "m/s"),
        }
    )
    lap, metre = registry.parse("lap/min"), registry.parse("m/s")
    assert lap is not None
    assert metre is not None
    assert registry.convert(Decimal("0.6"), lap, metre) == 8.0
    assert registry.parse("knot") == REGISTRY.parse("knot")


@pytest.mark.parametrize(
    ("short", "whole"), [("m/s2", "m/s^2"), ("kg*m2/s3", "kg*m^2/s^3"), ("mm2", "mm^2")]
)
def test_one_digit_needs_no_sign(short: str, whole: str) -> None:
    """Exponents are often written so; a unit of one's own may end with a digit."""
    assert unit(short).exponents == unit(whole).exponents
    assert unit(short).factor == unit(whole).factor
    own = UnitRegistry({"lap": (Decimal(400), "m"), "lap2": (Decimal(300), "m")})
    dimensions = [found and found.dimension for found in map(own.parse, ("lap2", "lap3", "m2"))]
    assert dimensions == ["length", "length^3", "length^2"]


@pytest.mark.parametrize(
    "definitions",
    [
        {"x": (Decimal(1), "x")},
        {"x": (Decimal(1), "y"), "y": (Decimal(1), "x")},
        {"x": (Decimal(0), "m")},
        {"x": (Decimal(-1), "m")},
        {"x": (math.inf, "m")},
        {"x": (Decimal(1), "no_such_unit")},
        {"x": (Decimal(1), "y0")} | {f"y{i}": (Decimal(1), f"y{i + 1}") for i in range(5000)},
    ],
)
def test_invalid_unit_definition_is_unknown(
    definitions: dict[str, tuple[Decimal | float, str]],
) -> None:
    """Cycles, non-positive factors and unknown bases give no unit."""
    assert UnitRegistry(definitions).parse("x") is None


def test_similar_units_are_suggested() -> None:
    """The suggestions include units defined by the program."""
    assert "metre" in REGISTRY.suggest("metres")
    assert UnitRegistry({"furlongs": (Decimal(1), "m")}).suggest("furlungs") == ["furlongs"]


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("grad", ["deg", "gon"]),
        ("grads", ["deg", "gon"]),
        ("grad/s", ["deg/s", "gon/s"]),
        ("grade", ["deg", "gon", "%"]),
    ],
)
def test_ambiguous_unit_is_unknown(text: str, meant: list[str]) -> None:
    """A German 'Grad' is a degree, pint's is a gon: neither is taken, and both are suggested."""
    assert REGISTRY.parse(text) is None
    assert REGISTRY.suggest(text) == meant
    assert all(REGISTRY.parse(each) is not None for each in meant)
    assert UnitRegistry({"grad": (Decimal(1), "deg")}).parse("grad") is not None


def test_pint_is_loaded_only_for_units_outside_the_table() -> None:
    """Common units and their compounds do not load pint."""
    program = (
        "import sys; from deros.interfaces.units import UnitRegistry\n"
        "r = UnitRegistry()\n"
        "assert all(map(r.parse, ['km/h', 'N*m', 'deg/s', 'lx', 'mV', '%', 'rpm']))\n"
        "print('pint' in sys.modules)\n"
        "assert r.parse('furlong')\n"
        "print('pint' in sys.modules)\n"
    )
    result = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert result.stdout == "False\nTrue\n"
