"""Several generated C++ packages in one process: each behaves as it does alone."""

from __future__ import annotations

import signal
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from deros.generators.api.protocol import Context
from deros.generators.node.cpp.generate import generate as node_package
from deros.generators.output.writer import write
from deros.generators.runtime.interface import with_runtime
from deros.generators.safety_package.cpp.generate import generate as safety_package
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.node import NodeType
from deros.models.rules import Rules
from tests.support.containers import Container, LoadError, running_container
from tests.support.cpp import colcon_build, overlay
from tests.support.fill_in import fill_in, insert
from tests.support.needs import needs
from tests.support.ros import LIMIT, Peer

pytestmark = [pytest.mark.ros, needs("rclcpp"), needs("ros2")]

MODELS = Path(__file__).resolve().parent / "models"
PARTS = ("base", "arm")

MEASURE = """
  for (int i = 0; i < 50; ++i) {  // more than wait anywhere
    publish_speed(std_msgs::msg::Float64());
  }
  publish_speed(msg);
"""
TICK = """
  publish_clock(msg);
"""
LINGER = """
  ~Sensor() override
  {
    // Others do their chores ten times a second: so each of them finds the middleware shut down.
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
  }
"""
HONK = """
#include <stdexcept>

#include "base_safety_cpp/base_safety_node_actions.hpp"

void base_safety_cpp::BaseSafetyNodeActions::honk(std::int64_t)
{
  throw std::runtime_error("no horn");
}
"""


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return an install folder with the packages of two files of rules, and of a sensor.

    The rules share names of files, entities and behaviours. The sensor takes time to end, during
    which others find the middleware shut down.
    """
    source = tmp_path_factory.mktemp("workspace")
    for part in PARTS:
        context = Context(InterfaceStore(), Repository())
        rules = context.repository.load(MODELS / part / "robot.deros").model
        assert isinstance(rules, Rules)
        options = {"package": f"{part}_safety", "node": f"{part}_safety_node"}
        write(with_runtime(safety_package(rules, context, options)), source)
    actions = "base_safety_cpp/{}base_safety_node_actions"
    header = source / f"{actions.format('include/base_safety_cpp/')}.hpp"
    insert(header, "};", "  void honk(std::int64_t times) override;\n")
    (source / f"{actions.format('src/')}.cpp").write_text(HONK)

    context = Context(InterfaceStore(), Repository())
    sensor = context.repository.load(MODELS / "sensor.rnd").model
    assert isinstance(sensor, NodeType)
    write(node_package(sensor, context, {}), source)
    header = source / "measuring/include/measuring/sensor.hpp"
    insert(header, '#include "measuring', "#include <chrono>\n#include <thread>\n\n")
    insert(header, "\nprotected:", LINGER)
    fill_in(source / "measuring/src/sensor.cpp", "on_measured", MEASURE)
    fill_in(source / "measuring/src/sensor.cpp", "on_ticked", TICK)
    return colcon_build(source)


class Part:
    """A part of the robot: the test's end of its safety node and its gate.

    Attributes:
        name: name of the part.
        stops: all received states of its stop.
        beats: all heartbeats.
        events: all events.
        commands: forward speeds published by its gate.
    """

    def __init__(self, peer: Peer, name: str) -> None:
        """Subscribe; the nodes may start later."""
        from diagnostic_msgs.msg import DiagnosticStatus
        from geometry_msgs.msg import Twist
        from rclpy.qos import DurabilityPolicy, QoSProfile
        from std_msgs.msg import Bool, UInt64

        self.name = name
        self.stops: list[bool] = []
        self.beats: list[int] = []
        self.events: list[dict[str, str]] = []
        self.commands: list[float] = []
        self._peer, self._twist = peer, Twist
        node, own = peer.node, f"/{name}_safety_node"
        kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        history = QoSProfile(depth=1000, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        node.create_subscription(Bool, f"/{name}/stop", lambda m: self.stops.append(m.data), kept)
        node.create_subscription(
            UInt64, f"{own}/heartbeat", lambda m: self.beats.append(m.data), 10
        )
        node.create_subscription(DiagnosticStatus, f"{own}/events", self._take_event, history)
        node.create_subscription(
            Twist, f"/{name}/command", lambda m: self.commands.append(m.linear.x), 10
        )
        self._wish = node.create_publisher(Twist, f"/{name}/wish", 10)

    def _take_event(self, message: Any) -> None:
        self.events.append({value.key: value.value for value in message.values})

    def load_node(self, container: Container, *options: str) -> str:
        """Load the safety node, and return its number."""
        name = self.name
        plugin = f"{name}_safety_cpp::{name.capitalize()}SafetyNode"
        return container.load(f"{name}_safety_cpp", plugin, *options)

    def load_gate(self, container: Container, *options: str) -> str:
        """Load the gate, and return its number."""
        name = self.name
        plugin = f"{name}_safety_cpp::{name.capitalize()}CommandGate"
        return container.load(f"{name}_safety_cpp", plugin, *options)

    @property
    def is_stopped(self) -> bool:
        """Return whether its stop is active according to the last message."""
        return self.stops[-1:] == [True]

    def actions(self) -> set[str]:
        """Return the triggered actions."""
        return {event["action"] for event in self.events if event["kind"] == "trigger"}

    def forget(self) -> None:
        """Clear the recorded messages."""
        for heard in (self.stops, self.beats, self.events, self.commands):
            heard.clear()

    def await_beats(self) -> None:
        """Wait until its safety node has evaluated its rules once more."""
        count = len(self.beats)
        self._peer.until(lambda: len(self.beats) >= count + 2)

    def wish(self, speed: float) -> None:
        """Command a speed."""
        message = self._twist()
        message.linear.x = speed
        self._wish.publish(message)

    def wish_until(self, speed: float, passed: float) -> None:
        """Command a speed repeatedly, until the given one is published."""

        def once() -> bool:
            self.wish(speed)
            return self.commands[-1:] == [passed]

        self._peer.until(once)

    def reset(self) -> Any:
        """Call the reset service of its safety node."""
        from std_srvs.srv import Trigger

        client = self._peer.node.create_client(Trigger, f"/{self.name}_safety_node/reset")
        return self._peer.call(client, Trigger.Request())


class Robot:
    """Both parts, and the measured values."""

    def __init__(self, peer: Peer) -> None:
        """Open the topics; the nodes may start later."""
        from std_msgs.msg import Float64

        self.peer = peer
        self.base, self.arm = (Part(peer, name) for name in PARTS)
        self._float = Float64
        self._publishers: dict[str, Any] = {}

    def publish_until(self, topic: str, value: float, condition: Callable[[], Any]) -> None:
        """Publish a number repeatedly until a condition holds."""
        if topic not in self._publishers:
            self._publishers[topic] = self.peer.node.create_publisher(self._float, topic, 10)

        def once() -> Any:
            self._publishers[topic].publish(self._float(data=value))
            return condition()

        self.peer.until(once)

    def end(self, container: Container) -> str:
        """End the container by SIGINT while commands keep arriving; return its output."""
        container.process.send_signal(signal.SIGINT)

        def wished() -> bool:
            for part in (self.base, self.arm):
                part.wish(0.5)
            return container.process.poll() is not None

        self.peer.until(wished)
        output, _ = container.process.communicate(timeout=LIMIT)
        assert container.process.returncode == 0, output
        return output


@pytest.fixture
def two_parts(ros_peer: Peer) -> Robot:
    """Return the test's end of all topics."""
    return Robot(ros_peer)


