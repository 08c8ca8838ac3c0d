"""A small robot whose parts can be broken: processes to kill, to freeze and to feed.

Its rules are those of tests/faults/models. The test holds the end of the topics that the robot's
motors would have, and sees there whether it is stopped.
"""

from __future__ import annotations

import base64
import contextlib
import json
import re
import select
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, TextIO

from deros.generators.protocol import Context
from deros.generators.safety_python.generate import generate
from deros.generators.writer import write
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.metamodels.rules import Rules
from tests.support.ros import LIMIT, Peer

NODE = "faulty_safety_node"
PACKAGE = "faulty_safety"

TOPICS = {
    "/speed": "std_msgs/msg/Float64",
    "/imu": "sensor_msgs/msg/Imu",
    "/scan": "sensor_msgs/msg/LaserScan",
    "/load": "std_msgs/msg/Float64",
    "/button": "std_msgs/msg/Bool",
}
"""What the rules watch."""

PROMPT = 1.0
"""Seconds from hearing a violation to the stop that counts as not missed, on any machine.

How fast deros is, is measured by the benchmarks, beside the floor that the machine sets. Here the
question is whether a fault can lose, block or starve a stop.
"""

VIOLATION = 9.0
"""The speed, in m/s, by which a test's end sees whether the robot is still protected."""

_SENSOR = Path(__file__).with_name("sensor.py")
_UNFILLED = re.compile(r"^    @not_filled_in\n", re.MULTILINE)
_ALARMS = re.compile(
    r"Traceback|\[FATAL\]|Segmentation|terminate called|core dumped", re.IGNORECASE
)


def generate_robot(rules: Path, folder: Path) -> Path:
    """Generate the safety node of ``rules`` into a folder, and return the package's folder.

    Its actions that are robot code are filled in: they do nothing.
    """
    context = Context(InterfaceStore(), Repository())
    model = context.repository.load(rules).model
    assert isinstance(model, Rules), context.repository.diagnostics
    write(generate(model, context, {}), folder)
    actions = folder / PACKAGE / PACKAGE / f"{NODE}_actions.py"
    filled, count = _UNFILLED.subn("", actions.read_text(encoding="utf-8"))
    assert count == 2
    actions.write_text(filled.replace("    not_filled_in,\n", ""), encoding="utf-8")
    return folder / PACKAGE


class Process:
    """A process of the robot: its output goes to a file, because a full pipe would block it."""

    def __init__(
        self, command: Sequence[str], env: Mapping[str, str], log: Path, stdin: int | None = None
    ) -> None:
        """Start the command."""
        self.name = log.stem
        self.command, self.env = command, env
        self._log = log
        with log.open("w") as file:
            self.popen = subprocess.Popen(
                command, env=env, stdin=stdin, stdout=file, stderr=subprocess.STDOUT, text=True
            )

    def kill(self) -> None:
        """End it as a crash would: without a word."""
        self.popen.kill()
        self.popen.wait(LIMIT)

    def freeze(self) -> None:
        """Let it hang, as a deadlock or a swapping machine would."""
        self.popen.send_signal(signal.SIGSTOP)

    def thaw(self) -> None:
        """Let it go on."""
        self.popen.send_signal(signal.SIGCONT)

    def output(self) -> str:
        """Return what it has printed up to now."""
        return self._log.read_text(encoding="utf-8", errors="replace")

    def memory(self) -> int:
        """Return the bytes of memory that are its own."""
        status = Path(f"/proc/{self.popen.pid}/status").read_text(encoding="ascii")
        return int(re.findall(r"RssAnon:\s+(\d+) kB", status)[0]) * 1024

    def end(self) -> None:
        """End it by SIGINT.

        Raises:
            AssertionError: if that does not end it well, or it has printed what no node should.
        """
        self.popen.send_signal(signal.SIGINT)
        try:
            code = self.popen.wait(LIMIT)
        except subprocess.TimeoutExpired:
            raise AssertionError(f"{self.name} hangs: it does not end by SIGINT") from None
        assert code == 0, f"{self.name} ended with {code}"
        found = _ALARMS.search(self.output())
        assert found is None, f"{self.name} printed {found and found[0]}"


