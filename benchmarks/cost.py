"""What the generated safety node costs: processor time and memory, beside nodes that only receive.

Real middleware, separate processes, everything in one run: the same publisher feeds one node after
the other, in turns, while the others have nothing to do. A run takes about 150 s. The machine
should have nothing else to do.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from support.cost_report import as_json, show
from support.cost_results import FASTEST, NODES, SAFETY, USUAL, Memory, Results, Use
from support.cost_rules import TOPICS, generate
from support.processes import Processes, own_domain
from support.program import Report, conduct
from support.progress import Line
from support.usage import Meter, memory_mib, processor_time_ns

if TYPE_CHECKING:
    from support.cost_loads import Talker


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the tables; return 1 if a bar has to hold and does not, 2 if nothing was measured."""
    options = _options(arguments)
    report = Report(width=180)
    results = conduct(lambda folder: _measure(options, folder))
    from support.cost_loads import PAPER, SECOND_SCAN

    verdicts = list(results.verdicts(PAPER.name, SECOND_SCAN.name))
    show(results, verdicts, report.console)
    report.close(options.json, as_json(results, verdicts))
    held = results.stopped and all(each.held for each in verdicts)
    return 1 if options.must_hold and not held else 0


def _options(arguments: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--turns", type=int, default=5, metavar="N", help="of each node (%(default)s)"
    )
    parser.add_argument(
        "--seconds", type=float, default=2.0, metavar="S", help="of each turn (%(default)s)"
    )
    parser.add_argument(
        "--settle",
        type=float,
        default=0.7,  # longer than the rules' timeouts
        metavar="S",
        help="at the start of each turn, which do not count (%(default)s)",
    )
    parser.add_argument("--json", type=Path, metavar="FILE", help="write all results there, too")
    parser.add_argument(
        "--assert", action="store_true", dest="must_hold", help="exit with 1 if a bar fails"
    )
    options = parser.parse_args(arguments)
    if options.turns < 2 or options.seconds <= 0.0 or options.settle < 0.0:
        parser.error("at least two turns of some length are needed")
    return options


def _measure(options: argparse.Namespace, folder: Path) -> Results:
    """Generate, start and measure all nodes."""
    package = generate(folder)
    with own_domain(folder), Processes(folder) as processes, Line(sys.stderr) as line:
        _start_nodes(processes, package)
        # Only now: the domain must be chosen before ROS is imported.
        from support.cost_loads import LOADS, Talker

        talker = Talker(tuple(NODES))
        line.show("waiting for all nodes to meet")
        talker.meet(60.0, processes.check)
        for node in NODES:  # what is loaded with the first messages belongs to the start
            talker.feed(node, LOADS[-1], 1.0)
        pids = {node: processes.pid(node) for node in NODES}
        start = {node: memory_mib(pid) for node, pid in pids.items()}
        percents = _take_turns(options, processes, talker, line)
        end = {node: memory_mib(pid) for node, pid in pids.items()}
        stopped = talker.see_stop(SAFETY, seconds=5.0)
        processes.check()
        received = {node: processes.end(node) / talker.sent[node] for node in (USUAL, FASTEST)}
        talker.close()
    return Results(
        loads={load.name: sum(load.rates.values()) for load in LOADS},
        uses=tuple(Use(load, node, tuple(each)) for (load, node), each in percents.items()),
        memory=tuple(Memory(node, start[node], end[node]) for node in NODES),
        seconds=options.turns * options.seconds,
        received=received,
        stopped=stopped,
    )


def _start_nodes(processes: Processes, package: Path) -> None:
    remaps = [part for topic in TOPICS for part in ("-r", f"/{topic}:=/{SAFETY}/{topic}")]
    module = "cost_safety.cost_safety_node"
    processes.start(module, "--ros-args", *remaps, path=package, name=SAFETY)
    for node in (USUAL, FASTEST):
        namespace = ["--ros-args", "-r", f"__ns:=/{node}"]
        processes.start(f"cost_nodes.{node}_receiver", *namespace, name=node)


def _take_turns(
    options: argparse.Namespace, processes: Processes, talker: Talker, line: Line
) -> dict[tuple[str, str], list[float]]:
    """Put one node after the other under one load after the other, as often as asked for."""
    from support.cost_loads import LOADS

    percents: dict[tuple[str, str], list[float]] = {}
    order = list(NODES)
    for turn in range(options.turns):
        for load in LOADS:
            for node in order:
                line.show(f"turn {turn + 1} of {options.turns}: {load.name}; {NODES[node]}")
                processes.check()
                talker.feed(node, load, options.settle)
                meter = Meter.start(partial(processor_time_ns, processes.pid(node)))
                talker.feed(node, load, options.seconds)
                percents.setdefault((load.name, node), []).append(meter.percent())
        order.append(order.pop(0))
    return percents


if __name__ == "__main__":
    sys.exit(main())
