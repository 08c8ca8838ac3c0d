"""The paper's experiments, repeated: from the fulfilled condition of a rule to its action.

Real middleware, separate processes: the generated safety nodes of four robots of ``examples``, a
driver that plays their sensors and breaks them, and a recorder. Each experiment is repeated ten
times by the machine's clock, by a simulator's, or by both, as in the paper. Everything is recorded
to MCAP and analysed from the recordings alone; ``--analyse`` does so again. Takes some minutes. The
machine should have nothing else to do.
"""

from __future__ import annotations

import argparse
import shutil
import sys
from collections.abc import Sequence
from pathlib import Path

from support.experiments.analysis import analyse
from support.experiments.recording import RecordingError
from support.experiments.report import page, show, write_parquet
from support.experiments.results import Results, Run
from support.experiments.robots import ROBOTS, Robot
from support.experiments.session import EXAMPLES, Measured, generate, record
from support.processes import own_domain
from support.program import Report, conduct
from support.progress import Line

PYTHON = "Python"
_RECORDINGS = "recordings"


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the tables and write the rest.

    Return 1 if a safety node has events that its rules do not explain, or lacks some, or if a bar
    has to hold and does not; 2 if nothing could be measured or analysed.
    """
    options = _options(arguments)
    report = Report(width=220)
    if options.analyse is None:
        results = conduct(lambda folder: _play(options, options.output or folder))
    else:
        results = _analysed(options.analyse, options.only)
    show(results, report.console)
    output = options.output or options.analyse
    if output is not None:
        (output / "experiments.html").write_text(page(results), encoding="utf-8")
        if not write_parquet(results, output / "experiments.parquet"):
            report.console.print("No Parquet: pip install 'deros[experiments]' has a library.")
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
    return options


def _play(options: argparse.Namespace, output: Path) -> Results:
    """Play all experiments, and analyse their recordings."""
    recordings = output / _RECORDINGS
    shutil.rmtree(recordings, ignore_errors=True)
    recordings.mkdir(parents=True)
    with own_domain(output / "ros"), Line(sys.stderr) as line:
        for robot in _chosen(options.only):
            line.show(f"{robot.title}: generating its safety node")
            package = generate(robot, output / "generated")
            for clock in robot.clocks:
                folder = recordings / _name(robot, clock)
                record(robot, clock, options.repeat, package, folder, line)
    return _analysed(output, options.only)


def _analysed(output: Path, only: Sequence[str] | None) -> Results:
    """Return what the recordings in a folder show.

    Raises:
        SystemExit: with 2 if there are none, or one cannot be read.
    """
    runs = []
    try:
        for robot in _chosen(only):
            rules = EXAMPLES / robot.name / f"{robot.name}.deros"
            for clock in robot.clocks:
                folder = output / _RECORDINGS / _name(robot, clock)
                if folder.exists():
                    found = analyse(robot, rules, folder)
                    runs.append(Run(robot, clock, PYTHON, found, Measured.read(folder)))
        if not runs:
            raise RecordingError(f"{output}: has no recordings")
    except RecordingError as error:
        print(error, file=sys.stderr)
        sys.exit(2)
    return Results(runs, [])


def _chosen(only: Sequence[str] | None) -> list[Robot]:
    return [each for each in ROBOTS if only is None or each.name in only]


def _name(robot: Robot, clock: str) -> str:
    return f"{robot.name}_{clock}_python"


if __name__ == "__main__":
    sys.exit(main())