class Sensors:
    """The process that plays the robot's sensors, by :mod:`tests.support.sensor`."""

    def __init__(self, topics: Mapping[str, str], env: Mapping[str, str]) -> None:
        """Start it, with a publisher for each topic."""
        command = [sys.executable, str(_SENSOR), *(f"{t}={name}" for t, name in topics.items())]
        self._popen = subprocess.Popen(
            command, env=env, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        self._answer()

    def match(self, *topics: str) -> None:
        """Wait until the safety node listens to each of the topics.

        The test's end listens to the speed, too.
        """
        for topic in topics:
            self._do({"match": topic, "count": 2 if topic == "/speed" else 1})

    def play(self, topic: str, *messages: Any, rate: float = 50.0) -> None:
        """Publish the messages in turn, again and again."""
        self._do({"play": topic, "messages": _serialized(messages), "rate": rate})

    def drive(self) -> None:
        """Play a robot that keeps to its rules, and an operator who undoes what was before."""
        self.match("/speed", "/imu", "/button")
        self.play("/speed", speed(0.3))
        self.play("/imu", imu())
        self.play("/button", button(True), button(False))

    def quiet(self, topic: str) -> int:
        """Publish nothing on this topic any more; return how many messages have been played."""
        return self._do({"quiet": topic})

    def send(self, topic: str, *messages: Any, times: int = 0, rate: float = 1e6) -> None:
        """Publish the messages in turn, each once or so many ``times`` in all; wait for the end."""
        command = {"send": topic, "messages": _serialized(messages), "rate": rate}
        self._do({**command, "times": times or len(messages)})

    def kill(self) -> None:
        """End the sensors as a crash would."""
        self._popen.kill()
        self._popen.wait(LIMIT)

    def freeze(self) -> None:
        """Let the sensors hang."""
        self._popen.send_signal(signal.SIGSTOP)

    def thaw(self) -> None:
        """Let the sensors go on."""
        self._popen.send_signal(signal.SIGCONT)

    def close(self) -> None:
        """End the process, in whatever state it is."""
        with contextlib.suppress(BrokenPipeError), self._popen:
            self._popen.kill()

    def _do(self, command: dict[str, Any]) -> int:
        pipe = _present(self._popen.stdin)
        pipe.write(json.dumps(command) + "\n")
        pipe.flush()
        return self._answer()

    def _answer(self) -> int:
        pipe = _present(self._popen.stdout)
        assert select.select([pipe], [], [], LIMIT)[0], "the sensors do not answer"
        answer = pipe.readline().strip()
        assert answer.isdigit(), "the sensors have failed"
        return int(answer)


def _present(pipe: Any) -> TextIO:
    assert pipe is not None
    return pipe  # type: ignore[no-any-return]


def _serialized(messages: Sequence[Any]) -> list[str]:
    """Return messages as the sensors take them; bytes are passed on as they are."""
    from rclpy.serialization import serialize_message

    raw = (each if isinstance(each, bytes) else serialize_message(each) for each in messages)
    return [base64.b64encode(each).decode("ascii") for each in raw]


class Robot:
    """The robot under test, seen from its motors."""

    def __init__(self, package: Path, folder: Path, env: Mapping[str, str], peer: Peer) -> None:
        """Listen to what the safety node publishes."""
        from std_msgs.msg import Bool, Float64, UInt64

        self.peer = peer
        self.folder = folder
        self.env = {
            **env,
            "PYTHONPATH": str(package),
            "ROS_HOME": str(folder),
            "ROS_LOG_DIR": str(folder / "log"),
        }
        self.states: dict[str, list[bool]] = {"/stop": [], "/halt": [], "/slow": []}
        self.beats: list[int] = []
        self._heard: list[float] = []  # the speeds
        self._prober: Sensors | None = None
        self._node: Process | None = None
        self._processes: list[Process] = []
        for topic, seen in self.states.items():
            self._listen(Bool, topic, seen)
        self._listen(UInt64, f"/{NODE}/heartbeat", self.beats)
        self._listen(Float64, "/speed", self._heard)

    def _listen(self, message: Any, topic: str, seen: list[Any]) -> None:
        from rclpy.qos import DurabilityPolicy, QoSProfile

        kept = (
            DurabilityPolicy.TRANSIENT_LOCAL if topic in self.states else DurabilityPolicy.VOLATILE
        )
        self.peer.node.create_subscription(
            message, topic, lambda m: seen.append(m.data), QoSProfile(depth=100, durability=kept)
        )

    # What the test may ask

    def is_active(self, topic: str) -> bool:
        """Return whether the action of a topic is active, as far as the robot knows."""
        seen = self.states[topic]
        return bool(seen) and seen[-1]

    def until(self, condition: Callable[[], Any], limit: float = LIMIT) -> Any:
        """Wait until something is true."""
        return self.peer.until(condition, limit)

    def until_stopped(self, topic: str = "/stop", limit: float = LIMIT) -> None:
        """Wait until an action is active."""
        self.peer.until(lambda: self.is_active(topic), limit)

    def until_free(self) -> None:
        """Wait until the sensors are heard, and the operator has undone the halt without them."""
        self.until(lambda: not self.is_active("/halt"))

    def until_alive(self) -> None:
        """Wait for news of the safety node: what it says after, it has said now."""
        beats = len(self.beats)
        self.peer.until(lambda: len(self.beats) >= beats + 2)

    def spin(self, seconds: float) -> None:
        """Listen for a time in which something must *not* happen."""
        end = time.monotonic() + seconds
        self.peer.until(lambda: time.monotonic() >= end)

    # Processes

    @contextlib.contextmanager
    def sensors(self, topics: Mapping[str, str] = TOPICS, **env: str) -> Iterator[Sensors]:
        """Run a process that plays sensors."""
        sensors = Sensors(topics, {**self.env, **env})
        try:
            yield sensors
        finally:
            sensors.close()

    def start(self, module: str = NODE, parameters: Sequence[str] = (), **env: str) -> Process:
        """Start a node of the generated package; whoever starts it ends it."""
        words = [word for each in parameters for word in ("-p", each)]
        ros = ["--ros-args", *words] if words else []
        command = [sys.executable, "-m", f"{PACKAGE}.{module}", *ros]
        return self._start(command, {**self.env, **env}, module)

    def _start(self, command: Sequence[str], env: Mapping[str, str], name: str) -> Process:
        number = len(self._processes)
        process = Process(command, env, self.folder / f"{name.split('.')[0]}.{number}.log")
        self._processes.append(process)
        return process

    @contextlib.contextmanager
    def safety_node(self, *parameters: str, **env: str) -> Iterator[Process]:
        """Run the safety node through a fault, and see that it has survived it.

        It begins halted, since no sensor plays yet.

        Survived means, for every fault alike: a violation still stops the robot, promptly; the
        node ends by SIGINT, with 0; and nothing that it has printed looks like a failure.
        """
        try:
            self._node = self.start(NODE, parameters, **env)
            self._prepare()
            self.until_stopped("/halt")
            yield self._node
            self.assert_protects()
            self._node.end()
        finally:
            self.clear()

    def restart(self) -> Process:
        """Start the safety node again, as it was started before, once it has ended."""
        assert self._node is not None
        assert self._node.popen.poll() is not None
        self._node = self._start(self._node.command, self._node.env, self._node.name)
        self._prepare()
        return self._node

    def _prepare(self) -> None:
        """Have the safety node know whom the test breaks rules with; wait until it beats."""
        if self._prober is not None:
            self._prober.close()  # it still counts a node that was killed
        self._prober = Sensors({"/speed": TOPICS["/speed"]}, self.env)
        self._prober.match("/speed")
        self.until_alive()

    def violate(self) -> None:
        """Break the rule of the latched stop for a moment, and see the stop come.

        Raises:
            AssertionError: if the stop is missed.
        """
        assert self._prober is not None
        self._heard.clear()
        self._prober.play("/speed", speed(VIOLATION))
        self.until(lambda: VIOLATION in self._heard)
        self.until_stopped(limit=PROMPT)
        self._prober.play("/speed", speed(0.1))
        self.until(lambda: 0.1 in self._heard)

    def reset(self) -> tuple[bool, str]:
        """Call the reset service; return whether it was done, and what it says."""
        from std_srvs.srv import Trigger

        client = self.peer.node.create_client(Trigger, f"/{NODE}/reset")
        response = self.peer.call(client, Trigger.Request())
        self.peer.node.destroy_client(client)
        return response.success, response.message

    def assert_protects(self) -> None:
        """See that the node lives, and that a violation stops the robot unless it is stopped.

        Raises:
            AssertionError: if the stop is missed.
        """
        self.until_alive()
        if not self.is_active("/stop"):
            self.violate()

    def clear(self) -> None:
        """Kill what still runs, and show what all have printed, should the test fail."""
        for process in self._processes:
            if process.popen.poll() is None:
                process.kill()
            print(f"--- {process.name}:\n{process.output()}")
        self._processes.clear()
        if self._prober is not None:
            self._prober.close()


def speed(value: float) -> Any:
    """Return a message of the encoders."""
    from std_msgs.msg import Float64

    return Float64(data=value)


load = speed
"""Return a message of the load cell."""


def ticks(first: float = 1000.0, *, step: float = 0.02) -> list[Any]:
    """Return messages of /clock, a minute's worth at 50 Hz."""
    from rosgraph_msgs.msg import Clock  # type: ignore[import-untyped]

    messages = []
    for number in range(3000):
        message = Clock()
        now = round((first + number * step) * 1e9)
        message.clock.sec, message.clock.nanosec = divmod(now, 1_000_000_000)
        messages.append(message)
    return messages


def button(pressed: bool) -> Any:
    """Return a message of the operator's button."""
    from std_msgs.msg import Bool

    return Bool(data=pressed)


def imu(roll: float = 0.0, *, stamp: float = 0.0) -> Any:
    """Return a message of the IMU, tilted by ``roll`` radians."""
    import math

    from sensor_msgs.msg import Imu

    message = Imu()
    message.header.stamp.sec = int(stamp)
    message.orientation.x, message.orientation.w = math.sin(roll / 2), math.cos(roll / 2)
    return message


def scan(distance: float, beams: int = 360) -> Any:
    """Return a message of the lidar, all around at one distance; a beam takes four bytes."""
    import array
    import math

    from sensor_msgs.msg import LaserScan

    message = LaserScan(angle_min=-math.pi, angle_max=math.pi, range_min=0.05, range_max=30.0)
    message.angle_increment = 2 * math.pi / beams
    message.ranges = array.array("f", [distance]) * beams
    return message
