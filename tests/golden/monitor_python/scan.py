# action stop; input v = topic /scan entity e { r: v.nearest(-30 deg, 30 deg) < 0.4; } if e.r then { stop; };

from collections.abc import Callable, Collection, Sequence

import functools

import numpy as np

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
