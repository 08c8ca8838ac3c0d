"""Break the driving feeding robot at random, two faults at a time, and judge it from outside.

Each round lets the robot drive, breaks it and a rule, and asks an independent referee whether the
actuator came to rest in time and stayed there. Exit code 1 says that it did not: the seed and the
round's folder are printed, and its schedule is written there, to be kept in tests/faults/schedules.
"""

from __future__ import annotations

import argparse
import os
import secrets
import sys
from collections.abc import Sequence
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(REPOSITORY / "examples" / "feeding_robot"))  # its package demonstration

ROUND_S = 10.0
"""Seconds that a round takes, about, with the start of the robot shared by several."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Play the campaign; return 0 when no round shows a violation."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=20, help="default %(default)s")
    parser.add_argument("--seed", type=int, help="default: a new one, which is printed")
    parser.add_argument("--round", type=int, help="play this round of the seed alone")
    parser.add_argument("--replay", type=Path, metavar="FILE", help="play a schedule that was kept")
    parser.add_argument("--per-start", type=int, default=10, help="rounds for each robot start")
    parser.add_argument("--cpp", action="store_true", help="safety node and gate in C++")
    parser.add_argument("--lines", action="store_true", help="with a gate that uses every line")
    parser.add_argument("--output", type=Path, default=REPOSITORY / ".tmp" / "chaos")
    options = parser.parse_args(arguments)
    # Fast DDS reads its profile once in a process, and ROS has not been imported yet.
    from tests.support.chaos import campaign, schedule
    from tests.support.ros import environment

    os.environ |= environment(0)
    if options.replay is not None:
        rounds = [schedule.Schedule.load(options.replay)]
    else:
        seed = secrets.randbelow(10**6) if options.seed is None else options.seed
        numbers = range(options.rounds) if options.round is None else [options.round]
        provocations = schedule.WITH_JOYSTICK if options.lines else schedule.PROVOCATIONS
        rounds = [schedule.draw(seed, n, provocations=provocations) for n in numbers]
    software = options.cpp, options.lines
    return campaign.run(rounds, options.output, options.per_start, ROUND_S, *software)


if __name__ == "__main__":
    sys.exit(main())
