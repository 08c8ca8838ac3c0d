"""A generated safety node in a process of its own, and the robot around it."""

from __future__ import annotations

import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from deros.generators.protocol import Context
from deros.generators.safety_python.generate import generate
from deros.generators.writer import write
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.metamodels.rules import Rules
from tests.support.ros import LIMIT, Peer, running

MODELS = Path(__file__).resolve().parent.parent / "generators/safety_python/models"
NODE = "every_thing_safety_node"

Process = subprocess.Popen[str]
Start = Callable[..., AbstractContextManager[Process]]


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """Give the folder of the generated package."""
    context = Context(InterfaceStore(), Repository())
    model = context.repository.load(MODELS / "every_thing.deros").model
    assert isinstance(model, Rules)
    write(generate(model, context, {}), tmp_path)
    return tmp_path / "every_thing_safety"


@pytest.fixture
def start(package: Path, ros_env: dict[str, str]) -> Start:
    """Give a function that runs the node out of its source tree."""
    env = {**ros_env, "PYTHONPATH": str(package)}

    @contextmanager
    def run(*parameters: str) -> Iterator[Process]:
        arguments = [word for each in parameters for word in ("-p", each)]
        command = [sys.executable, "-m", f"every_thing_safety.{NODE}"]
        ros = ["--ros-args", *arguments] if arguments else []
        with running([*command, *ros], env) as process:
            yield process

    return run


class Status(NamedTuple):
    """One status of the diagnostics."""

    level: int
    message: str
    values: dict[str, str]


class Robot:
    """The test's end of the topics: what it published last, and all that it heard."""

    def __init__(self, peer: Peer) -> None:
        """Subscribe to what the safety node publishes, and publish what it watches."""
        from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
        from rclpy.qos import DurabilityPolicy, QoSProfile
        from std_msgs.msg import Bool, Float64, UInt8, UInt64

        self.peer = peer
        self.stop: list[bool] = []
        self.limit: list[float] = []
        self.beats: list[int] = []
        self.events: list[dict[str, str]] = []
        self.statuses: dict[str, Status] = {}
        kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        history = QoSProfile(depth=1000, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        node = peer.node
        node.create_subscription(Bool, "/stop", lambda m: self.stop.append(m.data), kept)
        node.create_subscription(Float64, "/limit", lambda m: self.limit.append(m.data), kept)
        node.create_subscription(
            UInt64, f"/{NODE}/heartbeat", lambda m: self.beats.append(m.data), 10
        )
        node.create_subscription(DiagnosticStatus, f"/{NODE}/events", self._take_event, history)
        node.create_subscription(DiagnosticArray, f"/{NODE}/diagnostics", self._take_statuses, 10)
        self._speed = node.create_publisher(Float64, "/speed", 5)
        self._mode = node.create_publisher(UInt8, "/mode", kept)
        self._message, self._mode_message = Float64, UInt8

    def _take_event(self, msg: Any) -> None:
        self.events.append({"message": msg.message, **{v.key: v.value for v in msg.values}})

    def _take_statuses(self, msg: Any) -> None:
        for each in msg.status:
            values = {value.key: value.value for value in each.values}
            name = each.name.removeprefix(f"/{NODE}").removeprefix(": ")
            self.statuses[name] = Status(each.level[0], each.message, values)

    def status(self, name: str = "") -> Status:
        """Return the last status of a rule, an action (``action NAME``) or the node itself."""
        return self.statuses.get(name, Status(-1, "", {}))

    def event(self, kind: str, **values: str) -> dict[str, str]:
        """Wait for the first event of a kind with the given values, and return it."""
        wanted = {"kind": kind, **values}.items()

        def first() -> dict[str, str] | None:
            return next((each for each in self.events if each.items() >= wanted), None)

        found: dict[str, str] = self.peer.until(first)
        return found

    def meet(self) -> None:
        """Wait until both ends know each other."""
        self.peer.until(lambda: self._speed.get_subscription_count() == 1)
        self.peer.until(lambda: self._mode.get_subscription_count() == 1)
        self.peer.until(lambda: self.beats and self.stop and self.limit)

    def drive(self, speed: float) -> None:
        """Publish a speed."""
        self._speed.publish(self._message(data=speed))

    def drive_until(self, speed: float, condition: Callable[[], Any]) -> None:
        """Publish a speed again and again, well within its timeout, until something happens."""

        def once() -> Any:
            self.drive(speed)
            return condition()

        self.peer.until(once)

    def take_over(self, mode: int) -> None:
        """Publish the operator's mode."""
        self._mode.publish(self._mode_message(data=mode))

    def set_parameter(self, name: str, value: bool) -> None:
        """Change a parameter of the safety node."""
        from rcl_interfaces.msg import Parameter, ParameterValue
        from rcl_interfaces.srv import SetParameters

        client = self.peer.node.create_client(SetParameters, f"/{NODE}/set_parameters")
        changed = Parameter(name=name, value=ParameterValue(type=1, bool_value=value))
        (result,) = self.peer.call(client, SetParameters.Request(parameters=[changed])).results
        assert result.successful, result.reason

    def reset(self) -> Any:
        """Call the reset service and return its response."""
        from std_srvs.srv import Trigger

        client = self.peer.node.create_client(Trigger, f"/{NODE}/reset")
        return self.peer.call(client, Trigger.Request())


@pytest.fixture
def robot(ros_peer: Peer) -> Robot:
    """Give the test's end of the topics."""
    return Robot(ros_peer)


def end(
    process: Process, robot: Robot, number: signal.Signals = signal.SIGTERM
) -> tuple[int, list[str]]:
    """Send a signal, and return what :func:`result_of` does.

    The node acts first and logs then, so it is left alone until it has beaten again.
    """
    beats = len(robot.beats)
    robot.peer.until(lambda: len(robot.beats) >= beats + 2)
    process.send_signal(number)
    return result_of(process)


def result_of(process: Process) -> tuple[int, list[str]]:
    """Wait for the end, and return the exit code and the lines printed, without their time."""
    output, _ = process.communicate(timeout=LIMIT)
    lines = [line.partition(f"[{NODE}]: ")[2] or line for line in output.splitlines()]
    return process.returncode, lines
