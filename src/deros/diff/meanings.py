"""What parts of rules mean, as data that is equal for all ways to write it."""

from __future__ import annotations

import re
from collections.abc import Hashable, Iterator
from dataclasses import dataclass, fields, is_dataclass, replace
from decimal import Decimal
from fractions import Fraction
from typing import Any

from deros.diagnostics import Span
from deros.diff.texts import Meant
from deros.interfaces.units import UnitRegistry
from deros.models.common import Name
from deros.models.gates import GateLimit
from deros.models.rules import Mounting, TunableIn, Zone
from deros.models.terms import And, Number, Or

_TIME = (("s", Fraction(1)),)
_BETWEEN_WORDS = re.compile(r'("(?:\\.|[^"\\])*")|//[^\n]*|/\*.*?\*/|\s+', re.DOTALL)


@dataclass(frozen=True, slots=True)
class Time:
    """A duration, in seconds."""

    seconds: Fraction


class Meanings:
    """The meanings of the parts of rules, given the units that these define."""

    def __init__(self, units: UnitRegistry) -> None:
        """Read units by ``units``."""
        self._units = units

    def meant(self, part: Any, span: Span | None = None) -> Meant | None:
        """Return a part as written, with its meaning; ``None`` for no part."""
        if part is None:
            return None
        return Meant(written(span or part.span), self.of(part))

    def unit(self, text: str | None) -> Meant | None:
        """Return a unit as written, with its meaning."""
        if text is None:
            return None
        unit = self._units.parse(text)
        if unit is None:
            return Meant(text, text)
        return Meant(text, (unit.exponents, unit.factor, unit.offset))

    def zone(self, zone: Zone) -> Meant:
        """Return the shape of a zone as written, with its coordinates in metres."""
        unit = None if zone.unit is None else self._units.parse(zone.unit)
        factor = Fraction(1) if unit is None else unit.factor

        def scaled(part: Any) -> Hashable:
            if isinstance(part, Decimal):
                return Fraction(part) * factor
            if isinstance(part, tuple):
                return tuple(map(scaled, part))
            compared = (getattr(part, each.name) for each in fields(part) if each.compare)
            return (type(part).__name__, *map(scaled, compared))

        return Meant(f"{written(zone.shape_span)} {zone.unit or ''}".strip(), scaled(zone.shape))

    def mounting(self, mounting: Mounting | None) -> Meant | None:
        """Return where a sensor is as written, with its coordinates in metres."""
        if mounting is None:
            return None
        unit = None if mounting.unit is None else self._units.parse(mounting.unit)
        factor = Fraction(1) if unit is None else unit.factor
        place = (mounting.x, mounting.y, mounting.z or Decimal(0))
        yaw = None if mounting.yaw is None else self.of(mounting.yaw)
        return Meant(written(mounting.span), (*(Fraction(each) * factor for each in place), yaw))

    def of(self, part: Any) -> Hashable:
        """Return what a part means: units converted, names and operands without their places."""
        match part:
            case Number():
                return self._number(part)
            case Name(text=text):
                return text
            case Span():  # of a word whose presence counts
                return True
            case And() | Or():
                operands = sorted(map(self.of, part.operands), key=repr)
                return (type(part).__name__, *operands)
            case GateLimit() | TunableIn() if part.unit is not None:
                ends = (self._with_unit(each, part.unit) for each in (part.lower, part.upper))
                lower, upper = ends
                return self.of(replace(part, lower=lower, upper=upper, unit=None))
            case tuple():
                return tuple(map(self.of, part))
            case _ if is_dataclass(part):
                compared = (each.name for each in fields(part) if each.compare)
                values = ((name, self.of(getattr(part, name))) for name in compared)
                told = tuple(pair for pair in values if pair[0] != "description")
                return (type(part).__name__, *told)
        assert isinstance(part, Hashable)
        return part

    def _number(self, number: Number) -> Hashable:
        value = Fraction(number.value)
        unit = None if number.unit is None else self._units.parse(number.unit)
        if unit is None:
            return ("number", value, number.unit)
        value = value * unit.factor + unit.offset
        return Time(value) if unit.exponents == _TIME else ("number", value, unit.exponents)

    @staticmethod
    def _with_unit(end: Any, unit: str) -> Any:
        return replace(end, unit=unit) if isinstance(end, Number) and end.unit is None else end


def written(span: Span) -> str:
    """Return the text of a span in one line, without comments."""
    return _BETWEEN_WORDS.sub(lambda found: found[1] or " ", span.text).strip().rstrip(";").strip()


def is_longer(old: Meant | None, new: Meant | None) -> bool:
    """Return whether two parts differ in their times alone, and one is longer than it was."""
    if old is None or new is None or _timeless(old.meaning) != _timeless(new.meaning):
        return False
    pairs = zip(_times(old.meaning), _times(new.meaning), strict=True)
    return any(after > before for before, after in pairs)


def _timeless(meaning: Any) -> Any:
    if isinstance(meaning, tuple):
        return tuple(map(_timeless, meaning))
    return Time if isinstance(meaning, Time) else meaning


def _times(meaning: Any) -> Iterator[Fraction]:
    if isinstance(meaning, Time):
        yield meaning.seconds
    elif isinstance(meaning, tuple):
        for each in meaning:
            yield from _times(each)
