"""Reference implementations of functions of the function table, which every target must match.

A result of ``None`` is *unknown*; no function returns NaN. Arguments are never NaN, because
an input that carries one is unknown as a whole (the beams of laser scans excepted).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from deros.interfaces.durations import NS_PER_S
from deros.rules.program.formulas import Expression, Formula, evaluate, holds

FULL_TURN = 2.0 * math.pi
BEARING_TOLERANCE = 1e-6
"""Radians by which a beam may miss a bound of a sector and still count as in it.

The angles of a scan are sums of 32-bit floats; over a full turn their error stays below this.
"""


OUTSIDE = object()
"""What stands for a beam beside the sector."""


def roll(x: float, y: float, z: float, w: float) -> float | None:
    """Return the rotation about the x axis, in radians (REP 103: fixed axes, roll-pitch-yaw)."""
    unit = normalised(x, y, z, w)
    if unit is None:
        return None
    x, y, z, w = unit
    return math.atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y))


def pitch(x: float, y: float, z: float, w: float) -> float | None:
    """Return the rotation about the y axis, in radians, from -pi/2 to pi/2."""
    unit = normalised(x, y, z, w)
    if unit is None:
        return None
    x, y, z, w = unit
    # Rounding can carry the sine of a vertical attitude just past 1.
    return math.asin(max(-1.0, min(1.0, 2.0 * (w * y - z * x))))


def yaw(x: float, y: float, z: float, w: float) -> float | None:
    """Return the rotation about the z axis, in radians."""
    unit = normalised(x, y, z, w)
    if unit is None:
        return None
    x, y, z, w = unit
    return math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


def tilt(x: float, y: float, z: float, w: float) -> float | None:
    """Return the angle between the body's z axis and the vertical, in radians, from 0 to pi.

    It is acos(1 - 2(x² + y²)) of the normalised quaternion, written so that small angles keep all
    their digits.
    """
    unit = normalised(x, y, z, w)
    if unit is None:
        return None
    x, y, z, w = unit
    return 2.0 * math.atan2(math.sqrt(x * x + y * y), math.sqrt(z * z + w * w))


def normalised(x: float, y: float, z: float, w: float) -> tuple[float, float, float, float] | None:
    """Return a quaternion at length 1; ``None`` for one whose length is zero or infinite."""
    # The root of the sum of squares is the same number in every language, which hypot() is not. No
    # quaternion of use is so short (1e-162) or so long (1e154) that the squares leave their range.
    length = math.sqrt(x * x + y * y + z * z + w * w)
    if not 0.0 < length < math.inf:
        return None
    return x / length, y / length, z / length, w / length


def norm(x: float, y: float, z: float) -> float:
    """Return the length of a vector; a plane vector has ``z`` 0.

    It is the root of the sum of squares, in this order, so that every target computes the very same
    number. Beyond 1e154 that is infinity.
    """
    return math.sqrt(x * x + y * y + z * z)


def absolute(value: float) -> float:
    """Return the value without its sign; an integer stays one."""
    return abs(value)


def rate(value: float, previous: float, elapsed_ns: int) -> float | None:
    """Return the change per second between the last two messages, ``elapsed_ns`` apart.

    Unknown for two messages of one instant, and from an infinity to itself.
    """
    if elapsed_ns == 0:
        return None
    change = (value - previous) / (elapsed_ns / 1e9)
    return None if math.isnan(change) else change


def stamp_ns(sec: float | None, nanosec: float | None) -> int | None:
    """Return the time of a header; none for zero, which means that nobody has stamped it."""
    if not isinstance(sec, int) or not isinstance(nanosec, int):
        return None
    if sec < 0 or not 0 <= nanosec < NS_PER_S:
        return None
    return (sec * NS_PER_S + nanosec) or None


def latency(received_ns: int, sec: int, nanosec: int) -> float | None:
    """Return the seconds from the stamp of a message to its receipt, on the clock of the stamps.

    Negative for a stamp in the future; unknown without a stamp, and before that clock's zero.
    """
    stamped_ns = stamp_ns(sec, nanosec)
    return None if stamped_ns is None or received_ns < 0 else (received_ns - stamped_ns) / 1e9


def least(values: Sequence[float]) -> float | None:
    """Return the least element, unknown for an empty array."""
    return min(values) if len(values) else None


def greatest(values: Sequence[float]) -> float | None:
    """Return the greatest element, unknown for an empty array."""
    return max(values) if len(values) else None


def count(values: Sequence[object]) -> int:
    """Return the number of elements."""
    return len(values)


def matches(
    entry: Expression, names: Sequence[str], arrays: Sequence[Sequence[float]]
) -> int | None:
    """Return at how many indices a condition on the entries of arrays holds.

    Unknown for empty arrays, and for arrays of different lengths.
    """
    lengths = {len(array) for array in arrays}
    if len(lengths) > 1 or 0 in lengths:
        return None
    entries = zip(*(map(float, array) for array in arrays), strict=True)
    return sum(holds(entry, dict(zip(names, each, strict=True))) for each in entries)


def nearest(*scan: Any) -> float | None:
    """Return the least range of a sector of a laser scan, in metres; see :func:`sector`.

    Beams that see nothing within their reach give infinity. Unknown where more than half of the
    sector's beams are blind, or it has none. A distance of zero has no sign: several beams may have
    it, and none of them comes first.
    """
    shown: list[float | None] = [each for each in sector(*scan) if each is not OUTSIDE]
    seen = [each for each in shown if each is not None]
    if not shown or len(seen) < len(shown) - len(seen):
        return None
    return min(seen)


def blind(*scan: Any) -> float | None:
    """Return the share of a sector's beams that are blind; unknown where it has no beam."""
    shown = [each for each in sector(*scan) if each is not OUTSIDE]
    return shown.count(None) / len(shown) if shown else None


