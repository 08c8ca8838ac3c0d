"""One start of a robot with a fault: it drives, fails, is stopped and stands, or does not."""

from __future__ import annotations

import re
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import rclpy
from demonstration.robot import Robot as Running
from nav_msgs.msg import Odometry
from rclpy.executors import SingleThreadedExecutor
from std_msgs.msg import Bool

from shown.robots import EXAMPLES, Robot

PATIENCE = 60.0
"""Most seconds in which what is waited for is to happen."""

DRIVES, RESTS = 0.1, 0.02
"""Speeds, in m/s, above which a robot drives, and below which it stands."""

ROW = 10
"""Messages in a row with which it stands."""

_SAID = re.compile(r"\[(\d+\.\d+)\] (?:\[[^]]*\]: (?=fault)|\[safety\]: (?=(?:motor )?stop: ))(.+)")


@dataclass(frozen=True)
class Motion:
    """Where a robot is (m), and how fast (m/s, rad/s), at a time in s."""

    time: float
    x: float
    y: float
    speed: float
    turn: float


@dataclass
class Outcome:
    """What happened.

    Attributes:
        fault: that was to happen.
        expected: how the reason is to begin.
        said: the reasons that the safety node gave, in their order.
        seconds: from the fault to the first reason; ``None`` if one of them is not in the log.
        stopped_at: when the stop was received, on the clock of ``motions``.
        overdue: what did not happen, empty if all has.
    """

    fault: str
    expected: str
    said: list[str] = field(default_factory=list)
    seconds: float | None = None
    stopped_at: float | None = None
    motions: list[Motion] = field(default_factory=list)
    overdue: str = ""

    @property
    def passed(self) -> bool:
        """Whether the robot drove, was stopped for the reason that the fault is, and stands."""
        return not self.overdue and bool(self.said) and self.said[0].startswith(self.expected)


def show(robot: Robot, fault: str, packages: Path, log: Path) -> Outcome:
    """Start a robot with a fault and wait until it stands; what its nodes say goes to ``log``."""
    outcome = Outcome(fault, robot.faults[fault])
    given = {**robot.arguments, **({robot.argument: fault} if robot.argument else {})}
    arguments = [f"{name}:={value}" for name, value in given.items()]
    with (
        _Watch(robot, outcome) as watch,
        Running(EXAMPLES / robot.system, [packages], log, arguments),
    ):
        for what, happens in (
            ("it did not set off", watch.drives),
            ("it was not stopped", watch.is_stopped),
            ("it did not come to rest", watch.rests),
        ):
            if not watch.until(happens):
                outcome.overdue = what
                break
    _read(log.read_text(encoding="utf-8"), outcome)
    return outcome


def _read(log: str, outcome: Outcome) -> None:
    """Take from a log what the safety node said, and how long after the fault."""
    said = [(float(when), text) for when, text in _SAID.findall(log)]
    faults = [when for when, text in said if text == f"fault: {outcome.fault}"]
    stops = [(when, text) for when, text in said if not text.startswith("fault: ")]
    outcome.said = [text for _, text in stops]
    if faults and stops:
        outcome.seconds = stops[0][0] - faults[0]


class _Watch:
    """A node that hears how the robot moves, and its stop."""

    def __init__(self, robot: Robot, outcome: Outcome) -> None:
        self._robot = robot
        self._outcome = outcome
        self._began = time.monotonic()

    def __enter__(self) -> _Watch:
        self._context = rclpy.Context()
        rclpy.init(context=self._context)
        self._node = rclpy.create_node("faults_shown", context=self._context)
        self._node.create_subscription(Odometry, self._robot.motion, self._move, 50)
        self._node.create_subscription(Bool, self._robot.stop, self._stop, 10)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        return self

    def __exit__(self, *_: object) -> None:
        self._executor.shutdown()
        self._node.destroy_node()
        self._context.try_shutdown()

    def until(self, happens: Callable[[], bool]) -> bool:
        """Take messages until something is so; return whether it was in time."""
        end = time.monotonic() + PATIENCE
        while not happens():
            if time.monotonic() > end:
                return False
            self._executor.spin_once(1.0)
        return True

    def drives(self) -> bool:
        return any(abs(each.speed) > DRIVES for each in self._outcome.motions[-ROW:])

    def is_stopped(self) -> bool:
        return self._outcome.stopped_at is not None

    def rests(self) -> bool:
        motions, since = self._outcome.motions[-ROW:], self._outcome.stopped_at or 0.0
        later = len(motions) == ROW and motions[0].time > since
        return later and all(
            abs(each.speed) < RESTS and abs(each.turn) < 5 * RESTS for each in motions
        )

    def _move(self, msg: Any) -> None:
        place, twist = msg.pose.pose.position, msg.twist.twist
        now = time.monotonic() - self._began
        self._outcome.motions.append(Motion(now, place.x, place.y, twist.linear.x, twist.angular.z))

    def _stop(self, msg: Any) -> None:
        if msg.data and self._outcome.stopped_at is None:
            self._outcome.stopped_at = time.monotonic() - self._began
