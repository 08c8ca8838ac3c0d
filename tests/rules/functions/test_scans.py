"""What the beams of a laser scan say: near, measured, free, blind."""

from __future__ import annotations

import math
from collections.abc import Sequence

import pytest

from deros.rules.functions import function_values as values
from deros.rules.functions.functions import FUNCTIONS
from deros.rules.program.beams import beam_formula
from deros.rules.program.zones import Rectangle

NAN, INF = math.nan, math.inf
STEP = 0.5


def scan(
    name: str,
    *ranges: float,
    start: float = -1.0,
    end: float = 1.0,
    zero_is_free: bool = False,
    range_min: float = 0.1,
) -> float | None:
    """Evaluate a function of beams 0.5 rad apart from -1 rad on, measured up to 10 m."""
    arguments = (ranges, -1.0, STEP, range_min, 10.0, start, end, zero_is_free)
    return FUNCTIONS[name].value(*arguments)


@pytest.mark.parametrize(
    ("measured", "free", "range_min", "shown"),
    [
        (NAN, False, 0.1, None),
        (-1.0, False, 0.1, None),
        (0.0, False, 0.1, None),
        (-0.0, True, 0.1, INF),
        (0.0, True, 0.0, INF),
        (0.0, False, 0.0, 0.0),
        (-1.0, False, -2.0, None),
        (-INF, False, 0.1, 0.0),
        (0.05, False, 0.1, 0.05),
        (0.1, False, 0.1, 0.1),
        (10.0, False, 0.1, 10.0),
        (10.5, False, 0.1, INF),
        (INF, False, 0.1, INF),
        (0.05, False, 20.0, 0.05),
        (15.0, False, 20.0, 15.0),
    ],
)
def test_a_beam_shows(measured: float, free: bool, range_min: float, shown: float | None) -> None:
    """A beam is near, measured, free, or else blind; near goes before free."""
    assert values.beam(measured, range_min, 10.0, free) == shown


def test_nearest_includes_the_bounds_of_the_sector() -> None:
    """Beams between the bearings count, including those on the bounds."""
    assert scan("nearest", 1.0, 2.0, 3.0, 4.0, 0.5, start=-0.5, end=0.5) == 2.0
    assert scan("nearest", 1.0, 2.0, 3.0, 4.0, 0.5, start=-0.6, end=-0.4) == 2.0
    assert scan("nearest", 1.0, 2.0, 3.0, 4.0, 0.5, start=-0.4, end=-0.1) is None


def test_nearest_sector_may_include_the_rear() -> None:
    """A sector whose end is less than its start includes the rear, as do angles beyond pi."""
    quarter = math.pi / 2.0
    ranges = [1.0, 2.0, 3.0, 4.0]  # ahead, left, behind, right
    ask = (ranges, 0.0, quarter, 0.1, 10.0)
    assert values.nearest(*ask, math.radians(150), math.radians(-150), False) == 3.0
    assert values.nearest(*ask, math.radians(-100), math.radians(-80), False) == 4.0
    assert values.nearest(*ask, -math.pi, math.pi, False) == 1.0


def test_nearest_sees_what_is_nearer_than_the_scanner_measures() -> None:
    """An obstacle below the least range is near, not invalid; so is minus infinity."""
    assert scan("nearest", 0.08, 0.08, 0.08, 0.08, 5.0) == 0.08
    assert scan("nearest", 5.0, -INF, 5.0, 5.0, 5.0) == 0.0


def test_half_a_sector_may_be_blind() -> None:
    """Nearest is unknown where more than half of the beams are blind, and not at the half."""
    assert scan("nearest", NAN, NAN, 3.0, 4.0, start=-1.0, end=0.5) == 3.0
    assert scan("nearest", NAN, NAN, NAN, 4.0, start=-1.0, end=0.5) is None
    assert scan("nearest", NAN, 0.0, -1.0, 4.0, 0.2) is None
    assert scan("nearest", NAN, 0.0, INF, 11.0, 12.0) == INF


def test_zero_is_measured_whatever_the_greatest_range() -> None:
    """A scanner that says that it measures from below 0 on, and up to below 0, means its zeros."""
    limits = (-1.0, -1.0, -1.0, -1.0, -1.0, -1.0, False)
    assert values.nearest([0.0], *limits) == 0.0
    assert values.nearest([0.5], *limits) == INF


def test_zero_may_mean_that_nothing_is_there() -> None:
    """Where 0 is declared to be the scanner's 'no return' it is free, else blind."""
    empty = (0.0, 0.0, 0.0, 0.0, 2.0)
    assert scan("nearest", *empty) is None
    assert scan("nearest", *empty, zero_is_free=True) == 2.0
    assert scan("nearest", *empty[:4], zero_is_free=True) == INF
    assert scan("blind", *empty) == 0.8
    assert scan("blind", *empty, zero_is_free=True) == 0.0


def test_blindness_is_the_share_of_a_sector() -> None:
    """Blind beams are counted among those of the sector; a sector without beams has no share."""
    ranges = (NAN, 1.0, 0.0, 0.05, INF)
    assert scan("blind", *ranges) == 0.4
    assert scan("blind", *ranges, start=-0.5, end=1.0) == 0.25
    assert scan("blind", *ranges, start=-0.4, end=-0.1) is None
    assert scan("blind_gap", *ranges, start=-0.4, end=-0.1) is None


