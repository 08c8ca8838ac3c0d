"""How many entries of arrays satisfy a condition: the reference at its edges."""

from __future__ import annotations

import pytest

from deros.rules.functions.function_values import matches
from deros.rules.program.formulas import Expression, Logical, Name, Negation, Number, Relation

INFRINGED = Logical("and", (Name("x1"), Negation(Name("x2"))))
HOT = Relation(">", Name("x1"), Number(80.0))


@pytest.mark.parametrize(
    ("entry", "arrays", "count"),
    [
        (INFRINGED, ([True, True, False], [False, True, False]), 1),
        (INFRINGED, ([False], [False]), 0),
        (INFRINGED, ([], []), None),
        (INFRINGED, ([True, True], [False]), None),
        (INFRINGED, ([True], []), None),
        (HOT, ([79.5, 80.0, 80.5, float("inf")],), 2),
        (HOT, ([],), None),
    ],
)
def test_matches_are_counted(
    entry: Expression, arrays: tuple[list[float], ...], count: int | None
) -> None:
    """Empty arrays, and arrays of different lengths, have no count."""
    assert matches(entry, ("x1", "x2")[: len(arrays)], arrays) == count
