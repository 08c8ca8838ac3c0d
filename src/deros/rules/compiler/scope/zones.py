"""The zones of a program: whether each is an area, and its shape for the points of a field."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction

from deros import codes
from deros.diagnostics import Diagnostic, Fix, Related, Span, report
from deros.interfaces.types import FieldType
from deros.interfaces.units import Unit
from deros.models import rules
from deros.rules.compiler.scope.lengths import unit_of_length
from deros.rules.compiler.scope.resolved import Mounted
from deros.rules.compiler.scope.scope import Scope
from deros.rules.program import polygons, zones
from deros.rules.program.bounds import rounded_as

MOST_CORNERS = 64
"""The most corners of a polygon; a monitor compares a point with every edge."""

FARTHEST_M = 10**7
"""The greatest coordinate of a zone, in metres: the length of a meridian quadrant."""


@dataclass(frozen=True, slots=True)
class DeclaredZone:
    """A zone that is an area, with its unit of length."""

    written: rules.Zone
    unit: Unit

    def shape(
        self, unit: Unit | None, kind: FieldType, mounted: Mounted | None = None
    ) -> zones.Shape:
        """Return the shape for points with coordinates in a unit, as numbers of their type.

        Without a unit, the coordinates are in that of the zone. With a mounting they are those of
        the sensor, in metres.

        Raises:
            ValueError: as numbers of that type, it is no area any more.
        """
        scale = self.unit.factor / unit.factor if unit is not None else Fraction(1)

        def number(value: Fraction) -> float:
            return rounded_as(value, kind)

        def place(x: Fraction, y: Fraction) -> zones.Place:
            if mounted is not None:
                x, y = mounted.seen(x, y)
            return number(x), number(y)

        def of(point: rules.Point) -> tuple[Fraction, Fraction]:
            return Fraction(point.x) * scale, Fraction(point.y) * scale

        found: zones.Shape
        match self.written.shape:
            case rules.Polygon(corners=corners):
                found = zones.Polygon(tuple(place(*of(each)) for each in corners))
            case rules.Circle(centre=centre, radius=radius):
                found = zones.Circle(place(*of(centre)), number(Fraction(radius) * scale))
            case rules.Rectangle(corner=corner, opposite=opposite):
                (x, y), (other_x, other_y) = of(corner), of(opposite)
                if mounted is None or 0 in (mounted.cosine, mounted.sine):
                    found = _rectangle(place(x, y), place(other_x, other_y))
                else:  # its sides are not along the axes of the sensor
                    around = ((x, y), (other_x, y), (other_x, other_y), (x, other_y))
                    found = zones.Polygon(tuple(place(*each) for each in around))
        if not _has_area(found):
            raise ValueError(f"zone '{self.written.name}' is no area as numbers of {kind}")
        return found


def _rectangle(corner: zones.Place, opposite: zones.Place) -> zones.Rectangle:
    (left, right), (bottom, top) = map(sorted, zip(corner, opposite, strict=True))
    return zones.Rectangle((left, bottom), (right, top))


def _has_area(shape: zones.Shape) -> bool:
    """Return whether a shape is still an area, as its numbers are rounded."""
    match shape:
        case zones.Polygon(corners=corners):
            return polygons.meeting_edges([(Fraction(x), Fraction(y)) for x, y in corners]) is None
        case zones.Circle(radius=radius):
            return radius > 0.0
        case zones.Rectangle(least=(left, bottom), greatest=(right, top)):
            return left < right and bottom < top


class Zones:
    """The zones of a program by name; ``None`` is a zone with a fault, which has been reported."""

    def __init__(self, scope: Scope, program: rules.Rules) -> None:
        """Check the zones that the rules declare; every fault is reported to the scope."""
        self.declared: dict[str, DeclaredZone | None] = {}
        self._scope = scope
        self._check_names(program)
        for each in program.zones:
            self.declared.setdefault(each.name.text, self._declare(each))

    def _check_names(self, program: rules.Rules) -> None:
        others = [each.name for each in program.constants]
        others += [each.name for each in program.inputs]
        first = {name.text: name for name in reversed(others)}
        for name in (each.name for each in program.zones):
            earlier = first.setdefault(name.text, name)
            if earlier is not name:
                message = f"constant, input or zone '{name}' is declared twice"
                related = (Related(earlier.span, "first declared here"),)
                self._scope.fault(codes.DUPLICATE_RULE_NAME, message, name.span, related=related)

    def _declare(self, zone: rules.Zone) -> DeclaredZone | None:
        unit = self._unit(zone)
        faults = list(_faults(zone, unit))
        self._scope.diagnostics += faults
        return None if unit is None or faults else DeclaredZone(zone, unit)

    def _unit(self, zone: rules.Zone) -> Unit | None:
        named = f"zone '{zone.name}'"
        written, span, place = zone.unit, zone.unit_span, zone.shape_span
        return unit_of_length(self._scope, written, span, place, named, "a zone")


def _faults(zone: rules.Zone, unit: Unit | None) -> Iterator[Diagnostic]:
    if zone.when_span is not None:
        message = "a zone that depends on a rule is not supported yet"
        hint = "declare a zone for each case, and name the one that counts in the rules"
        yield report(codes.UNSUPPORTED_ZONE, message, zone.when_span, hint)
    match zone.shape:
        case rules.Polygon(corners=corners):
            yield from _of_polygon(zone, corners)
            yield from _too_far(corners, unit)
        case rules.Circle(centre=centre, radius=radius, radius_span=place):
            if radius <= 0:
                message = f"a circle with the radius {radius} has no area"
                yield report(codes.ZONE_WITHOUT_AREA, message, place)
            yield from _too_far((centre, rules.Point(radius, radius, place)), unit)
        case rules.Rectangle(corner=corner, opposite=opposite):
            if corner.x == opposite.x or corner.y == opposite.y:
                message = "a rectangle between two corners on one side has no area"
                hint = "write two opposite corners: 'rectangle (0, 0) (4, 3) m'"
                yield report(codes.ZONE_WITHOUT_AREA, message, zone.shape_span, hint)
            yield from _too_far((corner, opposite), unit)


def _too_far(points: Iterable[rules.Point], unit: Unit | None) -> Iterator[Diagnostic]:
    """Yield the first point that is farther away than any place on the ground."""
    if unit is None:
        return
    for point in points:
        if max(abs(Fraction(point.x)), abs(Fraction(point.y))) * unit.factor > FARTHEST_M:
            message = f"'{point.span.text}' is more than {FARTHEST_M // 1000} km away"
            hint = "coordinates are those of the map, or of the robot, and small"
            yield report(codes.UNSUPPORTED_ZONE, message, point.span, hint)
            return


def _of_polygon(zone: rules.Zone, corners: tuple[rules.Point, ...]) -> Iterator[Diagnostic]:
    """Yield the first fault of a polygon: what comes later would only follow from it."""
    twice = list(_corners_twice(corners))
    exact = [(Fraction(each.x), Fraction(each.y)) for each in corners]
    if twice:
        yield from twice
    elif len(corners) < 3:
        message = f"a polygon needs three corners, this one has {len(corners)}"
        yield report(codes.ZONE_WITHOUT_AREA, message, zone.shape_span)
    elif len(corners) > MOST_CORNERS:
        message = f"a polygon has at most {MOST_CORNERS} corners, this one has {len(corners)}"
        hint = "leave out corners that are nearly on the line between their neighbours"
        yield report(codes.UNSUPPORTED_ZONE, message, corners[MOST_CORNERS].span, hint)
    elif all(polygons.turn(exact[0], exact[1], each) == 0 for each in exact):
        message = "all corners are on one line, so the polygon has no area"
        yield report(codes.ZONE_WITHOUT_AREA, message, zone.shape_span)
    elif (edges := polygons.meeting_edges(exact)) is not None:
        yield _meeting(corners, *edges)


def _corners_twice(corners: tuple[rules.Point, ...]) -> Iterator[Diagnostic]:
    numbers: dict[tuple[object, object], int] = {}
    for number, corner in enumerate(corners, 1):
        earlier = numbers.setdefault((corner.x, corner.y), number)
        if earlier == number:
            continue
        before, fix = corners[number - 2], None
        message = f"corner {number} is corner {earlier} again"
        hint = "each corner is written once"
        if earlier == number - 1 or (earlier == 1 and number == len(corners)):
            if earlier == 1 and number == len(corners):
                hint = "polygons close by themselves: leave out the last corner"
            fix = Fix(Span(corner.span.source, before.span.end, corner.span.end), "")
        related = (Related(corners[earlier - 1].span, f"corner {earlier}"),)
        yield report(codes.ZONE_CORNER_TWICE, message, corner.span, hint, related, fix)


def _meeting(corners: tuple[rules.Point, ...], first: int, second: int) -> Diagnostic:
    def edge(number: int) -> str:
        return f"{number + 1} to {(number + 1) % len(corners) + 1}"

    message = f"the edge from corner {edge(second)} meets the one from corner {edge(first)}"
    hint = "write the corners in the order in which one passes them, walking along the edges"
    related = (Related(corners[first].span, f"corner {first + 1}"),)
    return report(codes.ZONE_EDGES_MEET, message, corners[second].span, hint, related)
