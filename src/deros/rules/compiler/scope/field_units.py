"""Units of the fields that rules read: declared, usual, or those of what a field is compared with.

A field whose unit nothing tells has one unit in the whole program, that of the quantities with
which the rules compare it. Where a rule computes with it beside a quantity, its unit has to be
declared: what is computed would be in a unit that nobody sees.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

from deros import codes
from deros.diagnostics import Diagnostic, Related, Span, report
from deros.interfaces.fields import FieldPath, format_path, without_indices
from deros.interfaces.rep103 import is_share, is_wrapping, usual_unit
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import InterfaceType
from deros.interfaces.units import Unit, UnitRegistry, in_bases, is_same, is_seen
from deros.rules.compiler.scope.resolved import FieldKey
from deros.rules.compiler.scope.topics import SystemTopics
from deros.rules.program.bounds import SHARE, Ends, rounded


@dataclass(frozen=True, slots=True)
class _Use:
    """Where a field is read in a unit, or as a plain number (``None``)."""

    unit: Unit | None
    span: Span

    @property
    def shown(self) -> str:
        return f"in {self.unit}" if self.unit is not None else "a plain number"


class FieldUnits:
    """The units of the fields of one program."""

    def __init__(self, store: InterfaceStore, topics: SystemTopics, units: UnitRegistry) -> None:
        """Know what systems and message definitions tell; inputs declare the rest."""
        self._store = store
        self._topics = topics
        self._units = units
        self._declared: dict[FieldKey, _Use] = {}
        self._uses: dict[FieldKey, list[_Use]] = {}
        self._asked: set[FieldKey] = set()
        self._alike: list[tuple[FieldKey, FieldKey]] = []

    # What is known -----------------------------------------------------------------------------

    def unit_of(self, topic: str, kind: InterfaceType, path: FieldPath) -> Unit | None:
        """Return a field's unit: as an input, the system or a node declares it, or as usual."""
        for key in ((topic, path), *_arrays((topic, path))):
            if key in self._declared:
                return self._declared[key].unit
        told = self._told(topic, path)
        return told if told is not None else usual_unit(self._store, self._units, kind, path)

    def _told(self, topic: str, path: FieldPath) -> Unit | None:
        """Return a field's unit as the system or a node declares it."""
        known = self._topics.get(topic)
        text = known.unit_of(path) if known is not None else None
        return self._units.parse(text) if text is not None else None

    def full_turn(self, unit: Unit | None) -> float | None:
        """Return a full turn in a unit of angles; ``None`` for any other."""
        degree = self._units.parse("deg")
        if unit is None or degree is None or not self._units.compatible(unit, degree):
            return None
        return rounded(360 * degree.factor / unit.factor)

    def share_bounds(self, topic: str, kind: InterfaceType, path: FieldPath) -> Ends | None:
        """Return the bounds of a field that its message keeps from 0 to 1, in the field's unit."""
        unit = self.unit_of(topic, kind, path)
        if unit is None or unit.exponents or not is_share(self._store, kind, path):
            return None
        least, greatest = SHARE
        return least / unit.factor, greatest / unit.factor

    def turn_of(self, topic: str, kind: InterfaceType, path: FieldPath) -> float | None:
        """Return the full turn by which a field wraps around, if it does."""
        known = self._topics.get(topic)
        if (known is not None and known.is_wrapping(path)) or is_wrapping(self._store, kind, path):
            return self.full_turn(self.unit_of(topic, kind, path))
        return None

    # What the program declares and uses ----------------------------------------------------------

    def declare(
        self, topic: str, kind: InterfaceType, path: FieldPath, unit: Unit, span: Span
    ) -> Iterator[Diagnostic]:
        """Take the unit that an input declares, and yield how others contradict it."""
        use, key = _Use(unit, span), (topic, path)
        told = self._told(topic, path)
        if told is not None and not is_same(told, unit):
            message = f"'{_shown(key)}' is in {unit} here, and in {told} in the system"
            hint = "omit the unit here, or declare the same one in both places"
            yield report(codes.FIELD_IN_TWO_UNITS, message, span, hint)
        expected = usual_unit(self._store, self._units, kind, path)
        if told is None and expected is not None and not self._units.compatible(unit, expected):
            yield report(
                codes.UNIT_CONFLICTS_WITH_REP103,
                f"REP 103 gives '{_shown(key)}' in {expected}, and {unit} has another dimension",
                span,
                f"publish the field in {expected}, and omit the unit",
            )
        first = self._declared.setdefault(key, use)
        if not is_same(first.unit, unit):
            yield _two_units(key, first, use)

    def use(self, fields: tuple[FieldKey, ...], unit: Unit | None, span: Span) -> None:
        """Note that fields without a known unit are read in a unit, or as plain numbers."""
        for key in fields:
            self._uses.setdefault(key, []).append(_Use(unit, span))

    def undeclared(
        self, fields: tuple[FieldKey, ...], quantity: str, place: Span
    ) -> Iterator[Diagnostic]:
        """Yield, once for a field, that it is computed with beside a quantity."""
        if not self._asked.issuperset(fields):
            self._asked |= {*fields}
            field = _shown(fields[0])
            yield report(
                codes.UNIT_NOT_DECLARED,
                f"the unit of '{field}' is not known: what is computed of it cannot be held"
                f" against '{quantity}'",
                place,
                f"declare it where the field is named: 'input NAME = topic {field} [UNIT]'",
            )

    def compare(self, one: tuple[FieldKey, ...], other: tuple[FieldKey, ...]) -> None:
        """Note that two fields without a known unit are compared: they are in the same one."""
        self._alike += ((first, second) for first in one for second in other)

    def conflicts(self) -> Iterator[Diagnostic]:
        """Yield each use of a field in another unit than its first use, in the whole program.

        Elements of an array may be in different units, unless they are read all at once.
        """
        known = {key: [use] for key, use in self._declared.items()}
        every = known | {key: known.get(key, []) + uses for key, uses in self._uses.items()}
        group = {key: key for key in every}
        arrays = ((each, key) for key in every for each in _arrays(key) if each in every)
        for one, other in (*self._alike, *arrays):
            kept, joined = (group.setdefault(key, key) for key in (one, other))
            group = {key: kept if each == joined else each for key, each in group.items()}
        firsts: dict[FieldKey, _Use] = {}
        for key, uses in every.items():
            first = firsts.setdefault(group[key], uses[0])
            differing = [each for each in uses if not is_same(first.unit, each.unit)]
            for use in differing[:1]:
                yield _two_units(key, first, use)


