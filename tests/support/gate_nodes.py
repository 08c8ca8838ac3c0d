"""Generated gates as processes, and the rest of the robot as a test plays it."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from subprocess import Popen
from typing import Any

from deros.generators.gate.python.interface import gate_files, gate_nodes
from deros.generators.node.python.generate import package_files
from deros.generators.output.writer import write
from deros.generators.runtime.python.interface import PythonRuntime
from deros.generators.safety_node.node import safety_node
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.rules import Rules
from deros.rules.compiler.build import build
from tests.support.ros import Peer, running, with_lease

MODELS = Path(__file__).resolve().parent.parent / "generators/gate/python/models"
PACKAGE = "gates_safety"
SAFETY_NODE = "gates_safety_node"
GATE = "cmd_vel_gate"
STILL = (0.0, 0.0, 0.0)
"""The command to a drive that must stop: forward, sideways, turning."""


def write_gates(folder: Path, name: str = "gates") -> Path:
    """Generate the gates of a model, without the safety node, and return their package."""
    store, repository = InterfaceStore(), Repository()
    model = repository.load(MODELS / f"{name}.deros").model
    assert isinstance(model, Rules)
    built = build(model, store)
    assert built.program is not None, built.diagnostics
    safety = safety_node(built.program, built.topics, {}, model.source)
    nodes = gate_nodes(built.program, built.topics, safety)
    files = package_files(nodes, {}, raw={node.name for node in nodes})
    runtime = PythonRuntime(safety.package)
    write(files | gate_files(built.program, nodes, safety, store, runtime), folder)
    return folder / safety.package


@contextmanager
def running_gate(
    package: Path, gate: str, env: dict[str, str], *parameters: str
) -> Iterator[Popen[str]]:
    """Run a gate out of its source tree."""
    command = [sys.executable, "-m", f"{package.name}.{gate}"]
    arguments = [word for each in parameters for word in ("-p", each)]
    ros = ["--ros-args", *arguments] if arguments else []
    with running([*command, *ros], {**env, "PYTHONPATH": str(package)}) as process:
        yield process


_PROFILES = """<?xml version="1.0" encoding="UTF-8"?>
<profiles xmlns="http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles">
  <transport_descriptors>
    <transport_descriptor>
      <transport_id>udp</transport_id>
      <type>UDPv4</type>
      <interfaceWhiteList><address>127.0.0.1</address></interfaceWhiteList>
    </transport_descriptor>
    <transport_descriptor><transport_id>shm</transport_id><type>SHM</type></transport_descriptor>
  </transport_descriptors>
  <participant profile_name="both" is_default_profile="true">
    <rtps>
      <userTransports>
        <transport_id>udp</transport_id>
        <transport_id>shm</transport_id>
      </userTransports>
      <useBuiltinTransports>false</useBuiltinTransports>
    </rtps>
  </participant>
