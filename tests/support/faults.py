"""A small robot whose parts can be broken: processes to kill, to freeze and to feed.

Its rules are those of tests/faults/models. The test holds the end of the topics that the robot's
motors would have, and sees there whether it is stopped.
"""

from __future__ import annotations

import contextlib
import re
import shutil
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tests.support.played import COMMAND, SENSES, TOPICS, speed
from tests.support.rig import PROMPT as PROMPT
from tests.support.rig import CppNodes, PythonNodes, Rig
from tests.support.ros import LIMIT, Peer
from tests.support.victims import Process, Sensors

NODE = "faulty_safety_node"
PACKAGE = "faulty_safety"
GATE = "cmd_vel_gate"
WHEELS_GATE = "wheels_gate"
"""The gate that lets nothing move again by itself."""

VIOLATION = 9.0
"""The speed, in m/s, by which a test's end sees whether the robot is still protected."""

RUNAWAY = 60.0
"""The speed, in m/s, at which the action ``interfere`` is called, and after it the stop."""

_INTERFERE = re.compile(r'    def interfere\(self\).*?"""\n.*?"""\n', re.DOTALL)


class PythonRobot(PythonNodes):
    """The generated nodes in Python; ``interfere`` does what a test puts into a file.

    Attributes:
        sees_what_it_cannot_read: whether the safety node is handed messages that are none.
        beams: how many the longest scan may have that it judges.
    """

    sees_what_it_cannot_read = True
    beams = 2_500_000

    def __init__(self, rules: Path, folder: Path) -> None:
        """Generate the package of ``rules`` into a folder."""
        super().__init__(rules, folder)
        shutil.copy(rules.with_name("interference.py"), self.actions.parent)
        end = "        interference.interfere(self.node)\n"
        call = f"        from {PACKAGE} import interference\n\n{end}"
        text = self.actions.read_text(encoding="utf-8")
        filled, count = _INTERFERE.subn(lambda found: found[0] + call, text)
        assert count == 1
        self.actions.write_text(filled, encoding="utf-8")


class CppRobot(CppNodes):
    """The generated nodes in C++, built; the same action is filled in.

    The middleware drops messages that are none of the type, and the monitor in C takes an array
    that is longer than it may be for one that holds a NaN.
    """

    sees_what_it_cannot_read = False
    beams = 1_048_576

    def _fill_in(self, rules: Path, header: Path) -> None:
        shutil.copy(rules.with_name("interference.hpp"), header.parent)
        text = header.read_text(encoding="utf-8")
        filled = text.replace(
            "void interfere() override {}", "void interfere() override {interfere_with(node());}"
        ).replace("\nnamespace", f'#include "{PACKAGE}_cpp/interference.hpp"\n\nnamespace', 1)
        assert filled != text
        header.write_text(filled, encoding="utf-8")


Software = PythonRobot | CppRobot


@dataclass(frozen=True)
class Heard:
    """A message with the moments at which it was sent and received, in s since the epoch."""

    value: float
    sent: float
    received: float


def _since(moment: float, messages: Sequence[Heard]) -> int:
    """Return how many of the messages were received after a moment."""
    return sum(each.received > moment for each in messages)


