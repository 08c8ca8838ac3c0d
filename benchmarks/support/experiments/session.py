"""A run: one robot by one clock, with its safety node and a recorder in processes of their own."""

from __future__ import annotations

import json
import os
import random
import sys
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from ..processes import Processes, run
from ..progress import Line
from ..usage import Meter, memory_mib, processor_time_ns
from .recording import NODE, RECORDER, RecordingError
from .robots import SIMULATED, Experiment, Robot

if TYPE_CHECKING:
    from .driver import Driver

EXAMPLES = Path(__file__).resolve().parents[3] / "examples"

MEASURED = "measured.json"
"""The file of a run with what is not on any topic."""

_BENCHMARKS = Path(__file__).resolve().parents[2]
_MEETING = 60.0
_LIMIT = 2.0
"""Seconds after its time in which an action has to come; then it counts as lost."""

_CALM = (0.3, 0.6)
"""The least and the most seconds for which all is well before a fault, which so meets any phase."""

_ON = 0.06
"""Seconds for which a fault stays when the action has come."""

_RECOVERY = 0.15
_RESETTING = 10.0


@dataclass(frozen=True, slots=True)
class Measured:
    """What a run has found besides its recordings.

    Attributes:
        processor: what the safety node took, in percent of one core, second by second.
        memory: how much of its memory was resident at the end, in MiB.
        memory_share: the same, in percent of the machine's.
        sleeps: how late a plain sleep ended meanwhile, in ns.
    """

    processor: list[float]
    memory: float
    memory_share: float
    sleeps: list[int]

    @classmethod
    def read(cls, folder: Path) -> Measured:
        """Return what the run in a folder has written.

        Raises:
            RecordingError: if it cannot be read.
        """
        path = folder / MEASURED
        try:
            return cls(**json.loads(path.read_text(encoding="utf-8")))
        except (OSError, ValueError, TypeError) as error:
            raise RecordingError(f"{path}: cannot be read: {error}") from error


def generate(robot: Robot, folder: Path) -> Path:
    """Generate the safety node of a robot as anybody would; return the folder of its package.

    Raises:
        ProcessError: if deros refuses the rules.
    """
    rules = EXAMPLES / robot.name / f"{robot.name}.deros"
    deros = [sys.executable, "-c", "from deros.cli.main import main; main()"]
    output = folder / robot.name
    run([*deros, "generate", str(rules), "--target", "python", "--output", str(output)])
    return output / f"{robot.name}_safety"


def record(robot: Robot, clock: str, repeat: int, package: Path, folder: Path, line: Line) -> None:
    """Repeat the experiments of a robot, in the ROS domain of the environment; write recordings.

    Args:
        robot: whose experiments.
        clock: by which clock.
        repeat: how many times each of them.
        package: that of its safety node.
        folder: where the run is recorded; a new one.
        line: shows how far it has come.

    Raises:
        ProcessError: if a process ends too early.
        TimeoutError: if the processes do not meet, or an action cannot be reset.
    """
    folder.mkdir(parents=True)
    simulated = clock == SIMULATED
    with Processes(folder) as processes:
        _start(processes, robot, simulated, package, folder)
        from . import driver as driving  # only now is the domain chosen

        meters: list[Meter] = []
        shares: list[float] = []

        def watch() -> None:
            processes.check()
            shares.extend(each.percent() for each in meters)
            meters[:] = [Meter.start(partial(processor_time_ns, processes.pid(robot.node)))]

        driver = driving.Driver(robot, simulated, watch)
        line.show(f"{robot.title} {clock}: waiting for all nodes to meet")
        driver.meet(readers=2, seconds=_MEETING)
        driver.run(1.0)
        _recover(driver, robot)
        meters.clear()
        shares.clear()
        for number, each in enumerate(_shuffled(robot.experiments, repeat), start=1):
            count = repeat * len(robot.experiments)
            line.show(f"{robot.title} {clock}: {number} of {count}, {each.name}")
            driver.run(random.uniform(*_CALM))
            driver.say(each.faults)
            driver.run_until(partial(driver.active.__getitem__, each.action), each.ideal + _LIMIT)
            driver.run(_ON)
            _recover(driver, robot)
        driver.run(_CALM[0])
        pid = processes.pid(robot.node)
        memory = memory_mib(pid)
        whole = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / (1 << 20)
        processes.end(robot.node)
        processes.end("recorder")
        sleeps = processes.end("sleeper")
        driver.close()
    measured = Measured(shares, memory, 100.0 * memory / whole, sleeps)
    (folder / MEASURED).write_text(json.dumps(asdict(measured)) + "\n", encoding="utf-8")


def _start(
    processes: Processes, robot: Robot, simulated: bool, package: Path, folder: Path
) -> None:
    topics = [f"sensor:{each.type}:{each.topic}" for each in robot.sensors]
    topics += [f"state:std_msgs/msg/Bool:{each}" for each in robot.actions]
    topics.append(f"events:diagnostic_msgs/msg/DiagnosticStatus:/{robot.node}/events")
    topics.append("state:diagnostic_msgs/msg/DiagnosticArray:/diagnostics")
    topics.append(f"state:std_msgs/msg/UInt64:/{robot.node}/heartbeat")
    if simulated:
        topics.append("sensor:rosgraph_msgs/msg/Clock:/clock")
    processes.start("experiment_nodes.recorder", str(folder / RECORDER), *topics)
    places = (_BENCHMARKS, package, package.with_name("deros_runtime"))
    env = {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, places))}
    parameters = {
        "use_sim_time": str(simulated).lower(),
        "startup_grace": "10.0",  # as in the systems of the examples
        "state_file": str(folder / "latches"),
    }
    settings = [part for name, each in parameters.items() for part in ("-p", f"{name}:={each}")]
    module = f"{package.name}.{robot.node}"
    command = [sys.executable, "-m", "experiment_nodes.watched_node", module, str(folder / NODE)]
    processes.start_program([*command, "--ros-args", *settings], env, robot.node)
    processes.start("reaction_nodes.sleeper")


def _shuffled(experiments: Sequence[Experiment], repeat: int) -> list[Experiment]:
    """Return each experiment so many times, all of them once before any comes again."""
    return [each for _ in range(repeat) for each in random.sample(experiments, len(experiments))]


def _recover(driver: Driver, robot: Robot) -> None:
    """End a fault, and have the actions reset.

    Raises:
        TimeoutError: if one of them stays active.
    """
    driver.say(robot.recovery)
    driver.run(_RECOVERY)
    if not driver.reset(_RESETTING):
        raise TimeoutError(f"{robot.title}: an action stays active although all is well")
    driver.say({})
