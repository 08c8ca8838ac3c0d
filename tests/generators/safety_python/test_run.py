"""The generated safety node on the real middleware."""

from __future__ import annotations

import itertools
import re
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import Any

import pytest

from deros.generators.protocol import Context
from deros.generators.safety_python.generate import generate
from deros.generators.writer import write
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.metamodels.rules import Rules
from tests.support.ros import LIMIT, Peer, running

pytestmark = pytest.mark.ros

MODELS = Path(__file__).resolve().parent / "models"
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


class Robot:
    """The test's end of the topics: what it published last, and all that it heard."""

    def __init__(self, peer: Peer) -> None:
        """Subscribe to what the safety node publishes, and publish what it watches."""
        from rclpy.qos import DurabilityPolicy, QoSProfile
        from std_msgs.msg import Bool, Float64, UInt8, UInt64

        self.peer = peer
        self.stop: list[bool] = []
        self.limit: list[float] = []
        self.beats: list[int] = []
        kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        node = peer.node
        node.create_subscription(Bool, "/stop", lambda m: self.stop.append(m.data), kept)
        node.create_subscription(Float64, "/limit", lambda m: self.limit.append(m.data), kept)
        node.create_subscription(
            UInt64, f"/{NODE}/heartbeat", lambda m: self.beats.append(m.data), 10
        )
        self._speed = node.create_publisher(Float64, "/speed", 5)
        self._mode = node.create_publisher(UInt8, "/mode", kept)
        self._message, self._mode_message = Float64, UInt8

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


def test_a_violation_stops_the_robot_until_it_is_reset(start: Start, robot: Robot) -> None:
    """Violation in, stop out; a reset is refused while the rule is broken, and says by what."""
    with start() as process:
        robot.meet()
        assert robot.stop[-1] is False
        robot.drive_until(0.9, lambda: robot.stop[-1])

        refused = robot.reset()
        assert not refused.success
        assert refused.message.startswith("stop stays active, called for by speeding (every_thing.")

        robot.drive(0.1)
        assert robot.peer.until(lambda: (answer := robot.reset()).success and answer)
        robot.peer.until(lambda: robot.stop[-1] is False)
        assert robot.reset().message == "no latched action was active"

        code, lines = end(process, robot)
    assert code == 0
    place = "speeding (every_thing.deros:28: if drive.fast for 100 ms)"
    assert lines[0] == "watching 8 rules of every_thing.deros"
    assert f"stop, by {place}" in lines
    assert f"speed limit exceeded, by {place}" in lines
    assert "stop is reset" in lines


def test_an_action_without_code_is_never_silent(start: Start, robot: Robot) -> None:
    """The node says at its start what is not filled in, and again when it would have acted."""
    with start() as process:
        robot.meet()
        robot.drive_until(0.9, lambda: robot.stop[-1])
        code, lines = end(process, robot)
    file = "every_thing_safety_node_actions.py"
    assert code == 0
    assert f"action beep does nothing: write its code in {file}" in lines
    assert f"action release does nothing: write its code in {file}" in lines
    assert (
        f"action beep(3, 'too fast') should have been carried out now: write its code in {file}"
        in lines
    )


def fill_in(package: Path, body: str) -> None:
    """Do a user's work: give the action beep a body."""
    path = package / "every_thing_safety" / f"{NODE}_actions.py"
    text = path.read_text(encoding="utf-8")
    unfilled = r'    @not_filled_in\n(    def beep\(.*?\) -> None:\n        """.*?"""\n)'
    text, count = re.subn(
        unfilled, lambda found: f"{found[1]}        {body}\n", text, flags=re.DOTALL
    )
    assert count == 1
    path.write_text(text, encoding="utf-8")


def test_the_users_code_runs(start: Start, robot: Robot, package: Path) -> None:
    """A body that the user writes is called with the arguments of the rules."""
    fill_in(package, "self.node.get_logger().info(f'beep {times} times: {why}')")
    with start() as process:
        robot.meet()
        robot.drive_until(0.9, lambda: robot.stop[-1])
        _, lines = end(process, robot)
    assert "beep 3 times: too fast" in lines
    assert not [line for line in lines if line.startswith("action beep")]


def test_a_failing_action_does_not_keep_others_from_acting(
    start: Start, robot: Robot, package: Path
) -> None:
    """The rest of the event is done, and then the node ends, so that its heartbeat stops."""
    fill_in(package, "raise OSError('no horn')")
    with start() as process:
        robot.meet()
        robot.drive_until(0.9, lambda: robot.stop[-1])
        output, _ = process.communicate(timeout=LIMIT)
    assert process.returncode == 1
    assert "action beep failed" in output
    assert "speed limit exceeded, by speeding" in output


def test_a_silent_sensor_and_a_takeover(start: Start, robot: Robot) -> None:
    """A deadline acts without any message; another action resets it, as the rules say."""
    with start() as process:
        robot.meet()
        robot.peer.until(lambda: robot.limit[-1] == 0.2)
        # A takeover may overtake the speed and be refused; then the operator does it again.
        modes = itertools.cycle([0, 1])

        def released() -> bool:
            robot.take_over(next(modes))
            return robot.limit[-1] == 0.0

        robot.drive_until(0.1, released)
        code, lines = end(process, robot, signal.SIGINT)
    assert code == 0
    assert "crawl, by lost (every_thing.deros:29: if drive.silent or body.ill)" in lines
    assert "crawl is reset" in lines


def test_it_beats_and_repeats_at_publish_freq(start: Start, robot: Robot) -> None:
    """Heartbeat and states come again and again, faster when the parameter says so."""
    with start("publish_freq:=100.0") as process:
        robot.meet()
        states, beats = len(robot.stop), len(robot.beats)
        robot.peer.until(lambda: len(robot.beats) >= beats + 20)
        assert len(robot.stop) >= states + 10
        assert robot.beats == sorted(set(robot.beats))
        code, _ = end(process, robot)
    assert code == 0


def test_simulated_time_steps_and_starts_late(start: Start, robot: Robot) -> None:
    """Deadlines follow /clock; it may begin at any time, and a step back is reported."""
    from rosgraph_msgs.msg import Clock  # type: ignore[import-untyped]

    clock = robot.peer.node.create_publisher(Clock, "/clock", 10)
    seconds = 1000.0

    def tick(step: float) -> None:
        nonlocal seconds
        seconds += step
        message = Clock()
        message.clock.sec, message.clock.nanosec = int(seconds), int(seconds % 1 * 1e9)
        clock.publish(message)

    def ticking_until(step: float, condition: Callable[[], Any]) -> None:
        def once() -> Any:
            tick(step)
            return condition()

        robot.peer.until(once)

    with start("use_sim_time:=true") as process:
        robot.peer.until(lambda: clock.get_subscription_count() == 1)
        robot.peer.until(lambda: robot.limit)
        tick(0.0)
        begun = seconds
        ticking_until(0.02, lambda: robot.limit[-1] == 0.2)
        assert seconds >= begun + 0.5
        beats = len(robot.beats)
        tick(-500.0)
        ticking_until(0.02, lambda: len(robot.beats) > beats + 2)
        process.send_signal(signal.SIGTERM)
        code, lines = result_of(process)
    assert code == 0
    (crawl,) = [n for n, line in enumerate(lines) if line.startswith("crawl, by lost")]
    (step,) = [n for n, line in enumerate(lines) if line.startswith("the clock stepped back")]
    assert crawl < step
