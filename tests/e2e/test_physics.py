"""The robots in physics on real middleware, as the README starts them: hardware fails."""

from __future__ import annotations

import os
import re
import signal
from collections.abc import Callable
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import pytest

from tests.support.ros import LIMIT, Peer, read_line, running
from tests.support.started_examples import start_example

pytest.importorskip("mujoco", reason="the extra 'physics' is not installed")

STANDING = 10
"""Messages in a row, 20 ms apart, with which the robot stands."""

SECOND = 50
"""Messages in a second."""

STOPS = {"intelligent_one": "/stop"}
"""The topic of the stop, where it is another than ``/safety/stop``."""

TRIES = 3
"""A robot sets off so often at most, until it is stopped by its fault.

A machine that does not let a process run for a while stops a robot, too, and rightly: its inputs
are silent, its wheels do not follow. That says nothing about the fault.
"""


class Watch:
    """What is heard of a robot: its fault, its stop, and how it truly moves (m/s, rad/s).

    Attributes:
        motions: forwards and around, every 20 ms.
        said: what the safety node has logged.
        failed_ns: when the fault was said, in ns since the epoch by its sender's clock.
        stopped_ns: the same of the first message that says that it is stopped.
    """

    def __init__(self, peer: Peer, robot: str, fault: str) -> None:
        """Begin to hear."""
        from nav_msgs.msg import Odometry
        from rcl_interfaces.msg import Log
        from std_msgs.msg import Bool

        self.motions: list[tuple[float, float]] = []
        self.said: list[str] = []
        self._fault = f"fault: {fault}"
        self.failed_ns = self.stopped_ns = 0
        self._peer = peer
        self._heard: list[Any] = []
        self.hear(Bool, STOPS.get(robot, "/safety/stop"), self._on_stop, 10)
        self.hear(Log, "/rosout", self._on_log, 100)
        self.hear(Odometry, "/truth", self._on_truth, 50)

    def hear(self, kind: type, topic: str, callback: Callable[..., None], depth: int) -> None:
        """Hear a topic, until the end."""
        self._heard.append(self._peer.node.create_subscription(kind, topic, callback, depth))

    def close(self) -> None:
        """Hear nothing more: the next robot is not this one."""
        for subscription in self._heard:
            self._peer.node.destroy_subscription(subscription)

    def until_it_is_stopped(self) -> bool:
        """Wait until it fails and is stopped; return whether it drove up to its fault."""
        self._peer.until(lambda: self.failed_ns, 2 * LIMIT)
        if not any(forward > 0.15 for forward, _ in self.motions[-SECOND:]):
            return False
        self._peer.until(lambda: self.stopped_ns, 2 * LIMIT)
        return self.failed_ns < self.stopped_ns

    def first_reason(self) -> str:
        """Wait until the safety node gives a reason of a stop, and return its first."""
        return str(self._peer.until(lambda: [each for each in self.said if "stop: " in each])[0])

    def _on_stop(self, msg: Any, info: dict[str, int]) -> None:
        if msg.data and not self.stopped_ns:
            self.stopped_ns = info["source_timestamp"]

    def _on_log(self, msg: Any, info: dict[str, int]) -> None:
        if msg.name == "safety":
            self.said.append(msg.msg)
        elif msg.msg == self._fault:
            self.failed_ns = info["source_timestamp"]

    def _on_truth(self, msg: Any) -> None:
        self.motions.append((msg.twist.twist.linear.x, msg.twist.twist.angular.z))


W = TypeVar("W", bound=Watch)


@dataclass(frozen=True)
class Player:
    """Runs robots until they are stopped by their faults.

    Attributes:
        peer: hears them.
        packages: a folder for the generated packages.
        env: the environment.
    """

    peer: Peer
    packages: Path
    env: dict[str, str]

    def play(
        self,
        robot: str,
        fault: str,
        reason: str,
        watching: type[W],
        then: Callable[[W], None],
        *arguments: str,
    ) -> None:
        """Run a robot until it is stopped by its fault, for the reason that the fault is.

        Args:
            robot: its name.
            fault: what fails of it.
            reason: what the safety node says of that first.
            watching: how it is heard.
            then: what is to be seen of the robot after its stop, before it is ended.
            arguments: of its launch.
        """
        example = f"{robot}_in_physics"
        command = [*start_example("physics", self.packages, self.env, fault, example), *arguments]
        for number in range(TRIES):
            home = f"{self.env['ROS_HOME']}/{number}"  # a stop outlasts the robot, in a file
            with (
                closing(watching(self.peer, robot, fault)) as watch,
                running(command, {**self.env, "ROS_HOME": home}),
            ):
                if watch.until_it_is_stopped() and reason in watch.first_reason():
                    then(watch)
                    return
        raise AssertionError(f"not stopped by {fault}, as '{reason}', in {TRIES} tries")


@pytest.fixture
def player(tmp_path: Path, ros_env: dict[str, str], ros_peer: Peer) -> Player:
    """Return what runs robots in an environment of its own."""
    return Player(ros_peer, tmp_path / "packages", ros_env)


