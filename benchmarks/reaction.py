"""How fast the generated safety node reacts, from the message published to the state received.

Real middleware, separate processes, everything in one run and in turns: an immediate rule beside
two relays written by hand, the usual one and the fastest that the client library allows; rules that
have to be broken for 0.4 s, 2 s and 4 s beside a relay with nothing but a timer. First on rclpy;
then, if AMENT_PREFIX_PATH has an rclcpp, on that. Each takes about 100 s, and some minutes more
when the nodes on rclcpp are built. The machine should have nothing else to do, unless it is put
under load by ``--load``: a burner for each processor, and 20 topics at 100 Hz.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from support import reaction_rclcpp, reaction_rclpy
from support.program import Report, conduct
from support.rclcpp_programs import rclcpp_environment
from support.reaction_report import as_json, show
from support.reaction_results import Results
from support.reaction_session import Wanted


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table; return 1 if a bar has to hold and does not, 2 if nothing was measured."""
    options = _options(arguments)
    report = Report(width=140)
    results = conduct(lambda folder: _measure(options, folder))
    show(results, report.console)
    report.close(options.json, as_json(results))
    held = all(bar.held for each in results for bar in each.bars())
    return 1 if options.must_hold and not held else 0


def _options(arguments: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--repeat", type=int, default=200, metavar="N", help="of each rule with a for (%(default)s)"
    )
    parser.add_argument(
        "--immediate", type=int, default=1000, metavar="N", help="of the others (%(default)s)"
    )
    parser.add_argument("--only", choices=("rclpy", "rclcpp"), help="one client library alone")
    parser.add_argument("--load", action="store_true", help="put the machine under load")
    parser.add_argument(
        "--priority",
        type=int,
        default=0,
        metavar="N",
        help="real-time priority, 1 to 99, of the nodes on rclcpp that keep deadlines",
    )
    parser.add_argument("--json", type=Path, metavar="FILE", help="write all results there, too")
    parser.add_argument(
        "--assert", action="store_true", dest="must_hold", help="exit with 1 if a bar fails"
    )
    options = parser.parse_args(arguments)
    if min(options.repeat, options.immediate) < 2:
        parser.error("at least two repeats are needed")
    if options.only == "rclcpp" and rclcpp_environment() is None:
        parser.error("no rclcpp in AMENT_PREFIX_PATH")
    return options


def _measure(options: argparse.Namespace, folder: Path) -> list[Results]:
    """Measure on each client library."""
    wanted = Wanted(options.immediate, options.repeat, options.load, options.priority)
    found = []
    for name, session in (("rclpy", reaction_rclpy), ("rclcpp", reaction_rclcpp)):
        is_there = name != "rclcpp" or rclcpp_environment() is not None
        if is_there and options.only in (None, name):
            own = folder / name
            own.mkdir()
            found.append(Results(session.measure(wanted, own)))
    return found


if __name__ == "__main__":
    sys.exit(main())
