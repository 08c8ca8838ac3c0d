"""The robot under test, the proxy, and everything that can be broken."""

from __future__ import annotations

import contextlib
import shutil
import subprocess
import threading
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tests.support.chaos.links import (
    BY_NAME,
    CONTROLLER_OK,
    DOMAINS,
    GATE,
    HEARTBEAT,
    JOYSTICK,
    LET_THROUGH,
    LOW_SPEED,
    MOTOR_STOP,
    PLANT,
    SAFETY,
    STOP,
    message_type,
)
from tests.support.chaos.proxy import Proxy
from tests.support.chaos.record import Record
from tests.support.chaos.referee import Referee
from tests.support.chaos.robot import PARTS, Part
from tests.support.cpp import python_overlay
from tests.support.preload import Disk, WallClock
from tests.support.ros import environment, own_domain

OUTPUTS = {
    "safety": (HEARTBEAT, STOP, LOW_SPEED, MOTOR_STOP, CONTROLLER_OK),
    "gate": (LET_THROUGH,),
}
"""What each restarted node publishes through the proxy."""


class NotReadyError(Exception):
    """The robot could not be brought to drive: the round shows nothing."""


@dataclass
class Bench:
    """The robot, the proxy, and everything that can be broken."""

    folder: Path
    domains: dict[str, int]
    record: Record
    proxy: Proxy
    parts: dict[str, Part]
    clocks: Mapping[str, WallClock]
    disk: Disk
    referee: type[Referee] = Referee
    intruders: list[subprocess.Popen[str]] = field(default_factory=list)
    _steering: threading.Event | None = None
    _levers: dict[str, Any] = field(default_factory=dict)
    _resets: dict[str, Any] = field(default_factory=dict)

    def process_of(self, node: str) -> int:
        """Return the process of a node, once it runs."""
        part = self.parts[node if node in (SAFETY, GATE) else PLANT]
        return part.process_of(node)

    # The levers of the world ----------------------------------------------------------------

    def pull(self, topic: str, kind: str, value: Any) -> None:
        """Say something to the world, once and for all who come later."""
        from rclpy.qos import DurabilityPolicy, QoSProfile

        if topic not in self._levers:
            latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
            node = self.proxy.nodes[PLANT]
            self._levers[topic] = node.create_publisher(message_type(kind), topic, latched)
        message = message_type(kind)()
        if kind == "geometry_msgs/Vector3":
            message.x = value
        else:
            message.data = value
        self._levers[topic].publish(message)

    def steer(self, speed: float | None) -> None:
        """Let the joystick command a speed twenty times a second, or be silent."""
        if self._steering is not None:
            self._steering.set()
            self._steering = None
        if speed is not None:
            self._steering = threading.Event()
            arguments = speed, self._steering
            threading.Thread(target=self._steer, args=arguments, daemon=True).start()

    def _steer(self, speed: float, is_over: threading.Event) -> None:
        message = JOYSTICK.message_type()()
        message.linear.x = speed
        node = self.proxy.nodes[PLANT]
        publisher = node.create_publisher(JOYSTICK.message_type(), JOYSTICK.name, 10)
        while not is_over.wait(0.05):
            publisher.publish(message)
        node.destroy_publisher(publisher)

    def reset(self, domain: str = SAFETY, limit: float = 5.0) -> bool:
        """Call the reset service of the safety node, or the gate; return whether it was granted."""
        from std_srvs.srv import Trigger

        if domain not in self._resets:
            node = self.proxy.nodes[domain]
            self._resets[domain] = node.create_client(Trigger, f"/{PARTS[domain][0]}/reset")
        if not self._resets[domain].service_is_ready():
            return False
        answered = threading.Event()
        future = self._resets[domain].call_async(Trigger.Request())
        future.add_done_callback(lambda _: answered.set())
        return answered.wait(limit) and bool(future.result().success)

    def value(self, place: Any, domain: str, topic: str) -> Any:
        """Return the last number of a topic at a place, ``None`` before the first."""
        from rclpy.serialization import deserialize_message

        message = self.record.latest(place, domain, topic)
        if message is None:
            return None
        return deserialize_message(message.data, BY_NAME[topic].message_type()).data

    def until(self, what: str, condition: Callable[[], Any], limit: float = 20.0) -> None:
        """Wait until something is so.

        Raises:
            NotReadyError: if it is not in time.
        """
        if not self.record.until(condition, limit):
            raise NotReadyError(f"waited {limit:g} s for {what}")

    def fresh(self, place: Any, domain: str, topic: str, since: float) -> bool:
        """Return whether a topic was heard after a time."""
        message = self.record.latest(place, domain, topic)
        return message is not None and message.time > since


@dataclass(frozen=True)
class Software:
    """What runs.

    Attributes:
        system: the system's model.
        packages: the folder with the packages in Python.
        installed: where the safety node and the gate are if they are those in C++.
        referee: who judges its rounds.
    """

    system: Path
    packages: Path
    installed: Path | None = None
    referee: type[Referee] = Referee

    @property
    def places(self) -> tuple[Path, ...]:
        """The folders with packages."""
        return (self.packages,) if self.installed is None else (self.installed, self.packages)

    def environment(self, part: str, domain: int) -> dict[str, str]:
        """Return the environment of the nodes of a part, which are in Python in the plant."""
        env = environment(domain)
        if self.installed is None or part == PLANT:
            return env
        return python_overlay(self.installed, env)


@contextlib.contextmanager
def running(robot: Software, folder: Path, seed: int) -> Iterator[Bench]:
    """Run the robot, with everything that it takes to break it."""
    with contextlib.ExitStack() as stack:
        domains = {name: stack.enter_context(own_domain()) for name in DOMAINS}
        folder.mkdir(parents=True, exist_ok=True)
        home = folder / "ros_home"
        shutil.rmtree(home, ignore_errors=True)
        home.mkdir()
        record = Record()
        stack.callback(record.close)
        proxy = Proxy(domains, record, seed)
        stack.callback(proxy.close)
        disk = Disk(home, folder)
        clocks: dict[str, WallClock] = {}
        parts: dict[str, Part] = {}
        for name in DOMAINS:
            env = robot.environment(name, domains[name]) | {"ROS_HOME": str(home)}
            if name != PLANT:
                (folder / name).mkdir(exist_ok=True)
                clocks[name] = WallClock(folder / name)
                preload = f"{disk.env['LD_PRELOAD']}:{clocks[name].env['LD_PRELOAD']}"
                env |= {**disk.env, **clocks[name].env, "LD_PRELOAD": preload}
            parts[name] = Part(
                name,
                robot.system,
                robot.places,
                env,
                folder / f"{name}.log",
                lambda node: proxy.revive(OUTPUTS.get(node, ())),
                lambda node: proxy.silence(OUTPUTS.get(node, ())),
            )
            stack.callback(parts[name].close)
        yield Bench(folder, domains, record, proxy, parts, clocks, disk, robot.referee)
