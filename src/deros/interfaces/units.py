"""Physical units: reading them, comparing their dimensions, converting values exactly.

The unit library is pint, but loading its registry takes longer than checking a whole system, so the
units that are common in robotics are in a table (``units.json``) and pint is asked only about a
word that the table lacks. Both use exact fractions: ``0.4 sec`` is 400,000,000 ns, not nearly so.

Unlike in SI and pint, an angle is a dimension of its own here: ``rad`` against a plain ratio, or
``Hz`` against ``rad/s``, is the kind of mistake that a safety rule must not hide.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from decimal import Decimal
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

from deros.interfaces.durations import whole_nanoseconds
from deros.interfaces.types import MOST_DIGITS
from deros.names.names import near

Exponents = tuple[tuple[str, Fraction], ...]
"""Powers of base units, sorted by base, none of them zero."""

_PI = Fraction("3.14159265358979323846264338327950288419716939937510582097494459")
_SUPERSCRIPTS = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")
_TOKEN = re.compile(
    r"\s*(?:(?P<word>[^\W\d]\w*|°\w*|%)|(?P<one>1(?![\d.]))|(?P<power>\*\*|\^)"
    r"|(?P<times>[*·⋅])|(?P<over>/)|(?P<open>\()|(?P<close>\))|(?P<integer>-?\d+))"
)
_NAMED = re.compile(r"[^\W\d]\w*|°\w*|%")
_SUPERSCRIPT_RUN = re.compile("[⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+")
_MAX_EXPONENT = 99
_MAX_DEPTH = 50
_MOST_BITS = 20_000
_LONGEST_UNIT = 200
_LONGEST_WORD = 40


@dataclass(frozen=True, slots=True)
class Unit:
    """A unit as written, and its value in base units.

    A value in this unit is ``value * factor + offset`` in base units (radian among them). Only
    ``degC`` and ``degF`` have an offset; in a compound (``degC/s``) they count as differences.
    """

    text: str
    exponents: Exponents
    factor: Fraction
    offset: Fraction = Fraction(0)

    @property
    def dimension(self) -> str:
        """The physical dimension in words, as ``length/time^2``; ``number`` for none."""
        bases = _table()["bases"]
        above = [_power(bases.get(base, base), e) for base, e in self.exponents if e > 0]
        below = [_power(bases.get(base, base), -e) for base, e in self.exponents if e < 0]
        if not above and not below:
            return "number"
        return "/".join(["*".join(above) or "1", *below])

    def __str__(self) -> str:
        """Return the unit as written."""
        return self.text


def _power(base: str, exponent: Fraction) -> str:
    return base if exponent == 1 else f"{base}^{exponent}"


def rounded(value: Fraction) -> float:
    """Return the nearest double; infinity beyond their range."""
    try:
        return float(value)
    except OverflowError:
        return math.inf if value > 0 else -math.inf


class UnitRegistry:
    """The units known to one program: the table, the program's own, and pint's.

    ``definitions`` maps a name to a factor and the unit it multiplies: ``unit knot = 0.514444 m/s``
    is ``{"knot": (Decimal("0.514444"), "m/s")}``. They may use each other in any order. Of a name
    that is known anyhow, the meaning is the known one, as it is in fields of messages.
    """

    def __init__(
        self, definitions: Mapping[str, tuple[Decimal | float, str]] | None = None
    ) -> None:
        """Store the program's own units; nothing is read yet."""
        self._definitions = dict(definitions or {})
        self._words: dict[str, Unit | None] = {}
        self._parsed: dict[str, Unit | None] = {}
        self._depth = 0

    def parse(self, text: str) -> Unit | None:
        """Read a unit such as ``m/s^2``, ``N*m`` or ``1`` (a plain number); ``None`` if unknown.

        A unit defined by itself, directly or through others, is unknown too.
        """
        if len(text) > _LONGEST_UNIT:
            return None
        if text not in self._parsed:
            self._parsed[text] = _Parser(text, self._word).unit()
        return self._parsed[text]

    def compatible(self, a: Unit, b: Unit) -> bool:
        """Return whether values of one unit can be compared with values of the other."""
        return a.exponents == b.exponents

    def factor(self, source: Unit, target: Unit) -> tuple[float, float]:
        """Return ``(factor, offset)`` such that ``target value = source value * factor + offset``.

        The units must be compatible.
        """
        factor, offset = _exact_factor(source, target)
        return float(factor), float(offset)

    def convert(self, value: Decimal | float, source: Unit, target: Unit) -> float:
        """Convert a value between compatible units, rounding once, at the end.

        Infinity and NaN stay what they are; a value beyond the range of a double becomes infinite.
        """
        factor, offset = _exact_factor(source, target)
        exact = _fraction(value)
        if exact is None:
            return float(value)
        return rounded(exact * factor + offset)

    def duration_ns(self, value: Decimal, unit: Unit) -> int | None:
        """Return a duration in nanoseconds.

        ``None`` when the unit is none of time, or the value is negative, no whole number of ns, or
        longer than 64 bits of them (292 years).
        """
        exact = _fraction(value)
        if exact is None or unit.exponents != (("s", Fraction(1)),):
            return None
        try:
            return whole_nanoseconds(exact * unit.factor)
        except ValueError:
            return None

    def suggest(self, text: str) -> list[str]:
        """Return known unit words that resemble ``text``, or that an ambiguous one may mean."""
        table = _table()
        for word, meanings in table["ambiguous"].items():
            if re.search(rf"\b{word}\b", text):
                return [re.sub(rf"\b{word}\b", meaning, text) for meaning in meanings]
        return near(text, [*self._definitions, *table["bases"], *table["units"], "ms", "cm", "km"])

    def _word(self, word: str) -> Unit | None:
        if word not in self._words:
            if self._depth > _MAX_DEPTH:
                return None
            self._words[word] = None  # the value that a cyclic definition finds
            self._depth += 1
            self._words[word] = self._look_up(word)
            self._depth -= 1
        return self._words[word]

    def _look_up(self, word: str) -> Unit | None:
        found = self._built_in(word)
        if found is None and word in self._definitions:
            factor, text = self._definitions[word]
            exact = _fraction(factor)
            return self._multiple(word, exact, text) if exact and exact > 0 else None
        return found or _raised(word, self._word)

    def _built_in(self, word: str) -> Unit | None:
        table = _table()
        if word in table["ambiguous"]:  # pint would take a German degree for a gon
            return None
        if word in table["bases"]:
            return Unit(word, ((word, Fraction(1)),), Fraction(1))
        if word in table["units"]:
            factor, text, *offset = table["units"][word]
            return self._multiple(word, _number(factor), text, *map(_number, offset))
        prefix, rest = word[:1], word[1:]
        if prefix in table["prefixes"] and rest in table["prefixed"]:
            return self._multiple(word, _number(table["prefixes"][prefix]), rest)
        # The longest words of pint have 34 characters; it takes the square of the length to look.
        found = _ask_pint(word) if len(word) <= _LONGEST_WORD else None
        return found or _raised(word, self._built_in)

    def _multiple(
        self, word: str, factor: Fraction, text: str, offset: Fraction = Fraction(0)
    ) -> Unit | None:
        unit = self.parse(text)
        if unit is None or _bits(unit.factor) + _bits(factor) > _MOST_BITS:
            return None
        return Unit(word, unit.exponents, factor * unit.factor, offset)


