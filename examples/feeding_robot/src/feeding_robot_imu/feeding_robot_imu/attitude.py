"""Attitudes as unit quaternions ``(x, y, z, w)``, and the noise of an inertial sensor on them."""

from __future__ import annotations

import math
import random

Quaternion = tuple[float, float, float, float]


def product(a: Quaternion, b: Quaternion) -> Quaternion:
    """Return the Hamilton product: the rotation ``b`` followed by ``a``."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def small_rotation(roll: float, pitch: float) -> Quaternion:
    """Return the rotation by a small roll and pitch, in rad."""
    x, y = roll / 2, pitch / 2
    return (x, y, 0.0, math.sqrt(max(0.0, 1.0 - x * x - y * y)))


def disturbed(attitude: Quaternion, deviation: float, noise: random.Random) -> Quaternion:
    """
    Return the true attitude as the sensor shows it.

    The deviation is the standard one of roll and pitch, in rad; it is drawn from the noise.
    """
    error = small_rotation(noise.gauss(0.0, deviation), noise.gauss(0.0, deviation))
    return product(attitude, error)
