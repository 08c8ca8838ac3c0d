"""Zones: what is inside of them, on the edge, at infinity, and where nothing is known."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st

from deros.rules.program.formulas import evaluate
from deros.rules.program.polygons import convex_parts
from deros.rules.program.zones import Circle, Polygon, Rectangle, Shape, Zone, zone_formula
from tests.support.drawn_zones import ZONES
from tests.support.even_odd import POLYGONS, is_inside

NOTCHED = Polygon(((0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (2.5, 1.5), (0.0, 3.0)))
tenths = st.integers(-30, 30).map(lambda number: number / 10)


def value(shape: Shape, x: float, y: float) -> float:
    """Return the value of a zone's formula at a point."""
    return evaluate(zone_formula(shape), {"x1": x, "x2": y})


def exact(shape: Polygon) -> list[tuple[Fraction, Fraction]]:
    """Return the corners as fractions of the doubles that they are."""
    return [(Fraction(x), Fraction(y)) for x, y in shape.corners]


def around(shape: Polygon, place: tuple[float, float]) -> set[bool]:
    """Return whether a place and those 1e-13 beside it are in a polygon, read exactly."""
    corners = exact(shape)
    beside = (0, Fraction(1, 10**13), -Fraction(1, 10**13))
    return {
        is_inside(corners, (Fraction(place[0]) + x, Fraction(place[1]) + y))
        for x in beside
        for y in beside
    }


@pytest.mark.parametrize(
    ("shape", "place", "inside"),
    [
        (NOTCHED, (1.0, 1.0), True),
        (NOTCHED, (2.0, 0.0), True),
        (NOTCHED, (3.25, 2.25), True),
        (NOTCHED, (4.0, 3.0), True),
        (NOTCHED, (2.5, 1.5), True),
        (NOTCHED, (2.5, 2.0), False),
        (NOTCHED, (2.5, math.nextafter(1.5, 2.0)), False),
        (NOTCHED, (4.0000001, 1.0), False),
        (NOTCHED, (0.0, math.nextafter(0.0, -1.0)), False),
        (Circle((1.0, -1.0), 0.5), (1.5, -1.0), True),
        (Circle((1.0, -1.0), 0.5), (1.3, -0.7), True),
        (Circle((1.0, -1.0), 0.5), (math.nextafter(1.5, 2.0), -1.0), False),
        (Circle((0.0, 0.0), 5.0), (-3.0, 4.0), True),
        (Rectangle((0.1, 0.2), (0.3, 0.4)), (0.1, 0.4), True),
        (Rectangle((0.1, 0.2), (0.3, 0.4)), (0.3, 0.2), True),
        (Rectangle((0.1, 0.2), (0.3, 0.4)), (math.nextafter(0.3, 1.0), 0.3), False),
        (Rectangle((0.1, 0.2), (0.3, 0.4)), (0.2, math.nextafter(0.2, 0.0)), False),
    ],
)
def test_edges_and_corners_are_inside(
    shape: Shape, place: tuple[float, float], inside: bool
) -> None:
    """The next double beyond them is not."""
    assert value(shape, *place) == float(inside)


@pytest.mark.parametrize("zone", ZONES, ids=lambda zone: zone.name)
def test_infinity_is_outside_and_nan_is_unknown(zone: Zone) -> None:
    """Whatever the other coordinate is; a comparison with NaN alone would say outside."""
    shape = zone.shape
    far = (math.inf, -math.inf)
    for other in (0.5, 0.0, *far):
        for end in far:
            assert value(shape, end, other) == value(shape, other, end) == 0.0
    for other in (0.5, *far, math.nan):
        assert math.isnan(value(shape, math.nan, other))
        assert math.isnan(value(shape, other, math.nan))


@given(POLYGONS)
@example(Polygon(((1.8, 0.3), (2.0, -0.5), (2.4, -2.1), (1.5, -0.2))))
@pytest.mark.essential
def test_corners_are_inside_in_every_bit(shape: Polygon) -> None:
    """Also those in the middle of an edge, whatever is rounded."""
    assert [value(shape, *corner) for corner in shape.corners] == [1.0] * len(shape.corners)


@given(POLYGONS, st.tuples(tenths, tenths))
def test_polygons_are_what_their_edges_enclose(shape: Polygon, place: tuple[float, float]) -> None:
    """Held against an exact reading; rounding decides only next to an edge."""
    assert bool(value(shape, *place)) in around(shape, place)


@given(POLYGONS, st.floats(0.001, 0.999))
@pytest.mark.essential
def test_no_point_falls_between_two_parts(shape: Polygon, share: float) -> None:
    """A point on a diagonal, as nearly as doubles are, is inside, unless it is next to an edge."""
    corners = exact(shape)
    parts = convex_parts(corners)
    assume(len(parts) > 1)
    for part in parts:
        for start, end in zip(part, (*part[1:], part[0]), strict=True):
            if (end - start) % len(corners) in (1, len(corners) - 1):
                continue  # an edge
            (x, y), (other_x, other_y) = shape.corners[start], shape.corners[end]
            place = x + share * (other_x - x), y + share * (other_y - y)
            assert bool(value(shape, *place)) in around(shape, place)