</profiles>
"""


def with_shared_memory(folder: Path, lease_s: int = 1) -> dict[str, str]:
    """Return an environment for processes on the loopback that talk through shared memory, too.

    Args:
        folder: where the profile is written.
        lease_s: how long others keep what a process had once it was killed.
    """
    return with_lease(_PROFILES, folder, lease_s)


class World:
    """All that is around a gate of commands for a drive: who commands, the drive, the rules.

    Attributes:
        heard: what the gate published, serialized, with the time at which it did, in s since the
            epoch.
        status: its last status on /diagnostics: name, level, message, and all values.
        reports: how many of these there have been.
        beats: how many heartbeats it has published.
        stop_publisher, mode_publisher, heartbeat: the publishers of the safety node.
        drive: the subscription of the drive.
    """

    def __init__(self, peer: Peer, source: str = "/cmd_vel_nav", target: str = "/cmd_vel") -> None:
        """Open the topics; the gate's node may come later."""
        from diagnostic_msgs.msg import DiagnosticArray
        from geometry_msgs.msg import Twist
        from rclpy.clock import Clock
        from rclpy.clock_type import ClockType
        from rclpy.qos import DurabilityPolicy, QoSProfile
        from std_msgs.msg import Bool, UInt8, UInt64

        self.peer = peer
        self.target = target
        self.heard: list[tuple[float, bytes]] = []
        self.status: dict[str, str] = {}
        self.reports = self.beats = 0
        self._types = Twist, Bool, UInt8, UInt64
        self._said: dict[Any, Any] = {}
        kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        node = peer.node
        self._wish = node.create_publisher(Twist, source, 10)
        self.stop_publisher = node.create_publisher(Bool, "/stop", kept)
        self.mode_publisher = node.create_publisher(UInt8, "/mode", kept)
        self.heartbeat = node.create_publisher(UInt64, f"/{SAFETY_NODE}/heartbeat", 10)
        self.drive = self.listen()
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        node.create_subscription(DiagnosticArray, "/diagnostics", self._take_status, 10)
        self.beating = node.create_timer(0.05, self.live, clock=steady)

    def listen(self) -> Any:
        """Be the drive: subscribe to what the gate lets through."""
        return self.peer.node.create_subscription(
            self._types[0], self.target, self._take, 10, raw=True
        )

    def _take_status(self, message: Any) -> None:
        (status,) = message.status
        self.reports += 1
        self.status = {each.key: each.value for each in status.values}
        self.status |= {"name": status.name, "message": status.message}
        self.status["level"] = str(status.level[0])

    def _take(self, data: bytes, info: dict[str, int]) -> None:
        self.heard.append((info["source_timestamp"] / 1e9, data))

    def meet(self) -> None:
        """Wait until all ends know each other."""
        ends = (self._wish, self.stop_publisher, self.mode_publisher, self.heartbeat)
        self.peer.until(lambda: all(each.get_subscription_count() for each in ends))
        self.peer.until(lambda: self.heard)

    def hear_after(self, count: int) -> None:
        """Wait until more than ``count`` commands were heard."""
        self.peer.until(lambda: len(self.heard) > count)

    def beat(self) -> None:
        """Be the safety node's heartbeat, once."""
        self.beats += 1
        self.heartbeat.publish(self._types[3](data=self.beats))

    def live(self) -> None:
        """Be the safety node, once: its heartbeat, and what is active, which it says steadily.

        Should this process be held up for longer than a heartbeat may be missing, everything
        counts as active until the gate receives the next state.
        """
        self.beat()
        for publisher, state in self._said.items():
            publisher.publish(state)

    def stop(self, active: bool) -> None:
        """Publish whether the stop is active."""
        self._say(self.stop_publisher, self._types[1](data=active))

    def mode(self, value: int) -> None:
        """Publish which limits are active: 1 those of slow, 2 those of slower, 0 none."""
        self._say(self.mode_publisher, self._types[2](data=value))

    def _say(self, publisher: Any, state: Any) -> None:
        self._said[publisher] = state
        publisher.publish(state)

    def wish(self, x: float, turn: float = 0.0, y: float = 0.0) -> bytes:
        """Command a speed, and return the command as it goes out."""
        from rclpy.serialization import serialize_message

        message = self._types[0]()
        message.linear.x, message.linear.y, message.angular.z = x, y, turn
        data: bytes = serialize_message(message)
        self._wish.publish(data)
        return data

    def wish_bytes(self, data: bytes) -> None:
        """Publish what may be no command at all."""
        self._wish.publish(data)

    @property
    def last(self) -> tuple[float, float, float]:
        """What the drive does: forward, sideways, turning."""
        return self.speeds(self.heard[-1][1])

    def speeds(self, data: bytes) -> tuple[float, float, float]:
        """Return what a command says."""
        from rclpy.serialization import deserialize_message

        message: Any = deserialize_message(data, self._types[0])
        return message.linear.x, message.linear.y, message.angular.z

    def release(self) -> None:
        """Say that nothing is active, and wish until all that was wished has come out."""
        self.stop(False)
        self.mode(0)
        self.wish_until(0.3, lambda: self.last == (0.3, 0.0, 0.0))
        last = self.wish(0.3, y=0.001)
        self.peer.until(lambda: self.heard[-1][1] == last)

    def wish_for(self, seconds: float) -> list[tuple[float, float, float]]:
        """Command a speed for a time, and return the commands that the drive received meanwhile."""
        before, end = len(self.heard), time.monotonic() + seconds
        self.wish_until(0.3, lambda: time.monotonic() > end)
        return [self.speeds(data) for _, data in self.heard[before:]]

    def assert_stands(self, seconds: float) -> None:
        """Command a speed for a time, and see that zeros come steadily, and nothing else."""
        received = self.wish_for(seconds)
        assert len(received) > 5
        assert set(received) == {STILL}

    def until_driving(self) -> None:
        """Command a speed until commands pass, for good."""
        self.wish_until(0.3, lambda: self.last == (0.3, 0.0, 0.0))

    def until_fault(self, text: str) -> None:
        """Command a speed until the gate reports a fault that contains a text."""

        def is_told() -> bool:  # there may have been no status at all yet
            return text in self.status.get("message", "") and self.status["level"] == "2"

        self.wish_until(0.3, is_told)

    def silence(self, seconds: float) -> int:
        """Return how many messages the gate publishes without a command."""
        before, end = len(self.heard), time.monotonic() + seconds
        self.peer.until(lambda: time.monotonic() > end)
        return len(self.heard) - before

    def wish_until(self, x: float, condition: Any, turn: float = 0.0) -> None:
        """Command a speed again and again until something happens."""

        def once() -> Any:
            self.wish(x, turn)
            return condition()

        self.peer.until(once)


