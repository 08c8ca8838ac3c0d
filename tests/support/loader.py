"""A loader whose parts can be broken: its gates ramp, hold, send, fall silent, wait, and choose.

Its rules are those of tests/faults/models/loader. The test holds the end of the topics that drive
and fork would have, and judges them by the stamps of what reaches them.
"""

from __future__ import annotations

import contextlib
import signal
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tests.support.played import command, load
from tests.support.rig import Rig, Software
from tests.support.ros import Peer
from tests.support.victims import Sensors

TWIST = "geometry_msgs/msg/Twist"
JOYSTICK, PLANNER, FORK_WISH = {"/joy": TWIST}, {"/plan": TWIST}, {"/fork_wish": TWIST}
LOAD = {"/load": "std_msgs/msg/Float64"}

DRIVE_GATE, FORK_GATE = "drive_gate", "fork_gate"

LIGHT, LADEN, TOO_HEAVY = 10.0, 45.0, 99.0
"""Loads: one that the rules allow, one that pauses the fork, and one that stops the loader."""

LOWERING = -0.125
"""The command, in m/s, that the fork gets while it stops."""

HELD_BACK = 0.5
"""Seconds for which the horn warns before the fork moves."""


@dataclass(frozen=True)
class Sent:
    """A number that has reached its end, and when it was sent, in s since the epoch."""

    value: float
    time: float


def lift(speed: float) -> Any:
    """Return a command for the fork."""
    from geometry_msgs.msg import Twist

    message = Twist()
    message.linear.z = speed
    return message


class Loader(Rig):
    """The loader under test, seen from drive and fork.

    Attributes:
        drive: the forward speeds that have reached the drive.
        fork: the upward speeds that have reached the fork.
        states: what each action's topic has said.
        reports: the last message of each gate on /diagnostics.
        cell: plays the load, while the loader is at work.
        node: the safety node, while it is.
        gate: the gate, while it is.
    """

    safety = "loader_safety_node"
    topics = LOAD

    def __init__(
        self, software: Software, folder: Path, env: Mapping[str, str], peer: Peer
    ) -> None:
        """Listen to gates and safety node."""
        from diagnostic_msgs.msg import DiagnosticArray
        from geometry_msgs.msg import Twist
        from rclpy.qos import DurabilityPolicy, QoSProfile
        from std_msgs.msg import Bool

        super().__init__(software, folder, env, peer)
        self.drive: list[Sent] = []
        self.fork: list[Sent] = []
        self.states: dict[str, list[Sent]] = {"/stop": [], "/pause": [], "/horn": []}
        self.reports: dict[str, str] = {}

        def listen(kind: Any, topic: str, seen: list[Sent], field: str, qos: Any) -> None:
            def receive(message: Any, info: dict[str, int]) -> None:
                value = message.data if field == "data" else getattr(message.linear, field)
                seen.append(Sent(value, info["source_timestamp"] / 1e9))

            peer.node.create_subscription(kind, topic, receive, qos)

        listen(Twist, "/drive", self.drive, "x", QoSProfile(depth=100))
        listen(Twist, "/fork", self.fork, "z", QoSProfile(depth=100))
        kept = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        for topic, seen in self.states.items():
            listen(Bool, topic, seen, "data", kept)

        def diagnosed(message: Any) -> None:
            for status in message.status:
                self.reports[status.name.lstrip("/")] = status.message

        peer.node.create_subscription(DiagnosticArray, "/diagnostics", diagnosed, 100)

    # Processes

    @contextlib.contextmanager
    def at_work(self, gate: str, **env: str) -> Iterator[None]:
        """Run load cell, safety node and one gate; those that still run then end well.

        Args:
            gate: the gate.
            env: what is to be added to the environment of the safety node.
        """
        try:
            with self.sensors() as self.cell:
                self.weigh(LIGHT)
                self.node, self.gate = self.start(**env), self.start(gate)
                self.cell.match("/load")
                self.until(lambda: self.is_off("/stop"))
                yield
                for process in (self.gate, self.node):
                    if process.popen.poll() != -signal.SIGKILL:
                        process.end()
        finally:
            self.clear()

    def restart(self) -> None:
        """Start the safety node again, once it has been killed."""
        self.node = self._start(self.node.command, self.node.env, self.node.name)

    def restart_gate(self) -> None:
        """Start the gate again, once it has been killed."""
        self.gate = self._start(self.gate.command, self.gate.env, self.gate.name)

    def weigh(self, weight: float) -> None:
        """Let the cell measure a load from now on."""
        self.cell.play("/load", load(weight), rate=20.0)

    # What the test may ask

    def is_off(self, topic: str) -> bool:
        """Return whether the safety node has said last that an action is not active."""
        seen = self.states[topic]
        return bool(seen) and not seen[-1].value

    def until_zero_passes(self, commander: Sensors, topic: str) -> None:
        """Command zero, for drive or fork, until it passes; so one may begin."""
        commander.play(topic, command(0.0), rate=20.0)
        passes = "commands pass" if topic == "/fork_wish" else f"commands of {topic} pass"
        self.until(lambda: passes in self.reports.values())

    def until_driving(self, speed: float) -> None:
        """Wait until the drive gets this speed, steadily."""
        self.until(lambda: [each.value for each in self.drive[-5:]] == [speed] * 5)

    def until_lifting(self, speed: float) -> None:
        """Wait until the fork gets this speed, steadily."""
        self.until(lambda: [each.value for each in self.fork[-5:]] == [speed] * 5)
