"""The paper's experiments, repeated: from the fulfilled condition of a rule to its action.

Real middleware, separate processes: the generated safety nodes of four robots of ``examples``, a
driver that plays their sensors and breaks them, and a recorder. Each experiment is repeated ten
times by the machine's clock, by a simulator's, or by both, as in the paper. Everything is recorded
to MCAP and analysed from the recordings alone; ``--analyse`` does so again. First on rclpy; then,
if AMENT_PREFIX_PATH has an rclcpp, on that. Each takes about 6 minutes, and some more when the
nodes on rclcpp are built. The machine should have nothing else to do.
"""

from __future__ import annotations

import argparse
import contextlib
import itertools
import shutil
import sys
from collections.abc import Sequence
from pathlib import Path

from rich.text import Text
from support.experiments.analysis import analyse
from support.experiments.recording import RecordingError
from support.experiments.report import page, show, write_parquet
from support.experiments.results import Results, Run
from support.experiments.robots import CPP, PYTHON, ROBOTS, Robot
from support.experiments.session import EXAMPLES, Measured, cpp_node, python_node, record
from support.processes import own_domain
from support.program import Report, conduct
from support.progress import Line
from support.rclcpp_programs import rclcpp_environment, workshop

_RECORDINGS = "recordings"
_TARGETS = {PYTHON: "python", CPP: "cpp"}
_NO_CPP = f"{CPP}: not asked for, or no rclcpp in AMENT_PREFIX_PATH"


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the tables and write the rest.

    Return 1 if a safety node has events that its rules do not explain, or lacks some, or if a bar
    has to hold and does not; 2 if nothing could be measured or analysed.
    """
    options = _options(arguments)
    report = Report(width=240)
    if options.analyse is None:
        results = conduct(lambda folder: _play(options, options.output or folder))
    else:
        results = _analysed(options.analyse, options.only)
    show(results, report.console)
    output = options.output or options.analyse
    if output is not None:
        (output / "experiments.html").write_text(page(results), encoding="utf-8")
        if not write_parquet(results, output / "experiments.parquet"):
            hint = Text("No Parquet: pip install 'deros[experiments]' has a library.")
            report.console.print(hint)
    report.close(options.json, results.as_json())
    held = all(bar.held for bar in results.bars())
    return 0 if results.is_explained and (held or not options.must_hold) else 1


def _options(arguments: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--repeat", type=int, default=10, metavar="N", help="of each experiment (%(default)s)"
    )
    parser.add_argument(
        "--only",
        action="append",
        choices=[each.name for each in ROBOTS],
        help="this robot; may be given several times",
    )
    parser.add_argument(
        "--target",
        dest="targets",
        action="append",
        choices=list(_TARGETS.values()),
        help="this one alone; by default both, where AMENT_PREFIX_PATH has an rclcpp",
    )
    parser.add_argument(
        "--output",
        type=Path,
        metavar="DIR",
        help="keep the recordings there, and write a page and Parquet",
    )
    parser.add_argument(
        "--analyse", type=Path, metavar="DIR", help="play nothing, analyse what is recorded there"
    )
    parser.add_argument("--json", type=Path, metavar="FILE", help="write all results there, too")
    parser.add_argument(
        "--assert", action="store_true", dest="must_hold", help="exit with 1 if a bar fails"
    )
    options = parser.parse_args(arguments)
    if options.repeat < 2:
        parser.error("at least two repeats are needed")
    if options.analyse is not None and options.output is not None:
        parser.error("--analyse writes into its folder, so it needs no --output")
    asked = options.targets or list(_TARGETS.values())
    options.targets = [name for name, word in _TARGETS.items() if word in asked]
    if options.targets == [CPP] and rclcpp_environment() is None:
        parser.error("no rclcpp in AMENT_PREFIX_PATH")
    return options


def _play(options: argparse.Namespace, output: Path) -> Results:
    """Play all experiments, and analyse their recordings."""
    recordings = output / _RECORDINGS
    shutil.rmtree(recordings, ignore_errors=True)
    recordings.mkdir(parents=True)
    with contextlib.ExitStack() as stack:
        line = stack.enter_context(Line(sys.stderr))
        nodes = []
        for robot in _chosen(options.only):
            line.show(f"{robot.title}: generating its safety node")
            if PYTHON in options.targets:
                nodes.append(python_node(robot, output / "generated"))
        env = rclcpp_environment() if CPP in options.targets else None
        if env is not None:
            shop = stack.enter_context(workshop(env))
            for robot in _chosen(options.only):
                line.show(f"{robot.title}: building its safety node")
                nodes.append(cpp_node(robot, shop, env))
        stack.enter_context(own_domain(output / "ros"))
        for node in nodes:
            for clock in node.robot.clocks:
                folder = recordings / _name(node.robot, clock, node.target)
                record(node, clock, options.repeat, folder, line)
    return _analysed(output, options.only)


def _analysed(output: Path, only: Sequence[str] | None) -> Results:
    """Return what the recordings in a folder show.

    Raises:
        SystemExit: with 2 if there are none, or one cannot be read.
    """
    runs = []
    try:
        for robot, target in itertools.product(_chosen(only), _TARGETS):
            rules = EXAMPLES / robot.name / f"{robot.name}.deros"
            for clock in robot.clocks:
                folder = output / _RECORDINGS / _name(robot, clock, target)
                if folder.exists():
                    found = analyse(robot, rules, folder, is_watched=target == PYTHON)
                    runs.append(Run(robot, clock, target, found, Measured.read(folder)))
        if not runs:
            raise RecordingError(f"{output}: has no recordings")
    except RecordingError as error:
        print(error, file=sys.stderr)
        sys.exit(2)
    return Results(runs, [] if any(run.target == CPP for run in runs) else [_NO_CPP])


def _chosen(only: Sequence[str] | None) -> list[Robot]:
    return [each for each in ROBOTS if only is None or each.name in only]


def _name(robot: Robot, clock: str, target: str) -> str:
    return f"{robot.name}_{clock}_{_TARGETS[target]}"


if __name__ == "__main__":
    sys.exit(main())