@pytest.fixture
def env(installed: Path, ros_env: dict[str, str]) -> dict[str, str]:
    """Return the environment in which the components are found."""
    return overlay(installed, ros_env)


def latched(env: dict[str, str], part: Part) -> bool:
    """Return whether the file of a part's safety node has the stop as active."""
    name = f"{part.name}_safety_node.{env['ROS_DOMAIN_ID']}.latches"
    return "stop" in (Path(env["ROS_HOME"]) / "deros" / name).read_text().splitlines()


# Two packages -------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["component_container", "component_container_isolated"])
def test_each_package_monitors_its_own_rules(
    kind: str, env: dict[str, str], two_parts: Robot
) -> None:
    """Actions, heartbeats, latches and resets are separate, and each gate obeys its own node."""
    base, arm = two_parts.base, two_parts.arm
    with running_container(env, two_parts.peer, kind) as container:
        for part in (base, arm):
            part.load_node(container)
            part.load_gate(container)
        for part in (base, arm):
            part.wish_until(0.7, passed=0.7)

        # Both receive the speed, and each acts according to its rules.
        two_parts.publish_until("/speed", 1.0, lambda: base.actions() and arm.actions())
        assert (base.actions(), arm.actions()) == ({"stop"}, {"slow"})
        base.wish_until(0.7, passed=0.0)
        arm.wish_until(0.7, passed=0.1)
        assert base.is_stopped
        assert not arm.is_stopped
        assert (latched(env, base), latched(env, arm)) == (True, False)

        # Only one receives the load; the reset is for one of them, too.
        two_parts.publish_until("/load", 11.0, lambda: "stop" in arm.actions())
        arm.wish_until(0.7, passed=0.0)
        assert arm.is_stopped
        two_parts.publish_until(
            "/speed", 0.0, lambda: any(e["kind"] == "reset" for e in arm.events)
        )
        assert base.reset().message == "stop is reset"
        base.wish_until(0.6, passed=0.6)
        arm.wish_until(0.6, passed=0.0)
        assert (latched(env, base), latched(env, arm)) == (False, True)
        assert "stop stays active" in arm.reset().message
        for part in (base, arm):
            part.await_beats()
            assert part.beats == sorted(part.beats)
        assert base.actions() == {"stop"}
        output = two_parts.end(container)
        assert "FATAL" not in output, output


