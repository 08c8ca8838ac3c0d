"""``tools/prove.py``: the share of the functions that a commit proves."""

from __future__ import annotations

from tools.prove import drawn

FUNCTIONS = [f"function_{number}" for number in range(40)]


def test_share_is_decided_by_the_text() -> None:
    """The same commit proves the same functions, and another commit proves others."""
    assert drawn(FUNCTIONS, 0.25, "a") == drawn(FUNCTIONS[::-1], 0.25, "a")
    assert set(drawn(FUNCTIONS, 0.25, "a")) != set(drawn(FUNCTIONS, 0.25, "b"))
    assert len(drawn(FUNCTIONS, 0.25, "a")) == 10


def test_every_function_is_drawn_by_some_commit() -> None:
    """Within a hundred commits each function is proved several times."""
    commits = [drawn(FUNCTIONS, 0.15, str(number)) for number in range(100)]
    assert min(sum(each in functions for functions in commits) for each in FUNCTIONS) >= 5


def test_smallest_share_is_one_function() -> None:
    """A share is never empty, because a proof of nothing would pass."""
    assert len(drawn(FUNCTIONS, 0.0, "a")) == 1
