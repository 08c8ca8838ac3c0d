# action stop; input v = topic /scan entity e { r: v.nearest(-30 deg, 30 deg) < 0.4; } if e.r then { stop; };

from collections.abc import Callable, Collection, Sequence

import functools

import numpy as np

def scan_usable(ranges: Sequence[float], range_min: float) -> bool:
    """Return whether any beam of the scan is valid."""
    measured = np.asarray(ranges)
    if not measured.size:
        return False
    return bool(np.fmax.reduce(measured) >= range_min or np.fmin.reduce(measured) == -math.inf)

@functools.lru_cache(maxsize=64)
def scan_beams(
    count: int, angle_min: float, angle_increment: float, start: float, end: float,
) -> slice | np.ndarray:
    """Return the beams from bearing start to end; cached for scans of the same form."""
    turn = 2.0 * math.pi
    width = end - start if end >= start else end - start + turn
    with np.errstate(all='ignore'):
        offsets = (angle_min + np.arange(count) * angle_increment - start) % turn
        beams = np.flatnonzero((offsets <= width + 1e-6) | (offsets >= turn - 1e-6))
    if beams.size and beams[-1] - beams[0] < beams.size:
        return slice(int(beams[0]), int(beams[-1]) + 1)
    return beams

def scan_nearest(
    ranges: Sequence[float], angle_min: float, angle_increment: float, range_min: float,
    range_max: float, start: float, end: float,
) -> float | None:
    """Return the least valid range from bearing start to end; None without a valid beam."""
    beams = scan_beams(len(ranges), angle_min, angle_increment, start, end)
    measured = np.asarray(ranges)[beams]
    if not measured.size:
        return None
    least = float(np.fmin.reduce(measured))  # not NaN, if any is not
    if least == -math.inf:  # too near to measure (REP 117)
        return range_min + 0.0  # which makes 0.0 of -0.0
    if not least >= range_min:  # invalid, as may be others
        valid = measured[measured >= range_min]
        if not valid.size:
            return None
        least = float(valid.min())
    return least + 0.0 if least <= range_max else math.inf

    def on_scan(
        self, t: int, ranges: Sequence[float], angle_min: float, angle_increment: float,
        range_min: float, range_max: float,
    ) -> None:
    # 13 lines
            v_nearest = scan_nearest(
                ranges, angle_min, angle_increment, range_min, range_max, -0.5235987755982989,
                0.5235987755982989,
            )
            if v_nearest is None:
                v_nearest = NAN
    # 7 lines
