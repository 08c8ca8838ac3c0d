#!/usr/bin/env python3
"""Generates a robot, starts it once with each of its faults, and draws what happened."""

from __future__ import annotations

import argparse
import importlib.util
import signal
import sys
from collections.abc import Sequence
from pathlib import Path
from types import FrameType

HERE = Path(__file__).resolve().parent
# What starts a system, builds packages and draws is shared with the feeding robot.
sys.path[:0] = [str(HERE), str(HERE.parent / "feeding_robot")]

from shown.robots import EXAMPLES, ROBOTS, Robot, in_physics  # noqa: E402


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the demo; return 0 when each fault is answered, 1 when one is not, 2 for bad usage."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("robot", choices=[each.name for each in ROBOTS])
    parser.add_argument("--physics", action="store_true", help="with its hardware in MuJoCo")
    parser.add_argument(
        "--clock", choices=["real", "simulated"], help="whose time passes in MuJoCo; default real"
    )
    parser.add_argument("--fault", action="append", help="one of its faults; may be repeated")
    parser.add_argument("--output", type=Path, metavar="DIR", help="default .demo/faults/ROBOT")
    options = parser.parse_args(arguments)
    robot = next(each for each in ROBOTS if each.name == options.robot)
    if options.physics:
        if importlib.util.find_spec("mujoco") is None:
            parser.error("--physics needs MuJoCo: pip install '.[physics]', or make physics")
        robot = in_physics(robot, simulated=options.clock == "simulated")
    elif options.clock:
        parser.error("--clock needs --physics: the simple hardware works in real time")
    elif not robot.faults:
        parser.error(f"{robot.name} has another demo without --physics: make demo")
    faults: list[str] = options.fault or list(robot.faults)
    unknown = sorted(set(faults) - set(robot.faults))
    if unknown:
        parser.error(f"no fault {', '.join(unknown)}; there are {', '.join(robot.faults)}")
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, _leave)
    # From here on ROS is needed: the domain must be chosen before it is imported.
    from demonstration.domain import own_domain

    with own_domain():
        output = options.output or EXAMPLES.parent / ".demo/faults" / robot.name
        return _demonstrate(robot, faults, output)


def _leave(number: int, _frame: FrameType | None) -> None:
    sys.exit(128 + number)


def _demonstrate(robot: Robot, faults: Sequence[str], output: Path) -> int:
    import os
    import tempfile

    from demonstration.build import BuildError, build
    from rich.console import Console
    from shown.picture import areas, page
    from shown.run import show

    console = Console(highlight=False, soft_wrap=True)
    packages = output / "packages"
    try:
        for folder in robot.folders:
            build(EXAMPLES / folder, packages)
    except BuildError as error:
        console.print(str(error), style="red")
        return 1
    outcomes = []
    for fault in faults:
        console.print(f"[bold]{fault}[/bold]: expected “{robot.faults[fault]}”")
        # A latched stop outlives its node: each run begins without that of the one before.
        with tempfile.TemporaryDirectory() as os.environ["ROS_HOME"]:
            outcome = show(robot, fault, packages, output / f"{fault}.log")
        outcomes.append(outcome)
        after = "" if outcome.seconds is None else f", {outcome.seconds:.2f} s after the fault"
        said = f"the safety node said “{outcome.said[0]}”{after}" if outcome.said else "no stop"
        rest = outcome.overdue or "the robot stands"
        console.print(f"  {said}; {rest}", style="green" if outcome.passed else "red")
    picture = output / "run.html"
    picture.write_text(page(robot, outcomes, areas(robot)), encoding="utf-8")
    console.print(f"Picture of the runs: {picture}")
    return 0 if all(each.passed for each in outcomes) else 1


if __name__ == "__main__":
    sys.exit(main())
