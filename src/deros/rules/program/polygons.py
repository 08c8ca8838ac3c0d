"""Polygons with exact corners: whether their edges meet, and the convex parts that they consist of.

Coordinates are fractions, so that nothing here depends on rounding. Edges and corners are numbered
from 0; edge ``n`` leads from corner ``n`` to the next one, the last edge back to corner 0.

Source: J. O'Rourke, Computational Geometry in C, 2nd edition, sections 1.4 to 1.6.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction

Corner = tuple[Fraction, Fraction]


def turn(a: Corner, b: Corner, c: Corner) -> Fraction:
    """Return twice the area of a triangle: positive if it is to the left from ``a`` to ``b``."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])


def twice_area(corners: Sequence[Corner]) -> Fraction:
    """Return twice the area of a polygon, positive if its corners go round counter-clockwise."""
    pairs = zip(corners, (*corners[1:], corners[0]), strict=True)
    return sum((a[0] * b[1] - b[0] * a[1] for a, b in pairs), Fraction(0))


def meeting_edges(corners: Sequence[Corner]) -> tuple[int, int] | None:
    """Return the first two edges that meet in more than the corner that they share."""
    count = len(corners)
    for first in range(count):
        for second in range(first + 1, count):
            one = corners[first], corners[(first + 1) % count]
            other = corners[second], corners[(second + 1) % count]
            if _share_more_than_a_corner(one, other):
                return first, second
    return None


def _share_more_than_a_corner(one: tuple[Corner, Corner], other: tuple[Corner, Corner]) -> bool:
    if one[1] == other[0]:
        return _folds_back(one[0], one[1], other[1])
    if other[1] == one[0]:
        return _folds_back(other[0], other[1], one[1])
    return _meet(one, other)


def _folds_back(a: Corner, b: Corner, c: Corner) -> bool:
    """Return whether the way from ``b`` to ``c`` begins on that from ``a`` to ``b``."""
    product = (a[0] - b[0]) * (c[0] - b[0]) + (a[1] - b[1]) * (c[1] - b[1])
    return turn(a, b, c) == 0 and product > 0


def _meet(one: tuple[Corner, Corner], other: tuple[Corner, Corner]) -> bool:
    """Return whether two segments have a point in common, their ends included."""
    (a, b), (c, d) = one, other
    sides = turn(a, b, c), turn(a, b, d), turn(c, d, a), turn(c, d, b)
    if sides[0] * sides[1] < 0 and sides[2] * sides[3] < 0:
        return True
    ends = zip(sides, (one, one, other, other), (c, d, a, b), strict=True)
    return any(side == 0 and _is_in_box(segment, end) for side, segment, end in ends)


def _is_in_box(segment: tuple[Corner, Corner], point: Corner) -> bool:
    return all(min(a, b) <= value <= max(a, b) for a, b, value in zip(*segment, point, strict=True))


# Convex parts -------------------------------------------------------------------------------------


def convex_parts(corners: Sequence[Corner]) -> list[tuple[int, ...]]:
    """Return the corners of convex parts that make up a polygon, each part counter-clockwise.

    Parts share the diagonals between them. The polygon has an area, and no two of its edges meet.

    Raises:
        ValueError: it is not such a polygon, and so cannot be cut into parts.
    """
    numbers = tuple(range(len(corners)))
    return list(_parts(corners, numbers if twice_area(corners) > 0 else numbers[::-1]))


def _parts(corners: Sequence[Corner], part: tuple[int, ...]) -> Iterator[tuple[int, ...]]:
    points = [corners[number] for number in part]
    count = len(part)
    inward = [n for n in range(count) if _turn_at(points, n) < 0]
    if not inward:
        yield part
        return
    start = inward[0]
    ends = [end for end in range(count) if _is_diagonal(points, start, end)]
    if not ends:
        raise ValueError("no diagonal cuts the polygon")
    end = max(ends, key=lambda each: (_is_cut(points, start, each), each in inward))
    low, high = sorted((start, end))
    yield from _parts(corners, part[low : high + 1])
    yield from _parts(corners, part[high:] + part[: low + 1])


def _turn_at(points: Sequence[Corner], place: int) -> Fraction:
    return turn(points[place - 1], points[place], points[(place + 1) % len(points)])


def _is_cut(points: Sequence[Corner], start: int, end: int) -> bool:
    """Return whether a diagonal leaves no inward corner where it starts."""
    a, b = points[start], points[end]
    before, after = points[start - 1], points[(start + 1) % len(points)]
    return turn(before, a, b) >= 0 and turn(b, a, after) >= 0


def _is_diagonal(points: Sequence[Corner], start: int, end: int) -> bool:
    """Return whether the way between two corners is inside and meets no edge in between."""
    count = len(points)
    if (start - end) % count in (0, 1, count - 1):
        return False
    if not (_begins_inside(points, start, end) and _begins_inside(points, end, start)):
        return False
    others = (
        (points[n], points[(n + 1) % count])
        for n in range(count)
        if not {n, (n + 1) % count} & {start, end}
    )
    return not any(_meet((points[start], points[end]), edge) for edge in others)


def _begins_inside(points: Sequence[Corner], start: int, end: int) -> bool:
    """Return whether the way from a corner to another one begins between the edges there."""
    a, b = points[start], points[end]
    before, after = points[start - 1], points[(start + 1) % len(points)]
    if _turn_at(points, start) >= 0:
        return turn(a, b, before) > 0 and turn(b, a, after) > 0
    return not (turn(a, b, after) >= 0 and turn(b, a, before) >= 0)
