"""How long a snapshot of a running graph takes, and what watching it costs.

The snapshot is that of ``deros import`` and ``deros verify``, once all of the graph is discovered.

Ten nodes share a process, each with six topics of its own and a few parameters. A look reads all
names, types and QoS; the last rows are two looks, and the questions to all nodes: for an import
those for descriptions as well. The floor is what rclpy alone takes to read the names of the same
graph. What is to hold: 100 nodes with 600 topics take less than 2 s of looking and asking, beside
the time for which the graph has to stay the same; and ``deros verify --watch`` takes less than 1 %
of a core while nothing changes. The processes of the nodes do more than half of the work of an
answer, so that the seconds are those of a machine with nothing else to do.
"""

from __future__ import annotations

import argparse
import contextlib
import itertools
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from deros.generators.output.writer import write
from deros.importers.kept.files import renewed
from deros.importers.node_types import imported
from deros.importers.texts import files
from deros.interfaces.store import InterfaceStore
from deros.live.graph_reader import GraphReader
from deros.live.looks import snapshot
from deros.live.observer import Observer
from deros.live.snapshots import Snapshot
from deros.live.verify.expectation import expectation
from deros.live.verify.texts import event_line
from deros.live.verify.watching import Watch
from deros.metamodels.load import Repository
from deros.models.system import System
from deros.systems.flatten import flatten

LIMIT_SECONDS = 2.0
LIMIT_OF_A_CORE = 0.01
_WATCHED_SECONDS = 20.0
_TOPICS = 6
_IN_ONE_PROCESS = 10
_DISCOVERY_SECONDS = 120.0

_PROGRAM = """
import sys
import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import Bool

rclpy.init()
executor = SingleThreadedExecutor()
for number in range(int(sys.argv[1]), int(sys.argv[2])):
    node = Node(f"node_{number}", namespace=f"/group_{number // 10}")
    for topic in range(int(sys.argv[3])):
        node.create_publisher(Bool, f"~/topic_{topic}", 10)
    node.declare_parameter("rate", 10.0)
    node.declare_parameter("frames", ["a", "b"])
    executor.add_node(node)
try:
    while True:
        executor.spin_once()
except (KeyboardInterrupt, ExternalShutdownException):
    pass
"""


def _best(repeat: int, action: Callable[[], Any]) -> float:
    seconds = []
    for _ in range(repeat):
        began = time.perf_counter()
        action()
        seconds.append(time.perf_counter() - began)
    return min(seconds)


def _measure(observer: Observer, nodes: int, repeat: int) -> int:
    reader = GraphReader(observer)

    def complete() -> bool:
        graph = reader.whole()
        ends = sum(len(node.ends) for node in graph.nodes)
        return graph.complete and ends == nodes * _TOPICS

    if not observer.until(complete, time.monotonic() + _DISCOVERY_SECONDS):
        raise RuntimeError("the graph was not discovered")
    first = _best(repeat, lambda: GraphReader(observer).names())
    again = _best(repeat, reader.names)
    names = _best(repeat, observer.node.get_topic_names_and_types)
    look = _best(repeat, reader.whole)
    found: list[Any] = []
    whole = _best(repeat, lambda: found.append(snapshot(observer, equal=1, quiet=0)))
    values = _best(repeat, lambda: snapshot(observer, equal=1, quiet=0, described=False))
    if any(node.parameters is None for node in found[-1].nodes):
        raise RuntimeError(f"a node did not answer: {found[-1].unseen}")
    print(f"{nodes} nodes, {nodes * _TOPICS} topics")
    rows = {
        "names by rclpy": names,
        "look without QoS": first,
        "the same again": again,
        "look": look,
        "verify": values,
        "import": whole,
    }
    for what, seconds in rows.items():
        print(f"  {what:<16} {seconds * 1000:>9.2f} ms {seconds / names:>9.1f} x floor")
    share = _watched(observer, found[-1])
    print(f"  watching {share:>16.2%} of a core")
    return int(whole > LIMIT_SECONDS or share > LIMIT_OF_A_CORE)


def _watched(observer: Observer, seen: Snapshot) -> float:
    """Return the share of a core that it takes to watch a graph that stays as it is."""
    with tempfile.TemporaryDirectory() as folder:
        graph = imported(seen, InterfaceStore().exists)
        write(renewed(files(graph, "robot"), Path(folder)).files, Path(folder))
        model = Repository().load(Path(folder, "robot.system")).model
    assert isinstance(model, System)
    expected = expectation(flatten(model))
    with contextlib.closing(Watch(observer, expected, seen, {})) as watch:
        watch.turn()
        began, used = time.monotonic(), time.process_time()
        while time.monotonic() < began + _WATCHED_SECONDS:
            if found := watch.turn():
                raise RuntimeError(f"the graph differs from its model: {event_line(found[0])}")
        return (time.process_time() - used) / (time.monotonic() - began)


def main() -> int:
    """Print the table; return 1 when the limit is passed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--nodes", type=int, default=100)
    parser.add_argument("--domain", type=int, default=87, help="one that nobody else uses")
    parser.add_argument("--repeat", type=int, default=3, help="the best of so many runs counts")
    arguments = parser.parse_args()
    os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"
    os.environ["ROS_DOMAIN_ID"] = str(arguments.domain)
    bounds = [*range(0, arguments.nodes, _IN_ONE_PROCESS), arguments.nodes]
    with contextlib.ExitStack() as stack:
        for first, last in itertools.pairwise(bounds):
            command = [sys.executable, "-c", _PROGRAM, str(first), str(last), str(_TOPICS)]
            program = stack.enter_context(subprocess.Popen(command))
            stack.callback(program.send_signal, signal.SIGINT)
        with Observer(arguments.domain) as observer:
            return _measure(observer, arguments.nodes, arguments.repeat)


if __name__ == "__main__":
    sys.exit(main())
