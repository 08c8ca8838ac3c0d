"""Beams and zones: which beams look into a zone, and whether one shows a point in it.

The zone is in the coordinates of the sensor, whose origin the beams start from. What is inside says
:mod:`deros.rules.program.zones`, whose condition the reference engine interprets and the targets
print; the sector and the reach only say for which beams it need not be asked.
"""

from __future__ import annotations

import math
from functools import lru_cache
from itertools import accumulate, pairwise

from deros.rules.program.formulas import Binary, Call, Choice, Expression, Formula, Name, Number
from deros.rules.program.zones import Circle, Place, Polygon, Rectangle, Shape, X, Y, is_inside

DISTANCE, BEARING = Name("distance"), Name("bearing")
"""What a beam shows, and its direction, as the names of :func:`beam_formula`; both are finite."""

_ALL_AROUND = (-math.pi, math.pi)
_ROUNDING = 1e-12
"""By which part a distance may come out too short; a point is computed with errors of 1e-16."""


@lru_cache(maxsize=64)
def beam_formula(shape: Shape) -> Formula:
    """Return the formula of :data:`DISTANCE` and :data:`BEARING` that is 1 if a zone has the point.

    Raises:
        ValueError: a polygon has no area, or edges that meet.
    """
    named: dict[str, Expression] = {
        X.name: Binary("*", DISTANCE, Call("cos", (BEARING,))),
        Y.name: Binary("*", DISTANCE, Call("sin", (BEARING,))),
    }
    condition = is_inside(shape, named)
    return Formula(tuple(named.items()), Choice(condition, Number(1.0), Number(0.0)))


def reach(shape: Shape) -> float:
    """Return a distance that no point of a zone exceeds."""
    if isinstance(shape, Circle):
        farthest = math.hypot(*shape.centre) + shape.radius
    else:
        farthest = max(math.hypot(x, y) for x, y in corners(shape))
    return farthest * (1.0 + _ROUNDING)


def sector(shape: Shape) -> tuple[float, float]:
    """Return the bearings between which a zone lies, counter-clockwise, in radians.

    It is all around where the sensor is in the zone, or on its edge. The sector of a zone that
    winds around the sensor holds all of it.
    """
    if isinstance(shape, Circle):
        distance = math.hypot(*shape.centre)
        if distance <= shape.radius:
            return _ALL_AROUND
        middle, half = math.atan2(*shape.centre[::-1]), math.asin(shape.radius / distance)
        return _between(middle - half, middle + half)
    places = corners(shape)
    if _holds_sensor(places):
        return _ALL_AROUND
    first = places[0]
    turns = [0.0, *accumulate(_turn(*edge) for edge in pairwise((*places, first)))]
    start = math.atan2(first[1], first[0])
    return _between(start + min(turns), start + max(turns))


def corners(shape: Polygon | Rectangle) -> tuple[Place, ...]:
    """Return the corners of a zone, in order."""
    if isinstance(shape, Polygon):
        return shape.corners
    (left, bottom), (right, top) = shape.least, shape.greatest
    return ((left, bottom), (right, bottom), (right, top), (left, top))


def _turn(place: Place, other: Place) -> float:
    """Return by which angle one place lies to the left of another one, seen from the sensor."""
    (x, y), (other_x, other_y) = place, other
    return math.atan2(x * other_y - y * other_x, x * other_x + y * other_y)


def _holds_sensor(places: tuple[Place, ...]) -> bool:
    """Return whether the origin is inside or on an edge; within rounding it counts as on it."""
    turns = []
    for place, other in pairwise((*places, places[0])):
        if math.hypot(*place) == 0.0 or _passes(place, other):
            return True
        turns.append(_turn(place, other))
    return abs(sum(turns)) > math.pi


def _passes(place: Place, other: Place) -> bool:
    """Return whether the edge between two places passes through the origin, within rounding."""
    along = math.hypot(other[0] - place[0], other[1] - place[1])
    away = abs(place[0] * other[1] - place[1] * other[0]) / along
    far = max(math.hypot(*place), math.hypot(*other))
    return away <= far * _ROUNDING and abs(_turn(place, other)) > math.pi / 2.0


def _between(start: float, end: float) -> tuple[float, float]:
    """Return bearings from -pi to pi; ``end`` is the lesser where a sector passes the back."""
    if end - start >= 2.0 * math.pi:
        return _ALL_AROUND
    return math.remainder(start, 2.0 * math.pi), math.remainder(end, 2.0 * math.pi)
