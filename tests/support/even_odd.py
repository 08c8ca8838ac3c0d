"""Polygons for tests, and a second reading of them: how often a ray crosses the edges."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from hypothesis import strategies as st

from deros.rules.program.polygons import meeting_edges
from deros.rules.program.zones import Polygon

Corner = tuple[Fraction, Fraction]


def is_inside(corners: Sequence[Corner], point: Corner) -> bool:
    """Return whether a point is in a polygon or on its edge, computed with fractions."""
    x, y = point
    inside = False
    for (ax, ay), (bx, by) in zip(corners, (*corners[1:], corners[0]), strict=True):
        side = (bx - ax) * (y - ay) - (x - ax) * (by - ay)
        if side == 0 and min(ax, bx) <= x <= max(ax, bx) and min(ay, by) <= y <= max(ay, by):
            return True
        if (ay <= y) != (by <= y) and (side > 0) == (by > ay):
            inside = not inside
    return inside


def untangled(corners: Sequence[Corner]) -> list[Corner]:
    """Return corners in an order in which edges rarely meet: two that do are exchanged."""
    found = list(corners)
    for _ in range(30):
        edges = meeting_edges(found)
        if edges is None:
            break
        first, second = edges
        found[first + 1 : second + 1] = found[first + 1 : second + 1][::-1]
    return found


def _refined(corners: Sequence[Corner], halved: set[int]) -> list[Corner]:
    """Return corners with one more in the middle of each of the edges that are numbered."""
    found: list[Corner] = []
    for number, (a, b) in enumerate(zip(corners, (*corners[1:], corners[0]), strict=True)):
        found += [a, ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2)] if number in halved else [a]
    return found


def _is_area(corners: Sequence[Corner]) -> bool:
    """Return whether the check takes a polygon: as it is written, and as doubles."""
    rounded = [(Fraction(float(x)), Fraction(float(y))) for x, y in corners]
    return meeting_edges(corners) is None and meeting_edges(rounded) is None


_tenths = st.integers(-30, 30).map(lambda number: Fraction(number, 10))
POLYGONS = (
    st.builds(
        _refined,
        st.lists(st.tuples(_tenths, _tenths), min_size=3, max_size=8, unique=True).map(untangled),
        st.sets(st.integers(0, 7), max_size=2),
    )
    .filter(_is_area)
    .map(lambda corners: Polygon(tuple((float(x), float(y)) for x, y in corners)))
)
"""Polygons that the check takes, some with corners in the middle of straight edges."""
