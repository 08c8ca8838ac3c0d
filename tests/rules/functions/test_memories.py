"""Rates: unwrapped angles, and rates over a span of time by message stamps."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deros.rules.functions.functions import FUNCTIONS
from deros.rules.functions.memories import SAMPLES, RateOver
from deros.rules.program import ir
from tests.support.rules import build_rules, condition, program

TURN = 2.0 * math.pi
MS = 1_000_000


def unwrapped(*angles: float | None, turn: float = TURN) -> list[float | None]:
    """Return unwrapped angles, message by message."""
    memory, found = FUNCTIONS["unwrapped"].new_memory(), []
    for number, angle in enumerate(angles):
        memory.follow(number, angle, turn)
        found.append(memory.result)
    return found


def rates(*messages: tuple[int, float | None], span_ms: int = 100) -> list[float | None]:
    """Return the rate over a span, message by message; times in milliseconds."""
    memory, found = RateOver(), []
    for at, value in messages:
        memory.follow(at * MS, value, span_ms * MS)
        found.append(memory.result)
    return found


def stamped(*messages: tuple[int, int, float], span_ms: int = 100) -> list[float | None]:
    """Return rates by header stamps: pairs of milliseconds, of receipt and of stamp."""
    memory, found = RateOver(), []
    for at, stamp, value in messages:
        header = divmod(stamp * MS, 10**9)
        memory.follow(at * MS, value, span_ms * MS, *header)
        found.append(memory.result)
    return found


# Angles -----------------------------------------------------------------------------------------


def test_angle_continues_past_half_a_turn() -> None:
    """From 3.1 rad to -3.1 rad is a small step forward, not most of a turn back."""
    angles = unwrapped(3.1, -3.1, -3.0)
    assert angles == pytest.approx([3.1, TURN - 3.1, TURN - 3.0])
    assert unwrapped(350.0, 10.0, 0.0, turn=360.0) == [350.0, 370.0, 360.0]
    assert unwrapped(350, 10, turn=360.0) == [350.0, 370.0]


def test_half_a_turn_keeps_its_sign() -> None:
    """Neither direction is shorter, so the numbers decide."""
    assert unwrapped(0.0, math.pi) == [0.0, math.pi]
    assert unwrapped(math.pi, 0.0) == [math.pi, 0.0]
    assert unwrapped(-90.0, 90.0, turn=360.0) == [-90.0, 90.0]
    assert unwrapped(90.0, -90.0, turn=360.0) == [90.0, -90.0]


def test_many_turns_add_up() -> None:
    """Ten turns in steps of a third are ten turns, not none."""
    angles = [math.remainder(n * TURN / 3.0, TURN) for n in range(31)]
    assert unwrapped(*angles)[-1] == pytest.approx(10.0 * TURN)


def test_unwrapping_restarts_after_an_invalid_angle() -> None:
    """An unknown or infinite angle cannot be continued."""
    assert unwrapped(3.0, None, -3.0) == [3.0, None, -3.0]
    assert unwrapped(3.0, math.inf, -3.0) == [3.0, math.inf, -3.0]


# Spans ------------------------------------------------------------------------------------------


def test_rate_over_a_span_needs_messages_that_cover_it() -> None:
    """It is unknown until messages cover the span, then the change over the last of them."""
    assert rates((0, 0.0), (50, 1.0), (100, 2.0), (150, 9.0)) == [None, None, 20.0, 80.0]


def test_burst_does_not_distort_the_rate() -> None:
    """Two messages 0.2 ms apart alone would have a rate of 5,000."""
    memory = RateOver()
    for at_us, value in ((0, 0.0), (100_000, 1.0), (100_200, 2.0)):
        memory.follow(at_us * 1000, value, 100 * MS)
    assert memory.result == pytest.approx(2.0 / 0.1002)


def test_samples_are_an_eighth_of_the_span_apart() -> None:
    """Some fast messages are skipped: the span may be longer by an eighth and an interval."""
    values = rates(*((n, float(n)) for n in range(301)))
    assert all(each is None for each in values[:100])
    assert values[100:] == pytest.approx([1000.0] * 201)


def test_equal_times_give_no_rate() -> None:
    """The second message of one time is ignored afterwards."""
    values = rates((0, 0.0), (100, 1.0), (100, 5.0), (200, 2.0))
    assert values == [None, 10.0, None, 10.0]


def test_stamps_are_used_instead_of_receipt() -> None:
    """Messages that arrive late and together have the stamps of their measurement."""
    values = stamped((0, 1000, 0.0), (500, 1100, 1.0), (500, 1200, 3.0))
    assert values == [None, 10.0, 20.0]


def test_backward_stamps_restart_the_rate() -> None:
    """The change is unknown until messages cover the span again."""
    values = stamped((0, 1000, 0.0), (1, 1100, 1.0), (2, 900, 5.0), (3, 1000, 6.0))
    assert values == [None, 10.0, None, 10.0]


def test_missing_and_equal_stamps_give_no_rate() -> None:
    """Such a message is ignored."""
    values = stamped((0, 1000, 0.0), (1, 0, 7.0), (2, 1100, 1.0), (3, 1100, 9.0), (4, 1200, 2.0))
    assert values == [None, None, 10.0, None, 10.0]
    assert stamped((0, 0, 0.0), (200, 0, 1.0), (400, 0, 2.0)) == [None, None, None]


def test_unknown_values_restart_the_rate() -> None:
    """They are treated like a gap."""
    assert rates((0, 0.0), (100, None), (200, 1.0), (300, 2.0)) == [None, None, None, 10.0]


@given(
    st.lists(st.integers(0, 60), max_size=80),
    st.integers(1, 50),
)
def test_samples_cover_the_span_and_are_few(waits: list[int], span: int) -> None:
    """A rate is known exactly if messages cover the span, which is exceeded only slightly."""
    memory, at, longest = RateOver(), 0, 0
    times: list[int] = []
    for wait in waits:
        at += wait
        if wait:
            longest = max(longest, wait)
        memory.follow(at, float(at), span)
        if times and at == times[-1]:
            assert memory.result is None
            continue
        times.append(at)
        spanned = at - times[0] >= span
        assert (memory.result is not None) == spanned
        assert len(memory.samples) <= SAMPLES
        if spanned:
            assert memory.result == pytest.approx(1e9)
            base = memory.samples[0][0]
            assert span <= at - base < span + -(-span // 8) + longest


# Rules ------------------------------------------------------------------------------------------


def test_leaves_of_an_angle_rate() -> None:
    """Yaw and roll are unwrapped, pitch and tilt are not; a full turn has the angle's unit."""
    declared = "input q = topic /imu.orientation"
    for name, jumps in (("yaw", True), ("roll", True), ("pitch", False), ("tilt", False)):
        parsed_condition = condition(f"q.{name}().rate(0.1 sec) > 1", declared)
        assert isinstance(parsed_condition, ir.Compare)
        assert isinstance(parsed_condition.left, ir.Apply)
        angle, span, sec, nanosec = parsed_condition.left.arguments
        assert span == ir.Const(100 * MS)
        assert (sec, nanosec) == (ir.Read(4), ir.Read(5))
        assert isinstance(angle, ir.Apply)
        assert (angle.function == "unwrapped") == jumps
        assert not jumps or angle.arguments[1] == ir.Const(TURN)


def test_rate_without_a_header_uses_receipt() -> None:
    """A plain number has no stamp, so its message has one leaf."""
    built = program("input v = topic /speed.data entity e { r: v.rate(0.1 sec) > 1; }")
    assert [leaf.path for leaf in built.leaves] == [("data",)]


@pytest.mark.parametrize(
    ("term", "code"),
    [
        ("v.rate(0.1)", "DRS323"),
        ("v.rate(0 sec)", "DRS323"),
        ("v.rate(1 m)", "DRS306"),
        ("v.rate(1 sec, 2 sec)", "DRS304"),
        ("v.rate(v)", "DRS304"),
        ("v.rate()", "DRS367"),
        ("v.rate_over(1 sec)", "DRS305"),
        ("v.unwrapped()", "DRS305"),
    ],
)
def test_invalid_rates_are_findings(term: str, code: str) -> None:
    """A span is a positive constant duration; internal functions are not available."""
    findings = build_rules(f"input v = topic /speed.data entity e {{ r: {term} > 1; }}").diagnostics
    assert [each.code.name for each in findings] == [code]
