"""What a laser scanner sees of a flat obstacle that stands across the way."""

from __future__ import annotations

import math

HALF_WIDTH = 0.8
"""Half the width, in m, of the obstacle, measured from the middle of the way."""


def bearings(beams: int) -> list[float]:
    """Return the beams' bearings in rad, evenly from -90 to 90 degrees."""
    return [-math.pi / 2 + math.pi * index / (beams - 1) for index in range(beams)]


def ranges(clearance: float, beams: int, range_max: float) -> list[float]:
    """
    Return what each beam measures, in m; infinity where it meets nothing within ``range_max``.

    The clearance is the distance of the obstacle straight ahead, infinite when there is none; a
    scan has at least two beams.
    """
    return [_range(clearance, bearing, range_max) for bearing in bearings(beams)]


def _range(clearance: float, bearing: float, range_max: float) -> float:
    if math.isinf(clearance) or abs(clearance * math.tan(bearing)) > HALF_WIDTH:
        return math.inf
    distance = clearance / math.cos(bearing)
    return distance if distance <= range_max else math.inf
