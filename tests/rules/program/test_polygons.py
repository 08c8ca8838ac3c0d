"""Polygons: which edges meet, and that the convex parts are the whole."""

from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from deros.rules.program.polygons import Corner, convex_parts, meeting_edges, turn, twice_area
from tests.support.even_odd import is_inside, untangled

grid = st.integers(0, 5).map(Fraction)
corners = st.lists(st.tuples(grid, grid), min_size=3, max_size=9, unique=True).map(untangled)


def exact(*pairs: tuple[int, int]) -> list[Corner]:
    """Return corners as fractions."""
    return [(Fraction(x), Fraction(y)) for x, y in pairs]


@pytest.mark.parametrize(
    ("polygon", "edges"),
    [
        pytest.param(exact((0, 0), (4, 0), (4, 3)), None, id="triangle"),
        pytest.param(exact((0, 0), (2, 0), (4, 0), (4, 3)), None, id="corner on a line"),
        pytest.param(exact((0, 0), (2, 2), (2, 0), (0, 2)), (0, 2), id="eight"),
        pytest.param(exact((0, 0), (4, 0), (4, 3), (2, 0), (0, 3)), (0, 2), id="corner on an edge"),
        pytest.param(exact((0, 0), (4, 0), (2, 0), (2, 3)), (0, 1), id="edge folded back"),
        pytest.param(exact((2, 0), (4, 0), (4, 3), (5, 0)), (0, 3), id="last edge folded back"),
        pytest.param(exact((0, 0), (9, 0), (9, 1), (8, 0), (1, 0)), (0, 2), id="edge on an edge"),
    ],
)
def test_edges_that_meet_are_found(polygon: list[Corner], edges: tuple[int, int] | None) -> None:
    """Crossing, touching and lying on one another count; sharing a corner does not."""
    found = meeting_edges(polygon)
    assert (found is None) == (edges is None)
    if edges is not None:
        assert found == edges


@given(corners)
def test_convex_parts_make_up_the_polygon(polygon: list[Corner]) -> None:
    """Each goes round counter-clockwise without a turn to the right, and their areas add up."""
    assume(meeting_edges(polygon) is None)
    parts = [[polygon[number] for number in part] for part in convex_parts(polygon)]
    assert sum(map(twice_area, parts)) == abs(twice_area(polygon))
    for part in parts:
        assert len(part) >= 3
        turns = [turn(part[n - 2], part[n - 1], part[n]) for n in range(len(part))]
        assert min(turns) >= 0
        assert twice_area(part) > 0


@given(corners, st.tuples(st.integers(-1, 11), st.integers(-1, 11)))
def test_a_point_is_in_a_part_if_it_is_in_the_polygon(
    polygon: list[Corner], place: tuple[int, int]
) -> None:
    """Held against counting the edges that a ray crosses, the edge included."""
    assume(meeting_edges(polygon) is None)
    point = Fraction(place[0], 2), Fraction(place[1], 2)
    parts = [[polygon[number] for number in part] for part in convex_parts(polygon)]
    assert any(is_inside(part, point) for part in parts) == is_inside(polygon, point)


def test_what_is_no_polygon_has_no_parts() -> None:
    """A corner on an edge blocks every diagonal: it is refused, not guessed."""
    folded = exact((4, 4), (1, 2), (4, 3), (4, 0))
    assert meeting_edges(folded) is not None
    with pytest.raises(ValueError, match="no diagonal"):
        convex_parts(folded)
