"""How fast the generated safety node reacts, from the message published to the state received.

Real middleware, separate processes, everything in one run and in turns: an immediate rule beside
two relays written by hand, the usual one and the fastest that rclpy allows; rules that have to be
broken for 0.4 s, 2 s and 4 s beside a relay with nothing but a one-shot timer. A run takes about
100 s. The machine should have nothing else to do, unless it is put under load by ``--load``: a
burner for each processor, and 20 topics at 100 Hz.
"""

from __future__ import annotations

import argparse
import json
import os
import signal
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING

from rich.console import Console
from support.processes import ProcessError, Processes, own_domain
from support.progress import Line
from support.reaction_report import as_json, show
from support.reaction_results import FASTEST, SAFETY, USUAL, Results, Run
from support.reaction_rules import Lane, generate, timed_lanes
from support.samples import Fired

if TYPE_CHECKING:
    from support.driver import Driver
    from support.experiment import Immediate, Timed

LOAD_TOPICS = 20

_EVENTS = ("/immediate_safety_node/events", "/timed_safety_node/events")
_BUSY = 0.3


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table; return 1 if a bar has to hold and does not, 2 if nothing was measured."""
    options = _options(arguments)
    signal.signal(signal.SIGTERM, _leave)
    console = Console(width=None if sys.stdout.isatty() else 140)
    busy = os.getloadavg()[0]
    try:
        with tempfile.TemporaryDirectory(prefix="deros-benchmark-") as folder:
            results = Results(_measure(options, Path(folder)))
    except KeyboardInterrupt:
        return 128 + signal.SIGINT
    except (ProcessError, TimeoutError) as error:
        print(error, file=sys.stderr)
        return 2
    show(results, console)
    if busy > _BUSY:
        console.print(f"The machine was not idle before (load {busy:.1f}): take this for noise.")
    if options.json is not None:
        options.json.write_text(json.dumps(as_json(results), indent=1) + "\n", encoding="utf-8")
    held = all(bar.held for bar in results.bars())
    return 1 if options.must_hold and not held else 0


def _options(arguments: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--repeat", type=int, default=200, metavar="N", help="of each rule with a for (%(default)s)"
    )
    parser.add_argument(
        "--immediate", type=int, default=1000, metavar="N", help="of the others (%(default)s)"
    )
    parser.add_argument("--load", action="store_true", help="put the machine under load")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write all results there, too")
    parser.add_argument(
        "--assert", action="store_true", dest="must_hold", help="exit with 1 if a bar fails"
    )
    options = parser.parse_args(arguments)
    if min(options.repeat, options.immediate) < 2:
        parser.error("at least two repeats are needed")
    return options


def _leave(number: int, _frame: FrameType | None) -> None:
    sys.exit(128 + number)


def _measure(options: argparse.Namespace, folder: Path) -> Run:
    """Generate, start and measure everything."""
    immediate = {name: Lane(name, "immediate", 0.0) for name in (SAFETY, FASTEST, USUAL)}
    timed, floor = timed_lanes("timed"), timed_lanes("floor")
    packages = (
        generate("immediate", [immediate[SAFETY]], folder),
        generate("timed", timed, folder),
    )
    with own_domain(folder), Processes(folder) as processes:
        _start_nodes(processes, packages, immediate, floor)
        if options.load:
            _start_load(processes)
        # Only now: the domain must be chosen before ROS is imported.
        from diagnostic_msgs.msg import DiagnosticStatus
        from support.driver import Driver
        from support.experiment import Immediate, Timed
        from support.reaction_records import triggers

        driver = Driver([(topic, DiagnosticStatus) for topic in _EVENTS])
        at_once = {
            name: Immediate(driver, driver.channel(lane, name == SAFETY), options.immediate)
            for name, lane in immediate.items()
        }
        later = [
            Timed(driver, [driver.channel(lane, resets) for lane in lanes], options.repeat)
            for lanes, resets in ((timed, True), (floor, False))
        ]
        _run(driver, processes, list(at_once.values()), later)
        driver.close()
        return Run(
            loaded=options.load,
            immediate={name: each.samples for name, each in at_once.items()},
            timed=later[0].samples,
            floor=later[1].samples,
            triggers=[each for topic in _EVENTS for each in triggers(driver.records[topic])],
            firings=[Fired(*each) for each in processes.end("timed_relay")],
            sleeps=processes.end("sleeper"),
            lost=at_once[SAFETY].progress.lost + later[0].progress.lost,
            traffic=processes.end("listener") if options.load else 0.0,
        )


def _start_nodes(
    processes: Processes,
    packages: tuple[Path, Path],
    immediate: dict[str, Lane],
    floor: Sequence[Lane],
) -> None:
    for name, package in zip(("immediate", "timed"), packages, strict=True):
        module = f"{name}_safety.{name}_safety_node"
        # The many states of the timed rules, repeated as often as usual, would be a load.
        parameters = ["--ros-args", "-p", "publish_freq:=2.0"] if name == "timed" else []
        processes.start(module, *parameters, path=package)
    for name in (FASTEST, USUAL):
        lane = immediate[name]
        remaps = ["--ros-args", "-r", f"imu:={lane.imu}", "-r", f"state:={lane.state}"]
        processes.start(f"reaction_nodes.{name}_relay", *remaps)
    lanes = [f"{lane.seconds}:{lane.imu}:{lane.state}" for lane in floor]
    processes.start("reaction_nodes.timed_relay", *lanes)
    processes.start("reaction_nodes.sleeper")


def _start_load(processes: Processes) -> None:
    topics = [f"/load/topic_{number}" for number in range(LOAD_TOPICS)]
    processes.start("reaction_nodes.listener", *topics)
    processes.start("reaction_nodes.talker", *topics)
    for number in range(len(os.sched_getaffinity(0))):
        processes.start("reaction_nodes.burner", name=f"burner_{number}")


def _run(
    driver: Driver, processes: Processes, at_once: Sequence[Immediate], later: Sequence[Timed]
) -> None:
    from support.experiment import Experiment

    everything = [each.progress for each in at_once] + [each.progress for each in later]
    with Line(sys.stderr) as line:
        line.show("waiting for all nodes to meet")
        driver.meet(60.0, processes.check)

        def watch() -> None:
            processes.check()
            done = sum(min(each.done, each.wanted) for each in everything)
            wanted = sum(each.wanted for each in everything)
            lost = sum(each.lost for each in everything)
            line.show(f"{done} of {wanted} reactions" + (f", {lost} lost" if lost else ""))

        Experiment(driver, at_once, later, watch).run()


if __name__ == "__main__":
    sys.exit(main())
