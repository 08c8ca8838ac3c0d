"""Polygons for tests, and a second reading of them: how often a ray crosses the edges."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from deros.rules.program.polygons import meeting_edges

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