class Stranger:
    """A node that publishes what only the safety node should; it is gone when the block ends.

    It is a participant of its own, so the middleware discovers and forgets it as a process.
    """

    def __init__(self, env: Mapping[str, str], name: str = "stranger") -> None:
        """Start the node in the domain of ``env``."""
        import rclpy
        from rclpy.context import Context
        from rclpy.node import Node
        from rclpy.qos import DurabilityPolicy, QoSProfile

        self._context = Context()
        rclpy.init(context=self._context, domain_id=int(env["ROS_DOMAIN_ID"]))
        self.node: Any = Node(
            name, context=self._context, enable_rosout=False, start_parameter_services=False
        )
        self._kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._publishers: dict[str, Any] = {}

    def __enter__(self) -> Stranger:
        """Be there."""
        return self

    def __exit__(self, *_: object) -> None:
        """Go, and say so to everybody."""
        self.node.destroy_node()
        self._context.try_shutdown()

    def stop(self, active: bool) -> Any:
        """Publish, latched, whether the stop is active; return the publisher."""
        from std_msgs.msg import Bool

        return self.state("/stop", Bool(data=active))

    def state(self, topic: str, message: Any) -> Any:
        """Publish a state, latched; return the publisher."""
        return self._say(topic, message, self._kept)

    def heartbeat(self, counter: int) -> Any:
        """Publish a heartbeat; return the publisher."""
        from std_msgs.msg import UInt64

        return self.say(f"/{SAFETY_NODE}/heartbeat", UInt64(data=counter))

    def say(self, topic: str, message: Any) -> Any:
        """Publish any message; return the publisher."""
        return self._say(topic, message, 10)

    def _say(self, topic: str, message: Any, qos: Any) -> Any:
        if topic not in self._publishers:
            self._publishers[topic] = self.node.create_publisher(type(message), topic, qos)
        self._publishers[topic].publish(message)
        return self._publishers[topic]


class Drive:
    """A robot that continuously measures its speed and receives commands to move.

    Attributes:
        speed: what it measures, and publishes.
    """

    PERIOD_S = 0.02
    MISSING_S = 0.6
    """Longer than the rules let the speed be missing, in s."""

    def __init__(self, peer: Peer) -> None:
        """Start to publish; safety node and gate may come later."""
        from geometry_msgs.msg import Twist
        from rclpy.clock import Clock
        from rclpy.clock_type import ClockType
        from std_msgs.msg import Float64

        self.peer = peer
        self.speed = 0.05
        self._lived = self._held_up = 0.0
        self._heard: list[tuple[float, bool]] = []
        self._float = Float64
        self._wish = peer.node.create_publisher(Twist, "/cmd_vel_nav", 10)
        self._measured = peer.node.create_publisher(Float64, "/speed", 10)
        self._message = Twist()
        self._message.linear.x = 0.3
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        peer.node.create_timer(self.PERIOD_S, self._live, clock=steady)
        # Deep enough to lose none of them should this process itself be kept waiting, as shared
        # memory can keep all who write into it when a reader is stopped.
        peer.node.create_subscription(Twist, "/cmd_vel", self._take, 1000)

    def _live(self) -> None:
        now = time.monotonic()
        self._held_up = max(self._held_up, now - self._lived - self.PERIOD_S)
        self._lived = now
        self.measure(self.speed)
        self._wish.publish(self._message)

    def _take(self, message: Any, info: dict[str, int]) -> None:
        self._heard.append((info["source_timestamp"] / 1e9, message.linear.x != 0.0))

    def measure(self, speed: float) -> None:
        """Measure a speed from now on."""
        self.speed = speed
        self._measured.publish(self._float(data=speed))

    def until_moving(self) -> None:
        """Wait until commands pass."""
        self._heard.clear()
        self.peer.until(lambda: self._heard and self._heard[-1][1])

    def until_watched(self) -> None:
        """Wait until it has moved for longer than its speed may be missing: so that is heard."""
        self._heard.clear()

        def moved() -> float:
            if not self._heard:
                return 0.0
            still = [sent for sent, moves in self._heard if not moves]
            return self._heard[-1][0] - max([self._heard[0][0], *still])

        self.peer.until(lambda: moved() > self.MISSING_S)

    def until_zero(self, happens: Callable[[], Any]) -> float:
        """Let something happen, and return after how many seconds the gate commanded zero.

        By how much this process itself was late meanwhile, at the worst, does not count. After it
        only zeros follow, for at least a quarter of a second.
        """
        happened = time.time()
        self._lived, self._held_up = time.monotonic(), 0.0
        happens()

        def zeros() -> list[float]:
            return [sent for sent, moves in self._heard if sent > happened and not moves]

        first: float = self.peer.until(zeros)[0]
        held_up = self._held_up
        self.peer.until(lambda: time.time() > first + 0.25)
        assert not any(moves for sent, moves in self._heard if sent > first)
        return max(first - happened - held_up, 0.0)
