"""Comparisons decided by the range of a type: found where they are, and nowhere else."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.rules import findings

DECLARED = """
action stop;
input mode = topic /mode.data timeout 1 sec
input v = topic /speed.data timeout 1 sec
input q = topic /imu.orientation timeout 1 sec
"""


def decided(condition: str) -> list[tuple[str, str]]:
    """Return code and place of what is decided in a condition."""
    used = " or ".join(["mode > 1", "v > 1", "q.roll() > 1"])
    statements = f"""{DECLARED} entity e {{ r: {condition}; s: {used}; }}
        if e.r or e.s then {{ stop; }};"""
    return [(code, place) for code, place, _ in findings(statements)]


@pytest.mark.parametrize(
    "condition",
    [
        "mode > 254",
        "mode = 255",
        "mode in [255, 300]",
        "mode in (1, 3)",
        "v > 1e38",
        "v > 5 or v < 3",
        "v > 5 and not v < 3",
        "v > 5 and mode < 3",
        "v.abs() <= 0",
        "q.roll() > 179 deg",
        "(v > 5 for 1 sec) and v < 3",
        "v > 5 and v.abs() < 3",
    ],
)
def test_open_conditions(condition: str) -> None:
    """What some value satisfies and some does not is no finding."""
    assert decided(condition) == []


@pytest.mark.parametrize(
    ("condition", "code", "place"),
    [
        ("mode > 255", "DRS308", "mode > 255"),
        ("300 < mode", "DRS308", "300 < mode"),
        ("mode <= 255", "DRS309", "mode <= 255"),
        ("mode in (254.5, 254.9)", "DRS308", "mode in (254.5, 254.9)"),
        ("mode = -1 and v > 1", "DRS308", "mode = -1"),
        ("v > 1 and v > 2 and v < 2", "DRS308", "v > 1 and v > 2 and v < 2"),
        ("v = 1 and v != 1", "DRS308", "v = 1 and v != 1"),
        ("mode < 3 or mode > 2", "DRS309", "mode < 3 or mode > 2"),
        ("not (v > 5 and v < 3) for 1 sec", "DRS308", "v > 5 and v < 3"),
        ("q.tilt() < 0", "DRS308", "q.tilt() < 0"),
        ("q.pitch() > 91 deg", "DRS308", "q.pitch() > 91 deg"),
    ],
)
def test_decided_conditions(condition: str, code: str, place: str) -> None:
    """The finding names the smallest condition that is decided, once."""
    found = [each for each in decided(condition) if each[0] != "DRS330"]
    assert found == [(code, place)]


@settings(max_examples=40, deadline=None)
@given(st.integers(-20, 280), st.integers(-20, 280), st.booleans())
def test_agrees_with_every_value(low: int, high: int, both: bool) -> None:
    """A pair of comparisons is reported exactly if all 256 values give one verdict, or one part."""
    parts = [[mode >= low for mode in range(256)], [mode <= high for mode in range(256)]]
    combine = all if both else any
    verdicts = {combine(pair) for pair in zip(*parts, strict=True)}
    word = "and" if both else "or"
    found = decided(f"mode >= {low} {word} mode <= {high}")
    assert bool(found) == any(len(set(each)) == 1 for each in [*parts, verdicts])