def _arrays(key: FieldKey) -> Iterator[FieldKey]:
    """Yield the arrays that a field may be an element of, as they are read all at once."""
    topic, path = key
    if path and isinstance(path[-1], int):
        yield topic, path[:-1]
    if (plain := without_indices(path)) != path:
        yield topic, plain


def plain_beside(number: Fraction, computed: str, unit: Unit, place: Span) -> Iterator[Diagnostic]:
    """Yield that a plain number beside what is computed would be in a unit that nobody sees.

    Zero is the same in every unit.
    """
    if not number or is_seen(unit):
        return
    bases = in_bases(unit).text
    base = "" if bases == "1" else f" {bases}"
    readings = (
        f"'{place.text}{base}'",
        f"'{place.text} {unit}' ({_decimal(number * unit.factor)}{base})",
    )
    yield report(
        codes.PLAIN_BESIDE_COMPUTED,
        f"the plain number '{place.text}' stands beside '{computed}', which is in {unit}",
        place,
        f"write which one is meant: {' or '.join(readings)}",
    )


def _two_units(key: FieldKey, first: _Use, other: _Use) -> Diagnostic:
    field = _shown(key)
    return report(
        codes.FIELD_IN_TWO_UNITS,
        f"'{field}' is {other.shown} here, and {first.shown} elsewhere; one field has one unit",
        other.span,
        f"declare its unit where the field is named: 'input NAME = topic {field} [UNIT]'",
        (Related(first.span, f"{first.shown} here"),),
    )


def _shown(key: FieldKey) -> str:
    topic, path = key
    return f"{topic}.{format_path(path)}" if path else topic


def _decimal(number: Fraction) -> str:
    return f"{float(number):.6g}"
