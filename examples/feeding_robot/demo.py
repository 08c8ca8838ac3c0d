#!/usr/bin/env python3
"""Generates the feeding robot, starts it, plays its fifteen test cases and draws what happened."""

from __future__ import annotations

import argparse
import signal
import sys
from collections.abc import Sequence
from pathlib import Path
from types import FrameType

EXAMPLE = Path(__file__).resolve().parent
OUTPUT = EXAMPLE.parents[1] / ".demo" / EXAMPLE.name


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the demo; return 0 when all cases pass, 1 when one fails, 130 when interrupted."""
    options = _options(arguments)
    # SIGINT too: what a shell runs in the background is started deaf to it.
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, _leave)
    # From here on ROS is needed: the domain must be chosen before it is imported.
    from demonstration.domain import own_domain

    with own_domain():
        return _demonstrate(options)


def _options(arguments: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--cases", type=_numbers, metavar="LIST", help="cases to play, such as 1,4,8-13"
    )
    parser.add_argument(
        "--repeat", type=int, default=1, metavar="N", help="play them so often, default %(default)s"
    )
    parser.add_argument(
        "--output",
        type=Path,
        default=OUTPUT,
        metavar="DIR",
        help="where packages, logs and the picture go, default %(default)s",
    )
    parser.add_argument(
        "--cpp", action="store_true", help="with the safety node and the gate in C++; needs rclcpp"
    )
    options = parser.parse_args(arguments)
    if options.repeat < 1:
        parser.error("--repeat takes a number from 1")
    return options


def _numbers(text: str) -> list[int]:
    numbers: list[int] = []
    for part in text.split(","):
        first, _, last = part.partition("-")
        numbers += range(int(first), int(last or first) + 1)
    if not numbers or not set(numbers) <= set(range(1, 16)):
        raise argparse.ArgumentTypeError("the cases have the numbers 1 to 15")
    return numbers


def _leave(number: int, _frame: FrameType | None) -> None:
    sys.exit(128 + number)


def _demonstrate(options: argparse.Namespace) -> int:
    from demonstration.build import BuildError, build, build_cpp, in_cpp
    from demonstration.cases import CASES
    from demonstration.picture import page
    from demonstration.scoreboard import Scoreboard, summary
    from demonstration.session import Workshop, run
    from rich.console import Console

    console = Console()
    output: Path = options.output
    system = EXAMPLE / "feeding_robot.system"
    folders: tuple[Path, ...] = (output / "packages",)
    try:
        packages = build(EXAMPLE, folders[0])
        if options.cpp:
            folders = (build_cpp(EXAMPLE, output / "cpp"), *folders)
            system = in_cpp(system, output)
    except BuildError as error:
        console.print(str(error), style="red", soft_wrap=True, highlight=False)
        return 1
    console.print(f"Generated {len(packages)} packages into {folders[-1]}", soft_wrap=True)
    workshop = Workshop(system, folders, output)
    cases = [case for case in CASES if not options.cases or case.number in options.cases]
    with Scoreboard(console, cases, options.repeat) as board:
        recordings = run(workshop, cases, options.repeat, board.begin, board.report)
    monitored = frozenset(c.number for c in CASES if not c.silence_of and not c.simulated)
    sentence = summary(board.results, monitored)
    picture = output / "run.html"
    picture.write_text(page(recordings, sentence), encoding="utf-8")
    for result in board.results:
        if not result.passed:
            text = f"Case {result.number} failed: {result.failure}"
            console.print(text, style="red", soft_wrap=True, highlight=False)
    if not board.complete:
        console.print(f"What the nodes said: {output}/*.log", soft_wrap=True, highlight=False)
    console.print(sentence, soft_wrap=True, highlight=False)
    console.print(f"Picture of the run: {picture}", soft_wrap=True)
    return 0 if board.complete else 1


if __name__ == "__main__":
    sys.exit(main())