def test_other_package_continues_after_an_unload(env: dict[str, str], two_parts: Robot) -> None:
    """An unloaded safety node is silent; loaded again, it knows its latches."""
    base, arm = two_parts.base, two_parts.arm
    with running_container(env, two_parts.peer) as container:
        base.load_gate(container)
        number = base.load_node(container)
        arm.load_node(container)
        base.wish_until(0.7, passed=0.7)
        two_parts.publish_until("/speed", 1.0, lambda: base.actions() and arm.actions())

        with pytest.raises(LoadError, match="base_safety_node runs already in domain"):
            base.load_node(container)
        base.await_beats()

        container.unload(number)
        two_parts.peer.until(
            lambda: not two_parts.peer.node.count_publishers("/base_safety_node/heartbeat")
        )
        arm.await_beats()  # by then, messages in transit have arrived
        base.forget()
        two_parts.publish_until("/load", 11.0, lambda: arm.is_stopped)
        arm.await_beats()
        assert [base.beats, base.stops, base.events] == [[], [], []]

        base.load_node(container)
        two_parts.peer.until(lambda: base.stops)
        assert base.stops[0]
        two_parts.publish_until("/speed", 0.0, lambda: base.beats)
        assert base.reset().message == "stop is reset"
        base.wish_until(0.6, passed=0.6)
        two_parts.publish_until("/speed", 1.0, lambda: base.is_stopped)
        output = two_parts.end(container)
        assert "FATAL" not in output, output


def test_other_package_continues_after_a_failure(env: dict[str, str], two_parts: Robot) -> None:
    """User code that throws ends its own node: the gate of that one stops, the other continues."""
    base, arm = two_parts.base, two_parts.arm
    with running_container(env, two_parts.peer) as container:
        base.load_gate(container)
        for part in (base, arm):
            part.load_node(container)
        two_parts.publish_until("/speed", 0.0, lambda: base.beats and arm.beats)
        base.wish_until(0.7, passed=0.7)
        two_parts.publish_until("/speed", 60.0, lambda: "honk" in base.actions())
        base.wish_until(0.7, passed=0.0)
        two_parts.publish_until("/load", 11.0, lambda: arm.is_stopped)
        arm.await_beats()
        base.forget()
        arm.await_beats()
        assert base.beats == []
        output = two_parts.end(container)
        assert "action honk failed: no horn" in output
        assert output.count("FATAL") == 2, output  # the action, and the node


# Intra-process messages ---------------------------------------------------------------------------

SHARED = ("--extra-argument", "use_intra_process_comms:=true")


def test_intra_process_messages_are_received(env: dict[str, str], two_parts: Robot) -> None:
    """A message passed by pointer has its content, also with a subscriber outside."""
    from std_msgs.msg import Float64

    base, arm, peer = two_parts.base, two_parts.arm, two_parts.peer
    with running_container(env, peer) as container:
        container.load("measuring", "measuring::Sensor", *SHARED)  # destroyed first, too
        for part in (base, arm):
            part.load_node(container, *SHARED)
            part.load_gate(container, *SHARED)
        base.wish_until(0.7, passed=0.7)
        two_parts.publish_until("/measured", 1.0, lambda: base.is_stopped)
        base.wish_until(0.7, passed=0.0)
        peer.until(lambda: "slow" in arm.actions())
        assert "stop" not in arm.actions()

        heard: list[float] = []
        peer.node.create_subscription(Float64, "/speed", lambda m: heard.append(m.data), 100)
        two_parts.publish_until("/measured", 0.0, lambda: heard)
        assert base.reset().message == "stop is reset"
        two_parts.publish_until("/measured", 1.0, lambda: base.is_stopped)
        peer.until(lambda: 1.0 in heard)

        # Messages from outside are received as before.
        two_parts.publish_until("/load", 11.0, lambda: arm.is_stopped)
        output = two_parts.end(container)
        assert "FATAL" not in output, output


def test_simulated_time_of_the_same_process_is_used(env: dict[str, str], two_parts: Robot) -> None:
    """A clock in the container drives rules and gate, like one outside."""
    from rosgraph_msgs.msg import Clock  # type: ignore[import-untyped]

    base, peer = two_parts.base, two_parts.peer
    ticks = peer.node.create_publisher(Clock, "/ticked", 10)
    seconds = 100.0

    def ticking(condition: Callable[[], Any]) -> Callable[[], Any]:
        def once() -> Any:
            nonlocal seconds
            seconds += 0.01
            message: Any = Clock()
            message.clock.sec, message.clock.nanosec = int(seconds), int(seconds % 1 * 1e9)
            ticks.publish(message)
            return condition()

        return once

    simulated = ("--parameter", "use_sim_time:=true", *SHARED)
    with running_container(env, peer) as container:
        container.load("measuring", "measuring::Sensor", *SHARED)
        base.load_node(container, *simulated)
        base.load_gate(container, *simulated)
        peer.until(ticks.get_subscription_count)
        peer.until(ticking(lambda: base.beats))
        two_parts.publish_until("/measured", 1.0, ticking(lambda: base.is_stopped))
        base.commands.clear()
        peer.until(ticking(lambda: len(base.commands) > 10))  # zeros at the rate of simulated time
        output = two_parts.end(container)
        assert "FATAL" not in output, output