class _Parser:
    """Reads ``unit := power {('*' | '/') power}`` with ``power := atom ['^' integer]``."""

    def __init__(self, text: str, word: Any) -> None:
        text = _SUPERSCRIPT_RUN.sub(lambda run: "^" + run[0].translate(_SUPERSCRIPTS), text)
        self._text = text.strip()
        self._word = word
        self._position = 0

    def unit(self) -> Unit | None:
        """Read the whole text."""
        found = self._product(0)
        if found is None or self._position != len(self._text):
            return None
        return Unit(re.sub(r"\s+", "", self._text), found.exponents, found.factor, found.offset)

    def _take(self, *kinds: str) -> str | None:
        match = _TOKEN.match(self._text, self._position)
        if match is None or match.lastgroup not in kinds:
            return None
        self._position = match.end()
        return match[match.lastgroup]

    def _product(self, depth: int) -> Unit | None:
        left = self._factor(depth)
        while left is not None:
            operator = self._take("times", "over")
            if operator is None:
                return left
            right = self._factor(depth)
            left = right and _combine(left, right, -1 if operator == "/" else 1)
        return None

    def _factor(self, depth: int) -> Unit | None:
        base = self._atom(depth)
        if base is None or self._take("power") is None:
            return base
        written = self._take("integer", "one")
        if written is None or abs(int(written)) > _MAX_EXPONENT:
            return None
        return _combine(_ONE, base, int(written))

    def _atom(self, depth: int) -> Unit | None:
        if self._take("one"):
            return _ONE
        if self._take("open"):
            inner = self._product(depth + 1) if depth < _MAX_DEPTH else None
            return inner if self._take("close") else None
        word = self._take("word")
        found: Unit | None = self._word(word) if word else None
        return found


