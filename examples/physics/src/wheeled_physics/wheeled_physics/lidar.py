"""A laser scanner whose beams are rays in MuJoCo, with the faults that it may have."""

from __future__ import annotations

import math
import random
from typing import Any

import mujoco
import numpy as np
from wheeled_physics.measures import Lidar

LIDAR_FAULTS = ('lidar_line', 'lidar_dirt', 'lidar_dark', 'lidar_stuck')
"""
The line of the scanner is cut; dirt is on its window; its laser is dark, so that nothing comes
back; it shows the same sweep again and again.
"""

DIRT = math.radians(10.0)
"""How far, in rad to either side of straight ahead, dirt covers the window."""

_WITHOUT_NORMALS = {'normal': None} if 'normal:' in (mujoco.mj_multiRay.__doc__ or '') else {}
"""What newer versions of MuJoCo have to be told, and older ones do not know."""


class LidarRays:
    """A scanner on the body of a robot."""

    def __init__(self, lidar: Lidar, model: Any, data: Any, noise: random.Random) -> None:
        """Look ahead from where it is mounted; the noise is that of the robot."""
        self._lidar = lidar
        self._model, self._data, self._noise = model, data, noise
        self._body = int(model.body('body').id)
        axle = float(model.body('body').pos[2])
        self._place = np.array([lidar.ahead, 0.0, lidar.height - axle])
        self._bearings = np.linspace(-lidar.half_angle, lidar.half_angle, lidar.beams)
        level = np.zeros(lidar.beams)
        self._rays = np.stack([np.cos(self._bearings), np.sin(self._bearings), level], axis=1)
        self._faults: set[str] = set()
        self._last = [math.inf] * lidar.beams

    def fail(self, fault: str) -> None:
        """Let something of it fail for good."""
        self._faults.add(fault)

    def scan(self) -> list[float] | None:
        """Return what each beam measures, in m; ``None`` if its line is cut."""
        if 'lidar_line' in self._faults:
            return None
        if 'lidar_stuck' not in self._faults:
            beams = zip(self._bearings, self._distances(), strict=True)
            self._last = [self._shown(*each) for each in beams]
        return self._last

    def _distances(self) -> list[float]:
        """Return how far the next thing is along each beam, in m; negative where there is none."""
        turned = self._data.xmat[self._body].reshape(3, 3)
        place = self._data.xpos[self._body] + turned @ self._place
        rays = (self._rays @ turned.T).ravel()
        met, distances = np.zeros(self._lidar.beams, np.int32), np.zeros(self._lidar.beams)
        mujoco.mj_multiRay(
            self._model,
            self._data,
            place,
            rays,
            geomgroup=None,
            flg_static=True,
            bodyexclude=self._body,
            geomid=met,
            dist=distances,
            nray=self._lidar.beams,
            cutoff=self._lidar.range_max,
            **_WITHOUT_NORMALS,
        )
        shown: list[float] = distances.tolist()
        return shown

    def _shown(self, bearing: float, distance: float) -> float:
        noise = self._noise.gauss(0.0, self._lidar.noise)
        if 'lidar_dirt' in self._faults and abs(bearing) <= DIRT:
            return 0.0
        if distance < 0.0 or 'lidar_dark' in self._faults:
            return math.inf
        measured = distance + noise
        if measured > self._lidar.range_max:
            return math.inf
        return measured if measured >= self._lidar.range_min else 0.0
