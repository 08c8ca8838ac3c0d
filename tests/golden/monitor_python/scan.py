# action stop; input v = topic /scan entity e { r: v.nearest(-30 deg, 30 deg) < 0.4; } if e.r then { stop; };

from collections.abc import Callable, Collection, Sequence

import ctypes

import functools

import numpy as np

def decimal(value: float) -> float:
    """Return the shortest decimal number that gives a float32: 0.1 for 0.10000000149."""
    for digits in range(1, 10):
        found = float(f'{value:.{digits}g}')
        if ctypes.c_float(found).value == value:
            return found
    return value

    def explain(self) -> Explanation:
        """Return the state of each rule, and why behaviours hold, are on their way or unknown."""
        rules = (
            explained(
                'e.r', 2, 'r: v.nearest(-30 deg, 30 deg) < 0.4;', self._e_r, self._e_r_since,
                self._why_e_r, ('v.nearest(-0.523599, 0.523599)', decimal(self._v_nearest)),
            ),
        )
    # 4 lines

    def _why_e_r(self) -> tuple[str, ...]:
        """Return why e.r is true."""
        return (f'v.nearest(-0.523599, 0.523599) {shown(decimal(self._v_nearest))} < 0.4',)

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
