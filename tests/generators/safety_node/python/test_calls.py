"""Actions that call services, on real middleware: a server absent, refusing, hung and killed.

Each test runs with the safety node in either language.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from deros.generators.output.writer import write
from deros.generators.runtime.interface import PYTHON_RUNTIME, with_runtime
from deros.generators.safety_package.cpp import generate as safety_cpp
from deros.generators.safety_package.python import generate as safety_python
from tests.support.cpp import colcon_build, overlay, program
from tests.support.generating import output_of
from tests.support.needs import needs
from tests.support.processes import freeze
from tests.support.ros import LIMIT, Peer, running

pytestmark = pytest.mark.ros

MODEL = Path(__file__).with_name("models") / "calls.deros"
NODE = "calls_safety_node"
SWITCH = Path(__file__).resolve().parents[3] / "support/switch.py"
OK, WARN, ERROR = range(3)
ARM, BRAKE = "call of disarm", "call of brake"


class Robot:
    """The test's end: the speed, the reports of the safety node, and the server."""

    def __init__(self, peer: Peer, env: dict[str, str]) -> None:
        """Subscribe to the reports."""
        from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
        from rclpy.qos import DurabilityPolicy, QoSProfile
        from std_msgs.msg import Float64

        self.peer = peer
        self.events: list[dict[str, str]] = []
        self.faults: dict[str, str] = {}
        self.level = -1
        self._env = env
        self._message = Float64
        node = peer.node
        self._speed = node.create_publisher(Float64, "/speed", 5)
        history = QoSProfile(depth=1000, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        node.create_subscription(DiagnosticStatus, f"/{NODE}/events", self._take_event, history)
        node.create_subscription(DiagnosticArray, "/diagnostics", self._take_statuses, 10)

    def _take_event(self, msg: Any) -> None:
        values = {value.key: value.value for value in msg.values}
        self.events.append(values | {"message": msg.message})

    def _take_statuses(self, msg: Any) -> None:
        for status in msg.status:
            if status.name == f"/{NODE}":
                self.level = status.level[0]
                self.faults = {value.key: value.value for value in status.values}

    def drive(self, speed: float) -> None:
        """Publish a speed once the safety node listens."""
        self.peer.until(lambda: self._speed.get_subscription_count() == 1)
        self._speed.publish(self._message(data=speed))

    def count(self, kind: str, **values: str) -> int:
        """Return how many events of a kind have been reported."""
        wanted = {"kind": kind, **values}.items()
        return sum(event.items() >= wanted for event in self.events)

    def until_fault(self, subject: str, text: str) -> None:
        """Wait until the status of the node has a fault; an empty text: until it has not."""
        self.peer.until(lambda: self.level >= 0 and self.faults.get(subject, "") == text)

    def reset(self) -> Any:
        """Call the reset of the safety node, and return its response."""
        from std_srvs.srv import Trigger

        client = self.peer.node.create_client(Trigger, f"/{NODE}/reset")
        return self.peer.call(client, Trigger.Request())

    @contextmanager
    def switch(self, refusal: str = "") -> Iterator[subprocess.Popen[str]]:
        """Run a server of both services."""
        command = [sys.executable, str(SWITCH), *([refusal] if refusal else [])]
        with subprocess.Popen(
            command, env=self._env, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        ) as process:
            try:
                assert next_line(process) == "ready"
                yield process
            finally:
                process.kill()


def next_line(process: subprocess.Popen[str]) -> str:
    """Return the next line that the server prints."""
    assert process.stdout is not None
    return process.stdout.readline().strip()


@pytest.fixture
def robot(ros_peer: Peer, ros_env: dict[str, str]) -> Robot:
    """Give the test's end."""
    return Robot(ros_peer, ros_env)


def in_python(folder: Path, env: dict[str, str]) -> tuple[list[str], dict[str, str]]:
    """Generate the safety node in Python, and return what runs it and the environment for it."""
    write(with_runtime(output_of(safety_python.generate, MODEL)), folder)
    paths = [str(folder / "calls_safety"), str(folder / PYTHON_RUNTIME)]
    command = [sys.executable, "-m", f"calls_safety.{NODE}"]
    return command, {**env, "PYTHONPATH": os.pathsep.join(paths)}


def in_cpp(folder: Path, env: dict[str, str]) -> tuple[list[str], dict[str, str]]:
    """Generate it in C++ and build it; return the same."""
    write(with_runtime(output_of(safety_cpp.generate, MODEL)), folder)
    install = colcon_build(folder)
    return [program(install, "calls_safety_cpp", f"{NODE}_cpp")], overlay(install, env)


@pytest.fixture(
    params=[
        pytest.param(in_python, id="python"),
        pytest.param(in_cpp, id="cpp", marks=needs("rclcpp")),
    ]
)
def start(request: pytest.FixtureRequest, ros_env: dict[str, str], tmp_path: Path) -> Any:
    """Return what runs the generated safety node of a language."""
    command, env = request.param(tmp_path / "packages", ros_env)
    return lambda: running(command, env)


def test_absent_service_is_a_fault_until_it_comes_and_succeeds(start: Any, robot: Robot) -> None:
    """The request has the value of the rules, and success is reported."""
    with start():
        robot.drive(2.0)
        robot.until_fault(ARM, "/arm is not available")
        robot.until_fault(BRAKE, "/brake is not available")
        assert robot.level == ERROR
        with robot.switch() as server:
            robot.peer.until(lambda: robot.count("answered") == 2)
            requests = {next_line(server), next_line(server)}
            assert requests == {"SetBool_Request True", "Trigger_Request"}
            robot.until_fault(ARM, "")
            robot.until_fault(BRAKE, "")
    assert robot.count("answered", action="disarm", service="/arm") == 1
    # On a slow machine its answer may be late, which is another fault.
    assert robot.count("fault", message=f"{ARM}: /arm is not available") == 1


def test_refusal_is_a_fault_and_the_service_is_called_again(start: Any, robot: Robot) -> None:
    """The fault has the message of the server; a reset ends calls and fault."""
    with start(), robot.switch("in the\nair") as server:
        robot.drive(2.0)
        robot.until_fault(ARM, "/arm has answered no success: in the?air")
        lines = [next_line(server) for _ in range(8)]
        assert lines.count("SetBool_Request True") >= 3
        assert lines.count("Trigger_Request") >= 3
        assert robot.count("answered") == 0
        robot.drive(0.1)
        robot.until_fault(BRAKE, "")
        robot.until_fault(ARM, "/arm has answered no success: in the?air")
        assert robot.reset().success
        robot.until_fault(ARM, "")
    assert robot.count("fault", message=f"{ARM}: /arm has answered no success: in the?air") == 1


def test_server_that_hangs_is_replaced_by_another_one(start: Any, robot: Robot) -> None:
    """Requests to the one that was killed are lost, and the service is called anew."""
    with start():
        with robot.switch("not yet") as hung:
            robot.drive(2.0)
            robot.until_fault(ARM, "/arm has answered no success: not yet")
            freeze(hung.pid)
            robot.until_fault(ARM, "/arm has not answered")
        with robot.switch() as server:
            robot.peer.until(lambda: robot.count("answered", action="disarm") == 1)
            assert next_line(server)
            robot.until_fault(ARM, "")


def test_each_trigger_calls_again(start: Any, robot: Robot) -> None:
    """What has answered success before a reset does not count for the next trigger."""
    with start(), robot.switch() as server:
        for _ in range(2):
            robot.events.clear()
            robot.drive(2.0)
            robot.peer.until(lambda: robot.count("answered") == 2)
            assert {next_line(server), next_line(server)} == {
                "SetBool_Request True",
                "Trigger_Request",
            }
            robot.drive(0.1)
            robot.peer.until(lambda: robot.count("reset", action="brake"))
            assert robot.count("reset", action="disarm") == 0


def test_latched_action_calls_after_a_restart(start: Any, robot: Robot) -> None:
    """The new process does not know whether the old one had succeeded."""
    with start() as process:
        robot.drive(2.0)
        robot.until_fault(ARM, "/arm is not available")
        robot.peer.until(lambda: robot.count("trigger") == 2)  # else they might be heard later
        process.kill()
        process.wait(LIMIT)
    robot.events.clear()
    with robot.switch() as server, start():
        robot.peer.until(lambda: robot.count("answered", action="disarm") == 1)
        assert next_line(server) == "SetBool_Request True"
    assert robot.count("trigger") == 0


def test_service_that_is_not_there_is_a_fault_before_it_is_needed(start: Any, robot: Robot) -> None:
    """Five seconds after the start, as no stop could be carried out; it ends when one comes."""
    with start():
        robot.until_fault(ARM, "/arm is not available")
        with robot.switch():
            robot.until_fault(ARM, "")
    assert robot.count("trigger") == 0
