# action stop; input v = topic /scan entity e { r: v.nearest(-30 deg, 30 deg) < 0.4; } if e.r then { stop; };

from collections.abc import Callable, Collection, Sequence

import functools

import numpy as np

    def on_scan(
        self, t: int, ranges: Sequence[float], angle_min: float, angle_increment: float,
        range_min: float, range_max: float,
    ) -> None:
    # 6 lines
        if (
            angle_min == angle_min
            and angle_increment == angle_increment
            and range_min == range_min
            and range_max == range_max
            and scan_usable(ranges, range_min, range_max, False)
        ):
            v_nearest = scan_nearest(
                ranges, angle_min, angle_increment, range_min, range_max, -0.5235987755982989,
                0.5235987755982989, False,
            )
            if v_nearest is None:
                v_nearest = NAN
            v_blind = scan_blind(
                ranges, angle_min, angle_increment, range_min, range_max, -0.5235987755982989,
                0.5235987755982989, False,
            )
            if v_blind is None:
                v_blind = NAN
            self._v_nearest = v_nearest
            self._v_blind = v_blind
            if (
                self._v_nearest_low <= v_nearest <= self._v_nearest_high
                and self._v_blind_low <= v_blind <= self._v_blind_high
            ):
                return
            self._v_nearest_low, self._v_nearest_high = cell(v_nearest, 0.4000000059604645)
            self._v_blind_low, self._v_blind_high = cell(v_blind)
        else:
            self._forget_v()
    # 2 lines

import ctypes

… 6 lines of explanation.py.j2: def beams_text(share: float) -> str:
… 8 lines of explanation.py.j2: def decimal(value: float) -> float:
… 3 lines of explanation.py.j2: def explain(self) -> Explanation:
            explained(
                'e.r', 2, 'r: v.nearest(-30 deg, 30 deg) < 0.4;', self._e_r, self._e_r_since,
                self._why_e_r, ('v.nearest(-0.523599, 0.523599)', decimal(self._v_nearest)),
            ),
        )
    # 4 lines

    def _why_e_r(self) -> tuple[str, ...]:
        """Return why e.r is true."""
        return (
            f'v.nearest(-0.523599, 0.523599) {shown(decimal(self._v_nearest))} < 0.4{beams_text(self._v_blind)}',  # noqa: E501
        )
