"""Beams and zones: the sector of a zone, its reach, and the points that beams show in it."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deros.rules.program.beams import beam_formula, reach, sector
from deros.rules.program.formulas import evaluate
from deros.rules.program.polygons import meeting_edges
from deros.rules.program.zones import Circle, Polygon, Rectangle, Shape
from tests.support.drawn_zones import ZONES
from tests.support.even_odd import POLYGONS

AROUND = (-math.pi, math.pi)
tenths = st.integers(-30, 30).map(lambda number: number / 10)
circles = st.builds(Circle, st.tuples(tenths, tenths), st.integers(1, 30).map(lambda n: n / 10))


def shows(shape: Shape, distance: float, bearing: float) -> bool:
    """Return whether the point that a beam shows is in a zone."""
    return evaluate(beam_formula(shape), {"distance": distance, "bearing": bearing}) > 0.0


def looks(shape: Shape, bearing: float) -> bool:
    """Return whether a bearing is in the sector of a zone, as scans take it."""
    start, end = sector(shape)
    width = end - start if end >= start else end - start + 2.0 * math.pi
    offset = (bearing - start) % (2.0 * math.pi)
    return offset <= width + 1e-6 or offset >= 2.0 * math.pi - 1e-6


@pytest.mark.parametrize(
    ("shape", "degrees"),
    [
        (Rectangle((1.0, -1.0), (2.0, 1.0)), (-45, 45)),
        (Rectangle((-2.0, -1.0), (-1.0, 1.0)), (135, -135)),
        (Rectangle((-1.0, 1.0), (1.0, 2.0)), (45, 135)),
        (Circle((2.0, 0.0), 1.0), (-30, 30)),
        (Circle((-2.0, 0.0), 1.0), (150, -150)),
        (Polygon(((1.0, 0.0), (2.0, 2.0), (0.0, 1.0))), (0, 90)),
        # It winds around the sensor, but for what lies ahead.
        (
            Polygon(
                (
                    *((1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)),
                    *((2.0, -2.0), (-2.0, -2.0), (-2.0, 2.0), (2.0, 2.0)),
                )
            ),
            (45, -45),
        ),
    ],
)
def test_a_sector_holds_its_zone_and_no_more(shape: Shape, degrees: tuple[int, int]) -> None:
    """Counter-clockwise, through the back where the end is the lesser."""
    start, end = sector(shape)
    assert (math.degrees(start), math.degrees(end)) == pytest.approx(degrees)


@pytest.mark.parametrize(
    "shape",
    [
        Rectangle((-1.0, -1.0), (1.0, 1.0)),
        Rectangle((0.0, -1.0), (1.0, 1.0)),
        Rectangle((0.0, 0.0), (1.0, 1.0)),
        Circle((0.5, 0.0), 1.0),
        Circle((3.0, 4.0), 5.0),
        Polygon(((-1.0, -1.0), (2.0, 0.0), (1.0, 1.0))),
        Polygon(((0.0, 0.0), (2.0, 0.0), (1.0, 1.0))),
    ],
)
def test_a_sensor_in_a_zone_looks_all_around(shape: Shape) -> None:
    """Also where it is on an edge or on a corner."""
    assert sector(shape) == AROUND


def test_a_zone_may_wind_around_the_sensor_more_than_once() -> None:
    """A spiral that ends behind its own beginning is seen all around, and does not hold it."""
    outer = [(3.0, 0.5), (3.0, 3.0), (-3.0, 3.0), (-3.0, -3.0), (5.0, -3.0), (5.0, 0.6), (4.0, 0.6)]
    inner = [(4.0, -2.0), (-2.0, -2.0), (-2.0, 2.0), (2.0, 2.0), (2.0, -0.5), (2.5, -0.5)]
    spiral = Polygon((*outer, *inner))
    assert meeting_edges([(Fraction(x), Fraction(y)) for x, y in spiral.corners]) is None
    assert sector(spiral) == AROUND
    assert not shows(spiral, 0.0, 0.0)


@given(POLYGONS | circles, st.floats(-math.pi, math.pi), st.floats(0.0, 5.0))
def test_no_point_of_a_zone_is_beyond_its_sector_or_its_reach(
    shape: Shape, bearing: float, distance: float
) -> None:
    """What the targets do not ask for is outside."""
    if shows(shape, distance, bearing):
        assert looks(shape, bearing)
        assert distance <= reach(shape)


@given(POLYGONS)
def test_the_farthest_corner_is_within_reach(shape: Polygon) -> None:
    """As a beam shows it, whatever is rounded; its bearing is in the sector."""
    for x, y in shape.corners:
        assert math.hypot(x, y) <= reach(shape)
        assert looks(shape, math.atan2(y, x))


def test_beams_along_an_axis_meet_edges_and_corners_exactly() -> None:
    """Straight ahead the point is the distance; the next double beyond the edge is outside."""
    ahead = Rectangle((0.3, 0.0), (1.2, 0.4))
    assert shows(ahead, 0.3, 0.0)
    assert shows(ahead, 1.2, 0.0)
    assert not shows(ahead, math.nextafter(0.3, 0.0), 0.0)
    assert not shows(ahead, math.nextafter(1.2, 2.0), 0.0)
    touching = Polygon(((1.0, 0.0), (2.0, 1.0), (2.0, -1.0)))
    assert shows(touching, 1.0, 0.0)
    assert not shows(touching, math.nextafter(1.0, 0.0), 0.0)


def test_a_beam_of_no_length_is_the_sensor() -> None:
    """What is too near to measure is where the sensor is, whatever the bearing."""
    for zone in ZONES:
        assert len({shows(zone.shape, 0.0, bearing) for bearing in (-2.0, 0.0, 1.0)}) == 1
