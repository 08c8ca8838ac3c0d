"""Sets of assignments agree with lists of all that are in them."""

from __future__ import annotations

import functools
import operator
from collections.abc import Sequence

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deros.systems.arguments import diagrams
from deros.systems.arguments.diagrams import Assignments, Diagrams, TooManyCombinations
from deros.systems.arguments.numbering import Numbering
from tests.support.enumerated import deviations, positions_of

SIZES = (2, 3, 2, 2, 4)
ALL = [positions_of(each, SIZES) for each in deviations(SIZES)]

Listed = frozenset[tuple[int, ...]]

cubes = st.dictionaries(st.integers(0, len(SIZES) - 1), st.integers(0, 1), max_size=3)
operations = st.lists(st.tuples(st.sampled_from("&|-"), cubes), min_size=1, max_size=12)


def _both(
    drawn: Sequence[tuple[str, dict[int, int]]], made: Diagrams
) -> tuple[Assignments, Listed]:
    """Return what operations make of the full set, as a diagram and as a list."""
    found, listed = made.full, frozenset(ALL)
    for word, cube in drawn:
        other = made.cube(cube)
        others = frozenset(
            each for each in ALL if all(each[place] == position for place, position in cube.items())
        )
        if word == "&":
            found, listed = found & other, listed & others
        elif word == "|":
            found, listed = found | other, listed | others
        else:
            found, listed = found - other, listed - others
    return found, listed


@given(one=operations, other=operations)
def test_sets_are_those_of_lists(
    one: list[tuple[str, dict[int, int]]], other: list[tuple[str, dict[int, int]]]
) -> None:
    """Of any two sets, all operations, which members there are, and whether they are equal."""
    made = Diagrams(SIZES)
    (first, listed), (second, others) = _both(one, made), _both(other, made)
    for found, expected in (
        (first, listed),
        (first & second, listed & others),
        (first | second, listed | others),
        (first - second, listed - others),
        (made.full - first, frozenset(ALL) - listed),
    ):
        members = {each for each in ALL if made.cube(dict(enumerate(each))) & found}
        assert members == expected
        assert bool(found) == bool(expected)
    assert (first == second) == (listed == others)


@given(drawn=operations)
def test_smallest_and_first_members(drawn: list[tuple[str, dict[int, int]]]) -> None:
    """The smallest differs in the fewest places, then in earlier ones; the first by its values."""
    found, listed = _both(drawn, Diagrams(SIZES))
    if listed:
        smallest = next(each for each in ALL if each in listed)
        assert positions_of(found.smallest, SIZES) == smallest
        assert found.first == min(listed)


@pytest.mark.parametrize("sizes", [(), (2,), (4,), (2, 2, 2, 2), (3, 2, 4), SIZES, (5, 5, 5)])
def test_numbers_are_places_in_the_list(sizes: tuple[int, ...]) -> None:
    """Both ways, for every combination."""
    numbering = Numbering(sizes)
    listed = list(deviations(sizes))
    assert numbering.count == len(listed)
    assert [numbering.number(each) for each in listed] == list(range(len(listed)))
    assert [numbering.deviation(number) for number in range(len(listed))] == listed


def test_sets_of_very_many_arguments() -> None:
    """Neither their count nor the depth of a diagram is limited by recursion."""
    count = 5_000
    made = Diagrams([2] * count)
    none = made.full
    for place in reversed(range(count)):
        none -= made.cube({place: 1})
    assert none.smallest == (0, (), ())
    assert (made.full - none).smallest == (1, (0,), (1,))
    assert (made.full - none) & none == made.empty


def test_work_is_limited(monkeypatch: pytest.MonkeyPatch) -> None:
    """A diagram whose arguments come in a bad order doubles with each of them."""
    monkeypatch.setattr(diagrams, "MOST_STEPS", 20_000)
    half = 20
    made = Diagrams([2] * 2 * half)
    equal = [
        made.cube({place: 0, half + place: 0}) | made.cube({place: 1, half + place: 1})
        for place in range(half)
    ]
    with pytest.raises(TooManyCombinations):
        functools.reduce(operator.and_, equal, made.full)