@pytest.mark.ros
@pytest.mark.parametrize(
    ("robot", "fault", "reason"),
    [
        ("frobit", "left_encoder", "stop: a wheel does not turn in spite of thrust"),
        ("frobit", "line", "stop: a wheel or the odometry is silent"),
        ("kobuki", "left_encoder", "stop: it spins"),
        ("kobuki", "runaway", "stop: too fast"),
        ("intelligent_one", "bank", "stop: tilted"),
        ("feeding_robot", "person", "stop: obstacle in the stop zone"),
        ("feeding_robot", "runaway", "motor stop: speed limit exceeded"),
    ],
)
def test_robot_stands_after_a_fault_of_its_hardware(
    robot: str, fault: str, reason: str, player: Player
) -> None:
    """It sets off and drives, is stopped for the reason that the fault is, and truly rests."""

    def until_it_rests(watch: Watch) -> None:
        at_the_stop = len(watch.motions)
        player.peer.until(
            lambda: (
                len(watch.motions) > at_the_stop + STANDING
                and all(v < 0.01 and abs(w) < 0.05 for v, w in watch.motions[-STANDING:])
            )
        )

    player.play(robot, fault, reason, Watch, until_it_rests)


@pytest.mark.ros
def test_robot_without_a_relay_is_stopped_and_drives_on(player: Player) -> None:
    """A limit that the README states: the gate commands zero, and a short circuit obeys nothing."""
    from geometry_msgs.msg import Twist

    commands: list[float] = []
    player.peer.node.create_subscription(
        Twist, "/command", lambda msg: commands.append(msg.linear.x), 10
    )

    def see_it_drive_on(watch: Watch) -> None:
        assert any(forward > 0.3 for forward in commands)
        player.peer.until(lambda: commands[-STANDING:] == [0.0] * STANDING)
        at_the_zeros = len(watch.motions)
        player.peer.until(lambda: len(watch.motions) > at_the_zeros + STANDING)
        assert all(forward > 0.3 for forward, _ in watch.motions[-STANDING:])

    player.play("intelligent_one", "runaway", "stop: too fast", Watch, see_it_drive_on)


class Timed(Watch):
    """Hears times in ns of ``/clock``, too: of the stop, and of what is sent as the clock is."""

    def __init__(self, peer: Peer, robot: str, fault: str) -> None:
        """Begin to hear."""
        super().__init__(peer, robot, fault)
        from diagnostic_msgs.msg import DiagnosticStatus
        from rosgraph_msgs.msg import Clock  # type: ignore[import-untyped]

        self.triggered_ns: int | None = None
        self._clock: list[tuple[int, int]] = []
        self.hear(Clock, "/clock", self._on_clock, 1000)
        self.hear(DiagnosticStatus, "/safety/events", self._on_event, 100)

    @property
    def now_ns(self) -> int:
        """Return the time that was heard last."""
        return self._clock[-1][1]

    def at(self, stamp: int) -> int:
        """Return the last time that was sent before something that the same process sent.

        Args:
            stamp: of that, at its source. When either is heard does not count.
        """
        return max(now for sent, now in self._clock if sent <= stamp)

    def _on_clock(self, msg: Any, info: dict[str, int]) -> None:
        now = msg.clock.sec * 10**9 + msg.clock.nanosec
        assert not self._clock or now > self._clock[-1][1], "simulated time went back"
        self._clock.append((info["source_timestamp"], now))

    def _on_event(self, msg: Any) -> None:
        told = {value.key: value.value for value in msg.values}
        if told["kind"] == "trigger" and told["action"] == "stop" and self.triggered_ns is None:
            self.triggered_ns = int(told["time_ns"])


@pytest.mark.ros
def test_interval_of_a_rule_lasts_in_simulated_time(player: Player) -> None:
    """By the machine's clock, the 0.3 s of the rule would be 0.15 s of a clock half as fast.

    How long messages take from node to node is the machine's: no upper bound holds under load.
    """

    def hear_that_it_lasted(watch: Timed) -> None:
        stopped = player.peer.until(lambda: watch.triggered_ns)
        player.peer.until(lambda: watch.now_ns >= stopped)
        player.peer.until(lambda: watch.motions[-1][0] < 0.01)
        assert stopped - watch.at(watch.failed_ns) >= 0.3e9

    robot, fault, reason = (
        "frobit",
        "left_encoder",
        "stop: a wheel does not turn in spite of thrust",
    )
    half_as_fast = ("use_sim_time:=true", "real_time_factor:=0.5")
    player.play(robot, fault, reason, Timed, hear_that_it_lasted, *half_as_fast)


@pytest.mark.ros
@pytest.mark.slow
def test_gate_commands_zero_when_the_physics_hangs(
    tmp_path: Path, ros_env: dict[str, str], ros_peer: Peer
) -> None:
    """Time stands, and the heartbeat with it: the gate, whose losses are not on that, notices."""
    from geometry_msgs.msg import Twist

    speeds: list[float] = []
    ros_peer.node.create_subscription(
        Twist, "/drive/command", lambda msg: speeds.append(msg.linear.x), 10
    )
    packages = tmp_path / "packages"
    command = start_example("physics", packages, ros_env, "none", "frobit_in_physics")
    with running([*command, "use_sim_time:=true"], ros_env) as process:
        board = None
        while board is None:
            board = re.search(r"board started, process (\d+)", read_line(process))
        ros_peer.until(lambda: any(speed > 0.1 for speed in speeds), 2 * LIMIT)
        os.kill(int(board[1]), signal.SIGSTOP)
        try:
            ros_peer.until(lambda: speeds[-STANDING:] == [0.0] * STANDING)
        finally:
            os.kill(int(board[1]), signal.SIGCONT)