_ONE = Unit("1", (), Fraction(1))


def _raised(word: str, look_up: Callable[[str], Unit | None]) -> Unit | None:
    """Return ``m2`` as it is often written, the square of a metre."""
    base = look_up(word[:-1]) if len(word) > 1 and word[-1] in "23456789" else None
    return base and _combine(_ONE, base, int(word[-1]))


def product(left: Unit, right: Unit) -> Unit | None:
    """Return the unit of a product; ``None`` if its factor would fill the memory."""
    for one, other in ((left, right), (right, left)):
        if is_one(one):
            return without_offset(other)
    return _named(_combine(left, right, 1), f"{left}*{_grouped(right)}")


def quotient(left: Unit, right: Unit) -> Unit | None:
    """Return the unit of a quotient; ``None`` if its factor would fill the memory."""
    if is_one(right):
        return without_offset(left)
    return _named(_combine(left, right, -1), f"{left}/{_grouped(right)}")


def root(unit: Unit) -> Unit:
    """Return the unit of the square root of a number in base units of the dimension of ``unit``."""
    exponents = tuple((base, power / 2) for base, power in unit.exponents)
    return in_bases(replace(unit, exponents=exponents))


def in_bases(unit: Unit) -> Unit:
    """Return the unit of the same dimension that is made of base units (SI, and the radian)."""
    return Unit(_in_bases(unit.exponents), unit.exponents, Fraction(1))


def without_offset(unit: Unit) -> Unit:
    """Return the unit of a difference: of two temperatures in degC it is K."""
    if not unit.offset:
        return unit
    return (
        in_bases(unit)
        if unit.factor == 1
        else replace(unit, text=f"delta {unit}", offset=Fraction(0))
    )


def is_difference_of(unit: Unit | None, scale: Unit | None) -> bool:
    """Return whether a unit is one of differences on a scale with a zero of its own: K on degC."""
    if unit is None or scale is None or not scale.offset or unit.offset:
        return False
    return unit.exponents == scale.exponents


def is_seen(unit: Unit) -> bool:
    """Return whether readers know the unit of what is computed: coherent SI, or one that is named.

    A plain number beside it is then read as the author means it: beside ``w * 1 s`` as metres, but
    beside ``w * 1 ms`` not as millimetres.
    """
    return (unit.factor == 1 and not unit.offset) or _NAMED.fullmatch(unit.text) is not None


def is_one(unit: Unit) -> bool:
    """Return whether a unit is that of plain numbers."""
    return not unit.exponents and unit.factor == 1


def is_same(one: Unit | None, other: Unit | None) -> bool:
    """Return whether two units are one, however they are written."""
    if one is None or other is None:
        return one is other
    return (one.exponents, one.factor, one.offset) == (other.exponents, other.factor, other.offset)


