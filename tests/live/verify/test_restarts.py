"""Which nodes start too often, from the names that are seen."""

from __future__ import annotations

from deros.interfaces.durations import NS_PER_S
from deros.live.verify.restarts import MOST, WITHIN_S, Restarts


def starting(restarts: Restarts, second: float, *names: str) -> list[str]:
    """Return the nodes that start too often after a look."""
    return [each.node for each in restarts.look(round(second * NS_PER_S), names)]


def test_nodes_that_are_there_or_come_once_are_not_reported() -> None:
    """Nor is what is gone, or a node that the system does not have."""
    restarts = Restarts({"/a", "/b"})
    assert starting(restarts, 0, "/a", "/x") == []
    for second in range(1, 20):
        there = ["/a", "/b"] if second % 2 else ["/a", "/b", "/x"]
        assert starting(restarts, second, *there) == []
    assert starting(restarts, 21) == []


def test_starts_count_for_a_minute() -> None:
    """As many as are allowed are not reported, and one more is, until the first is long ago."""
    restarts = Restarts({"/a"})
    assert starting(restarts, 0, "/a") == []
    for start in range(MOST):
        assert starting(restarts, 10 * start + 1) == []
        assert starting(restarts, 10 * start + 2, "/a") == []
    last = 10 * MOST + 2
    assert starting(restarts, last - 1) == []
    assert starting(restarts, last, "/a") == ["/a"]
    assert starting(restarts, 2 + WITHIN_S, "/a") == ["/a"]
    assert starting(restarts, 3 + WITHIN_S, "/a") == []


def test_node_that_is_killed_counts_though_its_name_stays() -> None:
    """Its successor is a second one of that name, until the lease of the first ends."""
    restarts = Restarts({"/a"})
    looks = [1, 2, 3, 2, 3, 2, 1]
    found = [starting(restarts, at, *["/a"] * count) for at, count in enumerate(looks)]
    assert found == [[], [], [], [], ["/a"], ["/a"], ["/a"]]