@pytest.mark.parametrize(
    ("ranges", "steps"),
    [
        ((1.0, 1.0, 1.0, 1.0, 1.0), 0),
        ((NAN, 1.0, NAN, NAN, 1.0), 2),
        ((NAN, NAN, 1.0, NAN, NAN), 2),  # this scanner does not turn all around
        ((NAN, NAN, NAN, NAN, NAN), 5),
    ],
)
def test_a_gap_is_as_wide_as_its_run_of_beams(ranges: Sequence[float], steps: int) -> None:
    """The widest run of blind beams counts, one step of the scanner for each."""
    assert scan("blind_gap", *ranges) == steps * STEP


def test_a_gap_may_lie_where_a_scan_begins() -> None:
    """A scanner that turns all around has its first beam beside its last one."""
    step = math.pi / 4.0
    look = (0.0, step, 0.1, 10.0)
    ranges = [NAN, NAN, 1.0, 1.0, 1.0, 1.0, 1.0, NAN]
    ahead, around = (-math.pi / 2.0, math.pi / 2.0, False), (-math.pi, math.pi, False)
    assert values.blind_gap(ranges, *look, *ahead) == 3 * step
    assert values.blind_gap(ranges, *look, *around) == 3 * step
    assert values.blind_gap([*ranges[:6], NAN], *look, *around) == 3 * step  # one beam is missing
    assert values.blind_gap([*ranges[:5], NAN], *look, *around) == 2 * step  # two are
    assert values.blind_gap([NAN] * 8, *look, *around) == 8 * step


AHEAD = beam_formula(Rectangle((0.5, -2.0), (2.0, 2.0)))


def points_in(*ranges: float, zero_is_free: bool = False, range_min: float = 0.1) -> float | None:
    """Count the points ahead of five beams, 0.5 rad apart from -1 rad on."""
    return values.points_in(AHEAD, ranges, -1.0, STEP, range_min, 10.0, -1.4, 1.4, zero_is_free)


def test_points_are_those_of_near_and_measured_beams() -> None:
    """What is free or blind shows none; a beam past the zone shows one behind it."""
    assert points_in(1.0, 1.0, 1.0, 1.0, 1.0) == 5.0
    assert points_in(0.5, 0.5, 0.5, 0.5, 0.5) == 1.0  # the others are beside it, nearer than 0.5 m
    assert points_in(1.0, 3.0, INF, 11.0, 1.0) == 2.0
    assert points_in(1.0, 0.0, NAN, 1.0, 1.0) == 3.0
    assert points_in(0.6, 0.6, 0.6, 0.6, 0.6, range_min=0.7) == 3.0  # near, and counted as they are
    assert points_in(INF, INF, INF, INF, INF) == 0.0


def test_what_is_too_near_to_measure_is_at_the_sensor() -> None:
    """A zone that begins ahead of it does not have it, one around the sensor does."""
    assert points_in(-INF, -INF, 1.0, 1.0, 1.0) == 3.0
    around = beam_formula(Rectangle((0.0, -2.0), (2.0, 2.0)))
    look = ([-INF, 0.0, 1.0], 0.0, STEP, 0.0, 10.0, -math.pi, math.pi)
    assert values.points_in(around, *look, False) == 3.0
    assert values.points_in(around, *look, True) == 2.0


def test_points_are_unknown_where_most_beams_are_blind() -> None:
    """At the half they are not, and zeros may be free; so where no beam looks into the sector."""
    assert points_in(NAN, NAN, 1.0, 1.0) == 2.0
    assert points_in(NAN, NAN, NAN, 1.0, 1.0) is None
    assert points_in(0.0, 0.0, 0.0, 1.0, 1.0) is None
    assert points_in(0.0, 0.0, 0.0, 1.0, 1.0, zero_is_free=True) == 2.0
    assert values.points_in(AHEAD, [1.0], math.pi, 0.1, 0.1, 10.0, -1.4, 1.4, False) is None


def test_the_points_of_a_sector() -> None:
    """They are what causes tell beside those in a zone."""
    assert scan("points", 1.0, 0.05, INF, 11.0, NAN) == 2.0
    assert scan("points", 0.0, -1.0, NAN, NAN, NAN) == 0.0
    assert scan("points", -INF, 0.0, 1.0, zero_is_free=True) == 2.0
    assert scan("points", 1.0, start=-0.4, end=-0.1) is None


def test_a_scan_that_sees_is_usable() -> None:
    """A scan counts as a message if any of its beams sees, in any direction."""
    limits = (0.1, 10.0)
    assert not values.scan_usable([NAN, 0.0, -1.0], *limits, False)
    assert values.scan_usable([NAN, 0.0, -1.0], *limits, True)
    assert values.scan_usable([NAN, 0.05], *limits, False)
    assert values.scan_usable([NAN, INF], *limits, False)
    assert values.scan_usable([-INF], *limits, False)
    assert not values.scan_usable([], *limits, False)