def without_angles(unit: Unit) -> Unit:
    """Return a unit in which a radian is the plain number 1."""
    kept = tuple((base, power) for base, power in unit.exponents if base != "rad")
    return replace(unit, exponents=kept)


def _grouped(unit: Unit) -> str:
    return f"({unit})" if re.search(r"[*/]", unit.text) else unit.text


def _named(unit: Unit | None, text: str) -> Unit | None:
    """Return a computed unit with a text: that of its dimension where it is one of base units."""
    if unit is None:
        return None
    return replace(unit, text=_in_bases(unit.exponents) if unit.factor == 1 else text)


def _in_bases(exponents: Exponents) -> str:
    above = [_power(base, power) for base, power in exponents if power > 0]
    below = [_power(base, -power) for base, power in exponents if power < 0]
    return "/".join(["*".join(above) or "1", *below])


def _combine(left: Unit, right: Unit, exponent: int) -> Unit | None:
    """Return ``left * right ** exponent``; without offset, as a product is one of differences.

    ``None`` stands for a product whose factor would fill the memory.
    """
    if _bits(left.factor) + _bits(right.factor) * abs(exponent) > _MOST_BITS:
        return None
    exponents = dict(left.exponents)
    for base, power in right.exponents:
        exponents[base] = exponents.get(base, Fraction(0)) + power * exponent
    kept = tuple(sorted((base, power) for base, power in exponents.items() if power))
    return Unit("", kept, left.factor * right.factor**exponent)


def _bits(factor: Fraction) -> int:
    """Return how much memory a factor takes, in bits."""
    return factor.numerator.bit_length() + factor.denominator.bit_length()


def _exact_factor(source: Unit, target: Unit) -> tuple[Fraction, Fraction]:
    factor = source.factor / target.factor
    return factor, (source.offset - target.offset) / target.factor


def _fraction(value: Decimal | float) -> Fraction | None:
    """Return the exact value, or ``None`` if it is not finite as a double."""
    if isinstance(value, Decimal):
        if value.is_finite() and abs(value.adjusted()) > MOST_DIGITS:
            return None if value else Fraction(0)
        return Fraction(value) if value.is_finite() else None
    return Fraction(value) if math.isfinite(value) else None


@cache
def _table() -> dict[str, Any]:
    text = Path(__file__).with_name("units.json").read_text(encoding="utf-8")
    table: dict[str, Any] = json.loads(text)
    return table


def _number(text: str) -> Fraction:
    """Read ``0.001``, ``5/9``, ``pi/180`` or ``pi*2`` of the table."""
    if text.startswith("pi/"):
        return _PI / Fraction(text[3:])
    if text.startswith("pi*"):
        return _PI * Fraction(text[3:])
    above, _, below = text.partition("/")
    return Fraction(above) / Fraction(below or 1)


@cache
def _pint_registry() -> Any:
    import pint  # takes a third of a second with its registry

    return pint.UnitRegistry(non_int_type=Fraction)


_PINT_BASES = {
    "meter": "m",
    "gram": "g",
    "second": "s",
    "ampere": "A",
    "kelvin": "K",
    "mole": "mol",
    "candela": "cd",
    "radian": "rad",
    "bit": "bit",
}


@cache
def _ask_pint(word: str) -> Unit | None:
    """Look a word up in pint; its root units keep the radian that its base units drop."""
    registry = _pint_registry()
    try:
        one = registry.Quantity(Fraction(1), word).to_root_units()
        two = registry.Quantity(Fraction(2), word).to_root_units()
    except Exception:  # pint has no common base for what its own parser and units raise
        return None
    # A logarithmic unit, or one with an offset, does not double.
    if not isinstance(one.magnitude, Fraction) or two.magnitude != 2 * one.magnitude:
        return None
    exponents = sorted((_PINT_BASES.get(base, base), Fraction(p)) for base, p in one.unit_items())
    return Unit(word, tuple(exponents), one.magnitude)