class Robot(Rig):
    """The robot under test, seen from its motors.

    Attributes:
        states: what each action's topic has said.
        beats: the heartbeats.
        faults: what the safety node's diagnostics say is wrong, by what it is about.
        fault_events: what its events have said of that.
        events: the values of all its events, and their messages.
        commands: the speeds that have reached the drive.
        wheels: the speeds that have reached the wheels, past the gate that waits.
        waiting: what that gate says that it holds commands back for.
    """

    software: Software
    safety = NODE
    topics = TOPICS

    def __init__(
        self, software: Software, folder: Path, env: Mapping[str, str], peer: Peer
    ) -> None:
        """Listen to what the safety node publishes."""
        from geometry_msgs.msg import Twist
        from std_msgs.msg import Bool, Float64, UInt64
        from std_srvs.srv import Trigger

        super().__init__(software, folder, env, peer)
        self.env["INTERFERENCE"] = str(folder / "interference")
        self.states: dict[str, list[Heard]] = {"/stop": [], "/halt": [], "/slow": []}
        self.beats: list[Heard] = []
        self.faults: dict[str, str] = {}
        self.fault_events: dict[str, list[str]] = {}
        self.events: list[dict[str, str]] = []
        self.commands: list[Heard] = []
        self.wheels: list[Heard] = []
        self.waiting = ""
        self._speeds: list[Heard] = []
        self._prober: Sensors | None = None
        self._node: Process | None = None
        self._resets = {
            node: peer.node.create_client(Trigger, f"/{node}/reset") for node in (NODE, WHEELS_GATE)
        }
        for topic, seen in self.states.items():
            self._listen(Bool, topic, seen, kept=True)
        self._listen(UInt64, f"/{NODE}/heartbeat", self.beats)
        self._listen_to_reports()
        self._listen(Float64, "/speed", self._speeds)
        self._listen(Twist, "/cmd_vel", self.commands)
        self._listen(Twist, "/wheels", self.wheels)

    def _listen(self, message: Any, topic: str, seen: list[Heard], kept: bool = False) -> None:
        from rclpy.qos import DurabilityPolicy, QoSProfile

        def receive(msg: Any, info: dict[str, int]) -> None:
            value = msg.data if hasattr(msg, "data") else msg.linear.x
            sent, received = info["source_timestamp"] / 1e9, info["received_timestamp"] / 1e9
            seen.append(Heard(value, sent, received))

        durability = DurabilityPolicy.TRANSIENT_LOCAL if kept else DurabilityPolicy.VOLATILE
        profile = QoSProfile(depth=100, durability=durability)
        self.peer.node.create_subscription(message, topic, receive, profile)

    def _listen_to_reports(self) -> None:
        from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

        def diagnosed(msg: DiagnosticArray) -> None:
            for status in msg.status:
                if status.name == f"/{NODE}":
                    values = {pair.key: pair.value for pair in status.values}
                    self.faults = {k: v for k, v in values.items() if k != "state"}
                    assert (status.level == DiagnosticStatus.ERROR) == bool(self.faults)
                elif status.name == f"/{WHEELS_GATE}":
                    self.waiting = status.message

        def happened(msg: DiagnosticStatus) -> None:
            values = {pair.key: pair.value for pair in msg.values}
            self.events.append({**values, "message": msg.message})
            if values["kind"] == "fault":
                self.fault_events.setdefault(values["subject"], []).append(msg.message)

        self.peer.node.create_subscription(DiagnosticArray, "/diagnostics", diagnosed, 100)
        self.peer.node.create_subscription(DiagnosticStatus, f"/{NODE}/events", happened, 100)

    def event(self, kind: str, action: str) -> dict[str, str]:
        """Wait for an event of an action, and return its values."""
        found = self.until(
            lambda: [e for e in self.events if (e["kind"], e.get("action")) == (kind, action)]
        )
        return dict(found[-1])

    # What the test may ask

    def is_active(self, topic: str) -> bool:
        """Return whether the action of a topic is active, as far as the robot knows."""
        seen = self.states[topic]
        return bool(seen and seen[-1].value)

    def until_stopped(self, topic: str = "/stop", limit: float = LIMIT) -> None:
        """Wait until an action is active."""
        self.until(lambda: self.is_active(topic), limit)

    def until_free(self) -> None:
        """Wait until the sensors are heard, and the operator has undone the halt without them."""
        self.until(lambda: not self.is_active("/halt"))

    def until_alive(self) -> None:
        """Wait until the safety node says anew that it lives, and what is active."""
        now = time.time()
        self.until(lambda: _since(now, self.beats) >= 2)
        self.until(lambda: all(_since(now, seen) for seen in self.states.values()))

    def until_beats(self, count: int = 10) -> None:
        """Wait for so many heartbeats from now on, ten a second; see that they came in time.

        When each was received counts, not when this process, which may be starved, looks at it.
        """
        now, held_up = time.time(), self.held_up()
        self.until(lambda: _since(now, self.beats) >= count)
        passed = [each.received for each in self.beats if each.received > now][count - 1] - now
        passed -= self.held_up() - held_up
        assert passed < 0.1 * count + PROMPT, f"{count} heartbeats took {passed:.1f} s"

    def until_silent(self) -> None:
        """Wait until the safety node has not been heard for five periods of its heartbeat.

        What it sent before the fault may still be on its way; for how long is up to the machine.

        Raises:
            AssertionError: if it does not fall silent, or has sent anything since.
        """
        began, held_up = time.time(), self.held_up()
        before = -1
        while (heard := len(self.beats) + len(self.states["/stop"])) != before:
            assert time.time() < began + LIMIT, "the safety node does not fall silent"
            before = heard
            self.spin(0.5)
        went_on = max(each.sent for each in (*self.beats, *self.states["/stop"])) - began
        went_on -= self.held_up() - held_up
        assert went_on < PROMPT, f"it went on for {went_on:.1f} s"

    def until_driving(self) -> None:
        """Wait until the drive gets the commands as they are given."""
        self.until(lambda: self.commands and self.commands[-1].value == COMMAND)

    # Processes

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

    @contextlib.contextmanager
    def gate(self, *parameters: str, **env: str) -> Iterator[Process]:
        """Run the gate through a fault, and see that it ends well; to be used within the node's."""
        gate = self.start(GATE, parameters, **env)
        self.until(lambda: self.commands)
        yield gate
        gate.end()

    @contextlib.contextmanager
    def wheels_gate(self) -> Iterator[Process]:
        """Run the gate that waits, as :meth:`gate` does the other one."""
        gate = self.start(WHEELS_GATE)
        self.until(lambda: self.wheels)
        yield gate
        if gate.popen.poll() is None:
            gate.end()

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
        self._prober = Sensors({"/speed": SENSES["/speed"]}, self.env)
        self._prober.match("/speed")
        self.until_alive()

    def interfere(self, how: str) -> None:
        """Break a rule whose actions are ``interfere`` and, written after it, the latched stop.

        Args:
            how: what ``interfere`` does, as tests/faults/models/interference knows it.
        """
        assert self._prober is not None
        (self.folder / "interference").write_text(how, encoding="ascii")
        self._play_speed(RUNAWAY)
        self._prober.play("/speed", speed(0.1))

    def _play_speed(self, value: float) -> None:
        """Play a speed until it is received; messages of earlier plays may still be on their way.

        Raises:
            AssertionError: if it does not come.
        """
        assert self._prober is not None
        began = time.time()
        self._prober.play("/speed", speed(value))
        self.until(lambda: value in [each.value for each in self._speeds if each.sent >= began])

    def let_go_on(self) -> None:
        """Let code that waits go on."""
        (self.folder / "interference.over").touch()

    def violate(self) -> None:
        """Break the rule of the latched stop for a moment, and see the stop come.

        Raises:
            AssertionError: if the stop is missed.
        """
        assert self._prober is not None
        self._play_speed(VIOLATION)
        self.until_stopped(limit=PROMPT)
        self._prober.play("/speed", speed(0.1))
        self.until(lambda: self._speeds[-1].value == 0.1)

    def reset(self, node: str = NODE) -> tuple[bool, str]:
        """Call the reset service of a node; return whether it was done, and what it says."""
        response = self.call_reset(node)
        self.until(response.done)
        return response.result().success, response.result().message

    def call_reset(self, node: str = NODE) -> Any:
        """Call the reset service, and return the response that is to come, as a future."""
        from std_srvs.srv import Trigger

        self.until(self._resets[node].service_is_ready)
        return self._resets[node].call_async(Trigger.Request())

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
        super().clear()
        if self._prober is not None:
            self._prober.close()

    def held_up(self) -> float:
        """Return the seconds for which the machine ran other processes than those of the test."""
        prober = 0.0 if self._prober is None else self._prober.waited()
        return super().held_up() + prober
