"""Of two nodes of one name, the later one exits."""

from __future__ import annotations

import pytest

from deros.generators.runtime.python.deros_runtime.start_order import PATIENCE, YOUNG, StartOrder

LOOK = 100_000_000
"""Interval between two checks of the graph, in ns."""

SEC = 1_000_000_000


def age_at_end(met: int, last: int = 20 * SEC) -> int | None:
    """Return the age at which a node exits after meeting another at a given age, or None."""
    order = StartOrder(0)
    ages = range(0, last, LOOK)
    return next((age for age in ages if order.gives_way(age >= met, age)), None)


def remaining(lag: int, found: int) -> tuple[bool, bool]:
    """Run two nodes, the second started ``lag`` later; return whether each of them remains.

    Args:
        lag: in ns.
        found: time after its start at which the second finds the first, and is found.
    """
    orders = [StartOrder(0), StartOrder(lag)]
    ends: list[int | None] = [None, None]
    for now, which in sorted(
        [(t, 0) for t in range(0, 20 * SEC, LOOK)] + [(t, 1) for t in range(lag, 20 * SEC, LOOK)]
    ):
        other = ends[1 - which]
        if ends[which] is None:
            has_double = now >= lag + found and (other is None or now < other + LOOK // 2)
            if orders[which].gives_way(has_double, now):
                ends[which] = now
    return ends[0] is None, ends[1] is None


@pytest.mark.parametrize(
    ("lag", "found"),
    [
        (lag, found)
        for lag in (3 * LOOK, 5 * LOOK + 1, SEC, 2 * SEC + 3, 4 * SEC, 6 * SEC, 19 * SEC // 2)
        for found in (0, LOOK // 3, 3 * LOOK, SEC)
    ],
)
def test_first_node_remains(lag: int, found: int) -> None:
    """This holds for any ages and phases of the two."""
    assert remaining(lag, found) == (True, False)


def test_node_waits_for_twice_its_age() -> None:
    """It adds a margin, because the other one may be ending."""
    for met in (0, SEC, 3 * SEC):
        assert age_at_end(met) == 2 * met + PATIENCE


def test_old_node_never_exits() -> None:
    """If two meet late, both remain, and an operator must act."""
    assert age_at_end(YOUNG) is None
    assert age_at_end(YOUNG - LOOK) is not None


def test_node_that_leaves_in_time_ends_no_other() -> None:
    """A node that appears later is a new encounter."""
    order = StartOrder(0)
    assert not order.gives_way(True, SEC)
    assert not order.gives_way(True, 2 * SEC)
    assert not order.gives_way(False, 2 * SEC + LOOK)
    assert not order.gives_way(True, 3 * SEC)
    assert not order.gives_way(True, 6 * SEC)
    assert order.gives_way(True, 6 * SEC + PATIENCE)
