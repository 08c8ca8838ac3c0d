"""A generated safety node in a process of its own, in either language, and the robot around it."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import Any, ClassVar, Literal, NamedTuple

import pytest

from deros.generators.api.protocol import Files
from deros.generators.output.writer import write
from deros.generators.runtime.interface import PYTHON_RUNTIME, with_runtime
from deros.generators.safety_package.cpp import generate as safety_cpp
from deros.generators.safety_package.python import generate as safety_python
from tests.support.cpp import colcon_build, overlay, program
from tests.support.generating import output_of
from tests.support.needs import needs
from tests.support.ros import LIMIT, Peer, running

MODELS = Path(__file__).resolve().parent.parent / "generators/safety_node/python/models"
NODE = "every_thing_safety_node"

Process = subprocess.Popen[str]
Start = Callable[..., AbstractContextManager[Process]]


Code = Literal["", "tell", "fail"]
"""What the user has written for the action beep: nothing, a line in the log, or an error."""


def generated(target: Callable[..., Files], folder: Path) -> None:
    """Write the package of the model into a folder."""
    write(with_runtime(output_of(target, MODELS / "every_thing.deros")), folder)


class PythonNode:
    """The node in Python, out of its source tree."""

    actions_file = f"{NODE}_actions.py"
    sees_what_it_cannot_read = True
    _BODIES: ClassVar[dict[str, str]] = {
        "tell": "self.node.get_logger().info(f'beep {times} times: {why}')",
        "fail": "raise OSError('no horn')",
    }

    def __init__(self, folder: Path) -> None:
        """Generate the package into a folder."""
        generated(safety_python.generate, folder)
        self._package = folder / "every_thing_safety"
        self._path = f"{self._package}:{folder / PYTHON_RUNTIME}"

    def fill_in(self, code: Code) -> None:
        """Do a user's work: give the action beep a body."""
        path = self._package / "every_thing_safety" / self.actions_file
        text = path.read_text(encoding="utf-8")
        unfilled = r'    @not_filled_in\n(    def beep\(.*?\) -> None:\n        """.*?"""\n)'
        text, count = re.subn(
            unfilled,
            lambda found: f"{found[1]}        {self._BODIES[code]}\n",
            text,
            flags=re.DOTALL,
        )
        assert count == 1
        path.write_text(text, encoding="utf-8")

    def command(self, env: dict[str, str]) -> tuple[list[str], dict[str, str]]:
        """Return what runs the node, and the environment for it."""
        command = [sys.executable, "-m", f"every_thing_safety.{NODE}"]
        return command, {**env, "PYTHONPATH": self._path}


class CppNode:
    """The node in C++, built by colcon; both builds are kept."""

    actions_file = f"{NODE}_actions.cpp"
    sees_what_it_cannot_read = False
    """The middleware drops messages that are none of the type before the node sees them."""
    _CLASS = "EveryThingSafetyNodeActions"
    _BODY = """
        #include <cstdlib>
        #include <stdexcept>
        #include "every_thing_safety_cpp/every_thing_safety_node_actions.hpp"
        void every_thing_safety_cpp::EveryThingSafetyNodeActions::beep(
          double times, const std::string & why)
        {
          if (std::getenv("NO_HORN") != nullptr) {throw std::runtime_error("no horn");}
          RCLCPP_INFO(node().get_logger(), "beep %.0f times: %s", times, why.c_str());
        }
        """

    def __init__(self, folder: Path) -> None:
        """Generate the package into a folder."""
        generated(safety_cpp.generate, folder)
        self._folder = folder
        self._env: dict[str, str] = {}

    def fill_in(self, code: Code) -> None:
        """Do a user's work: declare the action beep, and give it a body."""
        package = self._folder / "every_thing_safety_cpp"
        header = package / "include/every_thing_safety_cpp" / f"{NODE}_actions.hpp"
        text = header.read_text(encoding="utf-8")
        text, count = re.subn(r"// (void beep\(.*\) override;)", r"\1", text)
        assert count == 1
        header.write_text(text, encoding="utf-8")
        (package / "src" / self.actions_file).write_text(self._BODY, encoding="utf-8")
        self._env = {"NO_HORN": "1"} if code == "fail" else {}

    def command(self, env: dict[str, str]) -> tuple[list[str], dict[str, str]]:
        """Return what runs the node, and the environment for it."""
        install = colcon_build(self._folder)
        command = [program(install, "every_thing_safety_cpp", f"{NODE}_cpp")]
        return command, {**overlay(install, env), **self._env}


Software = PythonNode | CppNode


@pytest.fixture(params=["python", pytest.param("cpp", marks=needs("rclcpp"))])
def node(request: pytest.FixtureRequest, tmp_path: Path) -> Software:
    """Give the generated node, in one language after the other."""
    return (PythonNode if request.param == "python" else CppNode)(tmp_path / "packages")


@pytest.fixture
def start(node: Software, ros_env: dict[str, str]) -> Start:
    """Return the function that starts the node of this test."""
    return starting(node, ros_env)


def starting(node: Software, ros_env: dict[str, str]) -> Start:
    """Return a function that runs a node with the parameters that it is given."""

    @contextmanager
    def run(*parameters: str) -> Iterator[Process]:
        arguments = [word for each in parameters for word in ("-p", each)]
        command, env = node.command(ros_env)
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
        self._health = node.create_publisher(DiagnosticStatus, "/diagnostics", 5)
        self._message, self._mode_message = Float64, UInt8
        self._health_message = DiagnosticStatus

    def _take_event(self, msg: Any) -> None:
        self.events.append({"message": msg.message, **{v.key: v.value for v in msg.values}})

    def _take_statuses(self, msg: Any) -> None:
        for each in msg.status:
            values = {value.key: value.value for value in each.values}
            name = each.name.removeprefix(f"/{NODE}").removeprefix(": ")
            self.statuses[name] = Status(each.level[0], each.message, values)

    def forget(self) -> None:
        """Forget all that was heard."""
        for heard in (self.stop, self.limit, self.beats, self.events, self.statuses):
            heard.clear()

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
        self._until(speed, condition)

    def _until(self, speed: float | None, condition: Callable[[], Any]) -> None:
        def once() -> Any:
            if speed is not None:
                self.drive(speed)
            return condition()

        self.peer.until(once)

    def take_over(self, mode: int) -> None:
        """Publish the operator's mode."""
        self._mode.publish(self._mode_message(data=mode))

    def report_health(self, *, ill: bool = False) -> None:
        """Publish whether the body is well."""
        kind = self._health_message
        self._health.publish(kind(level=kind.ERROR if ill else kind.OK))

    def set_parameter(self, name: str, value: bool) -> None:
        """Change a parameter of the safety node."""
        from rcl_interfaces.msg import Parameter, ParameterValue
        from rcl_interfaces.srv import SetParameters

        client = self.peer.node.create_client(SetParameters, f"/{NODE}/set_parameters")
        changed = Parameter(name=name, value=ParameterValue(type=1, bool_value=value))
        (result,) = self.peer.call(client, SetParameters.Request(parameters=[changed])).results
        assert result.successful, result.reason

    def reset(self, speed: float | None = None) -> Any:
        """Call the reset service and return its response.

        Args:
            speed: what is published all the while, so that it does not go missing.
        """
        from std_srvs.srv import Trigger

        client = self.peer.node.create_client(Trigger, f"/{NODE}/reset")
        self._until(speed, client.service_is_ready)
        future = client.call_async(Trigger.Request())
        self._until(speed, future.done)
        self.peer.node.destroy_client(client)
        return future.result()


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
