"""Graces: which differences are reported, and when, given what each look has seen."""

from __future__ import annotations

from collections.abc import Sequence

from hypothesis import given
from hypothesis import strategies as st

from deros.live.verify.differences import Comparison, Difference, Kind
from deros.live.verify.graces import Event, Graces

GRACE = 5
MISSING = Difference(Kind.MISSING_NODE, "/lidar")
EXTRA = Difference(Kind.EXTRA_NODE, "/joker")
WRONG = Difference(Kind.WRONG_VALUE, "/lidar", "rate", "10.0", "20.0")
GRACES = {Kind.MISSING_NODE: GRACE, Kind.EXTRA_NODE: 2, Kind.WRONG_VALUE: 1}
GONE = Comparison((MISSING,), frozenset({("/lidar", "parameters")}))


def seen(*differences: Difference) -> Comparison:
    """Return a look that knows all."""
    return Comparison(differences)


def test_difference_is_reported_once_when_it_has_lasted_its_grace() -> None:
    """Not before, though it is seen at every look; its end once, too, with its whole time."""
    graces = Graces(GRACES)
    assert [graces.look(t, seen(MISSING)) for t in range(100, 105)] == [[]] * 5
    assert graces.look(105, seen(MISSING)) == [Event(MISSING, False, 5)]
    assert graces.reported == (MISSING,)
    assert graces.look(200, seen(MISSING)) == []
    assert graces.look(201, seen()) == [Event(MISSING, True, 101)]
    assert graces.look(202, seen()) == []
    assert not graces.reported


def test_restart_within_the_grace_is_silent() -> None:
    """However often; each begins anew."""
    graces = Graces(GRACES)
    for start in range(0, 1000, 10):
        assert graces.look(start, seen(MISSING)) == []
        assert graces.look(start + 4, seen(MISSING)) == []
        assert graces.look(start + 5, seen()) == []


def test_other_value_does_not_begin_anew() -> None:
    """What is wrong may change; it is reported as it is by then."""
    graces = Graces({Kind.WRONG_VALUE: 5})
    other = Difference(Kind.WRONG_VALUE, "/lidar", "rate", "10.0", "30.0")
    graces.look(0, seen(WRONG))
    graces.look(4, seen(other))
    (event,) = graces.look(5, seen(other))
    assert (event.difference.seen, event.lasted_ns) == ("30.0", 5)


def test_wrong_value_of_a_node_that_is_gone_is_not_over() -> None:
    """It is over when the node is back and has the right one."""
    graces = Graces(GRACES)
    graces.look(0, seen(WRONG))
    assert graces.look(1, seen(WRONG)) == [Event(WRONG, False, 1)]
    assert graces.look(2, GONE) == []
    assert graces.reported == (WRONG,)
    assert graces.look(3, seen(WRONG)) == []
    assert graces.look(4, seen()) == [Event(WRONG, True, 4)]


def test_wrong_value_of_a_node_that_is_gone_does_not_grow_older() -> None:
    """What was not reported yet is looked at anew when the node is back."""
    graces = Graces({**GRACES, Kind.WRONG_VALUE: 3})
    graces.look(0, seen(WRONG))
    graces.look(2, GONE)
    assert graces.look(4, seen(WRONG)) == []
    assert graces.look(6, seen(WRONG)) == []
    assert graces.look(7, seen(WRONG)) == [Event(WRONG, False, 3)]


LOOKS = st.lists(
    st.tuples(st.integers(1, 4), st.frozensets(st.sampled_from([MISSING, EXTRA, WRONG]))),
    max_size=40,
)


@given(LOOKS)
def test_reports_are_those_of_the_definition(
    looks: Sequence[tuple[int, frozenset[Difference]]],
) -> None:
    """Each unbroken row of looks is reported if it lasts, at the first look where it has."""
    graces, now = Graces(GRACES), 0
    times: list[int] = []
    events: list[list[Event]] = []
    for pause, differences in looks:
        now += pause
        times.append(now)
        events.append(graces.look(now, seen(*differences)))
    for difference in (MISSING, EXTRA, WRONG):
        expected: list[tuple[int, bool, int]] = []
        since: int | None = None
        reported = False
        for at, (_, differences) in zip(times, looks, strict=True):
            if difference in differences:
                since = at if since is None else since
                if not reported and at - since >= GRACES[difference.kind]:
                    reported = True
                    expected.append((at, False, at - since))
            elif since is not None:
                if reported:
                    expected.append((at, True, at - since))
                since, reported = None, False
        assert expected == [
            (at, event.is_over, event.lasted_ns)
            for at, found in zip(times, events, strict=True)
            for event in found
            if event.difference is difference
        ]
