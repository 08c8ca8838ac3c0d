"""The robot of the fault tests in virtual time: its generated nodes in Python, and all around them.

What must be true of time is asked here, of exact times; :mod:`tests.support.faults` has the same
robot as processes on the real middleware.
"""

from __future__ import annotations

import contextlib
import importlib
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

import pytest

from deros.generators.runtime.interface import PYTHON_RUNTIME
from tests.support.faults import GATE, NODE, PACKAGE, VIOLATION, WHEELS_GATE
from tests.support.played import TOPICS, button, command, imu, scan, speed
from tests.support.sensor import message_type
from tests.support.virtual_graph import SECOND, Graph, MatchedHandler, VirtualNode

CLASSES = {NODE: "FaultySafetyNode", GATE: "CmdVelGate", WHEELS_GATE: "WheelsGate"}
"""The classes of the nodes, by their names, which are also those of their modules."""

HEARTBEAT = f"/{NODE}/heartbeat"


def load(folder: Path) -> dict[str, Callable[..., VirtualNode]]:
    """Import the generated nodes of a package on a virtual graph; return their classes by name.

    The runtime is in the folder beside it.
    """
    for is_virtual in (False, True):  # the first time so that rclpy itself is loaded as it is
        ours = (PACKAGE, PYTHON_RUNTIME)
        for name in [each for each in sys.modules if each.split(".")[0] in ours]:
            del sys.modules[name]
        with pytest.MonkeyPatch.context() as patch:
            patch.syspath_prepend(str(folder))
            patch.syspath_prepend(str(folder.with_name(PYTHON_RUNTIME)))
            if is_virtual:
                patch.setattr("rclpy.node.Node", VirtualNode)
                patch.setattr("rclpy.event_handler.EventHandler", MatchedHandler)
                _use_virtual_time(importlib.import_module(f"{PYTHON_RUNTIME}.one_shot_timer"))
            modules = {name: importlib.import_module(f"{PACKAGE}.{name}") for name in CLASSES}
            importlib.import_module(f"{PACKAGE}.interference")  # which an action imports later
    return {name: getattr(modules[name], CLASSES[name]) for name in CLASSES}


def _use_virtual_time(module: ModuleType) -> None:
    """Give the nodes the clock of their graph, before other modules take the function."""
    runtime: Any = module

    def steady_clock(node: VirtualNode) -> Any:
        return runtime.NodeClock(node, node.graph.clock, node.graph.clock.read)

    runtime.steady_clock = steady_clock


class Seen(NamedTuple):
    """A message and the steady time at which it was published, in ns."""

    value: Any
    at: int


class Sensors(VirtualNode):
    """A node that publishes what the test plays."""

    def __init__(self, name: str, graph: Graph, topics: Mapping[str, str]) -> None:
        """Open a publisher for each topic."""
        super().__init__(name, graph=graph)
        self._ends = {
            topic: self.create_publisher(message_type(kind), topic, 10)
            for topic, kind in topics.items()
        }
        self._playing: dict[str, Any] = {}
        self.last: dict[str, int] = {}
        """When each topic was last published on, in ns of the steady clock."""

    def send(self, topic: str, *messages: Any) -> None:
        """Publish messages now."""
        for message in messages:
            self._ends[topic].publish(message)
            self.last[topic] = self.graph.now

    def play(self, topic: str, *messages: Any, rate: float = 50.0) -> None:
        """Publish the messages in turn, from now on."""
        self.quiet(topic)
        count = 0

        def publish() -> None:
            nonlocal count
            self.send(topic, messages[count % len(messages)])
            count += 1

        publish()
        self._playing[topic] = self.create_timer(1 / rate, publish)

    def quiet(self, topic: str) -> None:
        """Publish nothing on a topic any more."""
        if topic in self._playing:
            self.timers.remove(self._playing.pop(topic))

    def drive(self) -> None:
        """Play a robot that keeps to its rules, and an operator who undoes what was before."""
        played: Mapping[str, tuple[float, list[Any]]] = {
            "/speed": (50.0, [speed(0.3)]),
            "/imu": (50.0, [imu()]),
            "/button": (10.0, [button(True), button(False)]),
            "/cmd_vel_nav": (20.0, [command()]),
            "/scan": (10.0, [scan(5.0)]),
        }
        for topic in [each for each in played if each in self._ends]:
            rate, messages = played[topic]
            self.play(topic, *messages, rate=rate)


