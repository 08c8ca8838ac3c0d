# action stop; input v = topic /scan entity e { r: v.nearest(-30 deg, 30 deg) < 0.4; } if e.r then { stop; };

from collections.abc import Callable, Collection, Sequence

import ctypes

import functools

import numpy as np

… 8 lines of monitor.py.j2: def decimal(value: float) -> float:
… 3 lines of monitor.py.j2: def explain(self) -> Explanation:
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
