"""A run: one robot by one clock, with its safety node and a recorder in processes of their own."""

from __future__ import annotations

import json
import os
import random
import sys
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from ..processes import Processes, run
from ..progress import Line
from ..rclcpp_programs import build
from ..usage import Meter, memory_mib, processor_time_ns
from .recording import NODE, RECORDER, RecordingError
from .robots import CPP, GRACE_NS, PYTHON, SIMULATED, Experiment, Robot

if TYPE_CHECKING:
    from .driver import Driver

EXAMPLES = Path(__file__).resolve().parents[3] / "examples"

MEASURED = "measured.json"
"""The file of a run with what is not on any topic."""

_BENCHMARKS = Path(__file__).resolve().parents[2]
_MEETING = 60.0
_RECEIVER = "fastest_receiver"
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
        receiver: what a node of rclpy took that only receives the same topics, in percent of a
            core: the cheapest, which reads no message.
        memory: how much of its memory was resident at the end, in MiB.
        memory_share: the same, in percent of the machine's.
        sleeps: how late a plain sleep ended meanwhile, in ns.
    """

    processor: list[float]
    receiver: float
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


@dataclass(frozen=True, slots=True)
class SafetyNode:
    """A generated safety node: its robot and target, and how it is started.

    Attributes:
        command: the program; the file for what it takes follows where it is watched.
        env: the environment that it needs beyond this process's own.
        is_watched: whether it notes when it takes which message.
    """

    robot: Robot
    target: str
    command: Sequence[str]
    env: Mapping[str, str]
    is_watched: bool


def python_node(robot: Robot, folder: Path) -> SafetyNode:
    """Generate the safety node of a robot for rclpy.

    Raises:
        ProcessError: if deros refuses the rules.
    """
    package = _generate(robot, folder, "python") / f"{robot.name}_safety"
    places = (_BENCHMARKS, package, package.with_name("deros_runtime"))
    module = f"{package.name}.{robot.node}"
    return SafetyNode(
        robot,
        PYTHON,
        [sys.executable, "-m", "experiment_nodes.watched_node", module],
        {"PYTHONPATH": os.pathsep.join(map(str, places))},
        is_watched=True,
    )


def cpp_node(robot: Robot, folder: Path, env: Mapping[str, str]) -> SafetyNode:
    """Generate the safety node of a robot for rclcpp, and build it in an environment that has it.

    Raises:
        ProcessError: if deros refuses the rules, or the package cannot be built.
    """
    output = _generate(robot, folder, "cpp", "--runtime", "copy")
    program = folder / f"{robot.name}_build"
    build(output / f"{robot.name}_safety_cpp", program, env)
    command = [str(program / f"{robot.node}_cpp")]
    return SafetyNode(
        robot, CPP, command, {"LD_LIBRARY_PATH": env["LD_LIBRARY_PATH"]}, is_watched=False
    )


def _generate(robot: Robot, folder: Path, target: str, *options: str) -> Path:
    rules = EXAMPLES / robot.name / f"{robot.name}.deros"
    deros = [sys.executable, "-c", "from deros.cli.main import main; main()"]
    output = folder / robot.name
    command = ["generate", str(rules), "--target", target, "--output", str(output)]
    run([*deros, *command, *options])
    return output


def record(safety_node: SafetyNode, clock: str, repeat: int, folder: Path, line: Line) -> None:
    """Repeat the experiments of a robot, in the ROS domain of the environment; write recordings.

    Args:
        safety_node: that of the robot whose experiments they are.
        clock: by which clock.
        repeat: how many times each of them.
        folder: where the run is recorded; a new one.
        line: shows how far it has come.

    Raises:
        ProcessError: if a process ends too early.
        TimeoutError: if the processes do not meet, or an action cannot be reset.
    """
    folder.mkdir(parents=True)
    robot = safety_node.robot
    simulated = clock == SIMULATED
    with Processes(folder) as processes:
        _start(processes, safety_node, simulated, folder)
        from . import driver as driving  # only now is the domain chosen

        meters: list[Meter] = []
        shares: list[float] = []

        def watch() -> None:
            processes.check()
            shares.extend(each.percent() for each in meters)
            meters[:] = [Meter.start(partial(processor_time_ns, processes.pid(robot.node)))]

        driver = driving.Driver(robot, simulated, watch)
        title = f"{robot.title} {clock}, {safety_node.target}"
        line.show(f"{title}: waiting for all nodes to meet")
        driver.meet(readers=3, seconds=_MEETING)
        driver.run(1.0)
        _recover(driver, robot)
        meters.clear()
        shares.clear()
        receiver = Meter.start(partial(processor_time_ns, processes.pid(_RECEIVER)))
        for number, each in enumerate(_shuffled(robot.experiments, repeat), start=1):
            count = repeat * len(robot.experiments)
            line.show(f"{title}: {number} of {count}, {each.name}")
            driver.run(random.uniform(*_CALM))
            driver.say(each.faults)
            driver.run_until(partial(driver.active.__getitem__, each.action), each.ideal + _LIMIT)
            driver.run(_ON)
            _recover(driver, robot)
        driver.run(_CALM[0])
        received = receiver.percent()
        pid = processes.pid(robot.node)
        memory = memory_mib(pid)
        whole = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / (1 << 20)
        processes.end(robot.node)
        processes.end("recorder")
        processes.end(_RECEIVER)
        sleeps = processes.end("sleeper")
        driver.close()
    measured = Measured(shares, received, memory, 100.0 * memory / whole, sleeps)
    (folder / MEASURED).write_text(json.dumps(asdict(measured)) + "\n", encoding="utf-8")


def _start(processes: Processes, safety_node: SafetyNode, simulated: bool, folder: Path) -> None:
    robot = safety_node.robot
    topics = [f"sensor:{each.type}:{each.topic}" for each in robot.sensors]
    topics += [f"state:std_msgs/msg/Bool:{each}" for each in robot.actions]
    topics.append(f"events:diagnostic_msgs/msg/DiagnosticStatus:/{robot.node}/events")
    topics.append("state:diagnostic_msgs/msg/DiagnosticArray:/diagnostics")
    topics.append(f"state:std_msgs/msg/UInt64:/{robot.node}/heartbeat")
    if simulated:
        topics.append("sensor:rosgraph_msgs/msg/Clock:/clock")
    processes.start("experiment_nodes.recorder", str(folder / RECORDER), *topics)
    parameters = {
        "use_sim_time": str(simulated).lower(),
        "startup_grace": str(GRACE_NS / 1e9),
        "state_file": str(folder / "latches"),
    }
    settings = [part for name, each in parameters.items() for part in ("-p", f"{name}:={each}")]
    # The domain is one of this process's variables by now.
    env = {**os.environ, **safety_node.env}
    command = [*safety_node.command]
    if safety_node.is_watched:
        command.append(str(folder / NODE))
    else:  # libraries of rclcpp are not to be looked for by the interpreter's wheels
        env.pop("_ROS_WHEELS_BOOTSTRAP_COMPLETE", None)
    processes.start_program([*command, "--ros-args", *settings], env, robot.node)
    clock_of = ["--ros-args", "-p", f"use_sim_time:={parameters['use_sim_time']}"]
    sensors = [f"{each.type}:{each.topic}" for each in robot.sensors]
    processes.start(f"cost_nodes.{_RECEIVER}", *sensors, *clock_of)
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