class VirtualRobot:
    """The robot, seen from its motors.

    Attributes:
        graph: all nodes.
        folder: for locks and latches.
        states: what the topic of each action has carried.
        beats: the heartbeats.
        commands: the speeds that have reached the drive.
        wheels: the speeds that have reached the wheels, past the gate that waits.
        statuses: the last status of each node, and of each of its actions and rules.
        events: the values of all events, and their messages.
    """

    def __init__(self, classes: Mapping[str, Callable[..., VirtualNode]], folder: Path) -> None:
        """Listen; no node runs yet. The state file will be in the folder."""
        from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
        from geometry_msgs.msg import Twist
        from rclpy.qos import DurabilityPolicy, QoSProfile
        from std_msgs.msg import Bool, UInt64

        self.graph = Graph()
        self._classes = classes
        self.folder = folder
        self._sensors = 0
        self.states: dict[str, list[Seen]] = {"/stop": [], "/halt": [], "/slow": []}
        self.beats: list[Seen] = []
        self.commands: list[Seen] = []
        self.wheels: list[Seen] = []
        self.statuses: dict[str, Any] = {}
        self.events: list[dict[str, str]] = []
        self.peer = VirtualNode("test_peer", graph=self.graph)
        latched = QoSProfile(depth=1000, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        volatile = QoSProfile(depth=1000)
        for topic, seen in self.states.items():
            self._listen(Bool, topic, seen, latched)
        self._listen(UInt64, HEARTBEAT, self.beats, volatile)
        self._listen(Twist, "/cmd_vel", self.commands, volatile)
        self._listen(Twist, "/wheels", self.wheels, volatile)
        self.peer.create_subscription(DiagnosticArray, "/diagnostics", self._take_status, volatile)
        self.peer.create_subscription(
            DiagnosticStatus, f"/{NODE}/events", self._take_event, latched
        )

    def _listen(self, kind: Any, topic: str, seen: list[Seen], qos: Any) -> None:
        from rclpy.serialization import deserialize_message

        def take(data: bytes) -> None:
            with contextlib.suppress(Exception):  # of data that no reader can decode
                msg = deserialize_message(data, kind)
                value = msg.data if hasattr(msg, "data") else msg.linear.x
                seen.append(Seen(value, self.graph.now))

        self.peer.create_subscription(kind, topic, take, qos, raw=True)

    def _take_status(self, msg: Any) -> None:
        for status in msg.status:
            self.statuses[status.name.removeprefix("/")] = status

    def _take_event(self, msg: Any) -> None:
        self.events.append({"message": msg.message, **{v.key: v.value for v in msg.values}})

    # The nodes

    def start(self, name: str = NODE, **parameters: Any) -> VirtualNode:
        """Start a generated node."""
        if name == NODE:
            parameters = {"state_file": str(self.folder / "state"), **parameters}
        return self._classes[name](graph=self.graph, parameters=parameters)

    def sensors(self, topics: Mapping[str, str] = TOPICS) -> Sensors:
        """Start a node that plays sensors."""
        self._sensors += 1
        return Sensors(f"sensors_{self._sensors}", self.graph, topics)

    def kill(self, node: Any, lease: float = 1.0) -> None:
        """End a generated node as a crash would; its lock is free, its latches are stored."""
        getattr(node, "_core", node)._lock.close()
        node.kill(lease)

    # What the test may ask

    @property
    def now(self) -> int:
        """Return the steady time, in ns."""
        return self.graph.now

    def run(self, seconds: float) -> None:
        """Let time pass."""
        self.graph.run(seconds)

    def until(self, condition: Callable[[], object], seconds: float = 60.0) -> None:
        """Let time pass until something is true; it is an error if it is not in time."""
        self.graph.until(condition, seconds)

    def is_active(self, topic: str) -> bool:
        """Return whether the action of a topic is active."""
        return bool(self.states[topic] and self.states[topic][-1].value)

    def until_active(self, topic: str) -> int:
        """Return at what time, from now on, the action of a topic becomes active."""
        assert not self.is_active(topic)
        self.until(lambda: self.is_active(topic))
        return self.states[topic][-1].at

    def until_free(self) -> None:
        """Wait until no action is active: the inputs are received, the halt has been undone."""
        self.until(lambda: not self.is_active("/halt") and not self.is_active("/stop"))

    def reset(self, node: str = NODE) -> tuple[bool, str]:
        """Call the reset service of a node; return whether it was done, and what it answers."""
        from std_srvs.srv import Trigger

        response = self.graph.call(f"/{node}/reset", Trigger.Request())
        self.run(0.0)  # until all have received what it changes
        return response.success, response.message

    def waiting(self, gate: str = WHEELS_GATE) -> str:
        """Return what a gate reports."""
        return str(self.statuses[gate].message) if gate in self.statuses else ""

    def told(self, of: str, value: str, node: str = NODE) -> str:
        """Return a value in the last status of an action or a rule of a node."""
        status = self.statuses[f"{node}: {of}"]
        return next(str(each.value) for each in status.values if each.key == value)

    def assert_protects(self) -> None:
        """Assert that a violation still stops the robot, at the same instant."""
        prober = self.sensors({"/speed": TOPICS["/speed"]})
        self.run(0.1)
        assert not self.is_active("/stop")
        prober.send("/speed", speed(VIOLATION))
        assert self.until_active("/stop") == prober.last["/speed"]


def ns(seconds: float) -> int:
    """Return a duration in nanoseconds."""
    return round(seconds * SECOND)