def blind_gap(*scan: Any) -> float | None:
    """Return the widest run of blind beams in a sector, in radians; unknown where it has no beam.

    A run of ``n`` beams is ``n`` steps of the scanner wide. The first beam follows the last one
    where they are less than two and a half steps apart, as those of a scanner that turns all
    around are.
    """
    shown = sector(*scan)
    if all(each is OUTSIDE for each in shown):
        return None
    count = len(shown)
    step: float = abs(scan[2])
    is_round = (count + 1.5) * step > FULL_TURN
    widest = run = 0
    for each in shown * 2 if is_round else shown:
        run = run + 1 if each is None else 0
        widest = max(widest, min(run, count))
    return widest * step


def points(*scan: Any) -> int | None:
    """Return how many beams of a sector show a point; unknown where it has no beam."""
    shown = [each for each in sector(*scan) if each is not OUTSIDE]
    return sum(_is_point(each) for each in shown) if shown else None


def points_in(zone: Formula, *scan: Any) -> int | None:
    """Return how many beams of a sector show a point in a zone.

    Unknown where more than half of the sector's beams are blind, or it has none.

    Args:
        zone: 1 where a beam's distance and bearing are those of a point in the zone, else 0.
        scan: as :func:`sector` takes it.
    """
    shown = sector(*scan)
    among = [each for each in shown if each is not OUTSIDE]
    if not among or 2 * among.count(None) > len(among):
        return None
    angle_min, step = scan[1:3]
    return sum(
        evaluate(zone, {"distance": each, "bearing": angle_min + index * step}) > 0.0
        for index, each in enumerate(shown)
        if each is not OUTSIDE and _is_point(each)
    )


def _is_point(shown: float | None) -> bool:
    return shown is not None and shown < math.inf


def sector(
    ranges: Sequence[float],
    angle_min: float,
    angle_increment: float,
    range_min: float,
    range_max: float,
    start: float,
    end: float,
    zero_is_free: bool,
) -> list[Any]:
    """Return what each beam of a laser scan shows: a distance, ``None`` if blind, ``OUTSIDE``.

    The sector runs counter-clockwise from ``start`` to ``end`` (radians, bounds included), through
    the back where ``end`` is less than ``start``; bearings a full turn apart are the same.
    """
    width = end - start if end >= start else end - start + FULL_TURN
    found: list[Any] = []
    for index, measured in enumerate(ranges):
        offset = (angle_min + index * angle_increment - start) % FULL_TURN
        if offset <= width + BEARING_TOLERANCE or offset >= FULL_TURN - BEARING_TOLERANCE:
            found.append(beam(measured, range_min, range_max, zero_is_free))
        else:
            found.append(OUTSIDE)
    return found


def beam(measured: float, range_min: float, range_max: float, zero_is_free: bool) -> float | None:
    """Return the distance that a beam shows, infinity if it is free, ``None`` if it is blind.

    One that is shorter than ``range_min`` is near and counts as it is; minus infinity is an object
    too near to measure (REP 117) and counts as 0. Infinity, and what lies beyond ``range_max``,
    means that nothing is there; so does 0 where that is declared. Else NaN and negative ranges are
    blind, and 0 is, unless ``range_min`` says that it can be measured.
    """
    if measured == 0.0:
        if zero_is_free:
            return math.inf
        return 0.0 if range_min <= 0.0 else None
    if measured == -math.inf:
        return 0.0
    if not measured > 0.0:
        return None
    return math.inf if measured > range_max and measured >= range_min else measured


def scan_usable(
    ranges: Sequence[float], range_min: float, range_max: float, zero_is_free: bool
) -> bool:
    """Return whether any beam of the scan sees; otherwise it does not count as a message."""
    shown = (beam(measured, range_min, range_max, zero_is_free) for measured in ranges)
    return any(each is not None for each in shown)
