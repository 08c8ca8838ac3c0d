"""Lets the Frobit drive for four seconds and prints what its sensors show: ``drive [FAULT]``."""

from __future__ import annotations

import sys

from wheeled_physics.measures import FROBIT
from wheeled_physics.robot import FAULTS, Robot

THRUST = 0.6
"""Thrust of both wheels."""


def main() -> int:
    """Drive, with the fault given after two seconds; print a line each half second."""
    faults = sys.argv[1:]
    if len(faults) > 1 or not set(faults) <= set(FAULTS):
        print(f'usage: drive [{"|".join(FAULTS)}]', file=sys.stderr)
        return 2
    robot = Robot(FROBIT)
    robot.thrust(THRUST, THRUST)
    for half in range(8):
        if half == 4:
            for fault in faults:
                robot.fail(fault)
        robot.step(0.5)
        x, y = robot.position()
        ticks = f'{robot.encoder("left"):5d} {robot.encoder("right"):5d} ticks'
        print(f'{robot.time:.1f} s  x {x:.3f} m  y {y:.3f} m  {ticks}  {robot.voltage:.2f} V')
    return 0


if __name__ == '__main__':
    sys.exit(main())
