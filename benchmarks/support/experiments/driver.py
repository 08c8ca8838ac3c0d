"""Drives a robot's safety node: publishes what its sensors say, breaks that, waits for the action.

Messages are published one by one at the rate of each topic, with the time in their headers: that of
the machine or, where the run is simulated, of a ``/clock`` that the driver publishes as a simulator
does, in steps of :data:`TICK`, as fast as time passes.
"""

from __future__ import annotations

import heapq
import random
import time
from collections.abc import Callable, Mapping
from typing import Any

import rclpy
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.utilities import ok, try_shutdown
from rosgraph_msgs.msg import Clock  # type: ignore[import-untyped]
from std_msgs.msg import Bool
from std_srvs.srv import Trigger

from .message_types import message
from .robots import Fields, Robot

TICK = 10_000_000
"""Nanoseconds of a step of simulated time."""

_BEGIN = 100_000_000_000
"""Where simulated time begins: not at 0, which means that there is none."""

_CLOCK = "/clock"
READY = "/recorder/ready"
"""On which the recorder says that it receives all topics."""

LATCHED_QOS = QoSProfile(
    reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.TRANSIENT_LOCAL, depth=10
)
"""Of states, and of :data:`READY`: whoever comes late receives the last ones."""

_Due = tuple[int, bool, str, int]
"""When something is published, in which order, what, and when it was due."""

_RESET_AGAIN = 0.5
"""Seconds after which a reset that was refused is asked for again."""


class Driver:
    """Plays a robot to its safety node; ends with :meth:`close`.

    Args:
        robot: whose sensors it plays.
        simulated: whether it publishes ``/clock``.
        watch: called about once a second.

    Attributes:
        active: by the topic of an action, whether it is active.
    """

    def __init__(self, robot: Robot, simulated: bool, watch: Callable[[], None]) -> None:
        """Join the ROS domain that the environment names."""
        rclpy.init()
        self._node = Node("robot", enable_rosout=False, start_parameter_services=False)
        self._executor = EventsExecutor()
        self._executor.add_node(self._node)
        self._simulated = simulated
        self._watch = watch
        self._watched = time.monotonic()
        self._types = {each.topic: each.type for each in robot.sensors}
        self._normal = {each.topic: each.fields for each in robot.sensors}
        self._periods = {each.topic: round(1e9 / each.hertz) for each in robot.sensors}
        self._messages: dict[str, Any] = {}
        self.say({})
        self._publishers = {
            topic: self._node.create_publisher(type(each), topic, 10)
            for topic, each in self._messages.items()
        }
        self.active = dict.fromkeys(robot.actions, False)
        self._states = [
            self._node.create_subscription(Bool, topic, self._taker(topic), LATCHED_QOS)
            for topic in self.active
        ]
        self._recorded: list[Bool] = []
        self._node.create_subscription(Bool, READY, self._recorded.append, LATCHED_QOS)
        self._reset = self._node.create_client(Trigger, f"/{robot.node}/reset")
        self._start = time.monotonic_ns()
        self._due: list[_Due] = []
        for topic, period in self._periods.items():
            self._schedule(topic, self._start + random.randrange(period))
        if simulated:
            clock = QoSProfile(reliability=ReliabilityPolicy.BEST_EFFORT, depth=1)
            self._clock = self._node.create_publisher(Clock, _CLOCK, clock)
            self._periods[_CLOCK] = TICK
            self._schedule(_CLOCK, self._start)

    def say(self, faults: Mapping[str, Fields]) -> None:
        """Have the sensors say something else from now on: faults, by topic; else all is well."""
        for topic, fields in self._normal.items():
            self._messages[topic] = message(self._types[topic], faults.get(topic, fields))

    def meet(self, readers: int, seconds: float) -> None:
        """Publish until each topic has so many readers, and all is recorded.

        Raises:
            TimeoutError: if one still lacks them after so many seconds.
        """
        if not self.run_until(lambda: not self._missing(readers), seconds):
            raise TimeoutError(f"no endpoint is connected to {', '.join(self._missing(readers))}")

    def _missing(self, readers: int) -> list[str]:
        found = [
            topic
            for topic, publisher in self._publishers.items()
            if publisher.get_subscription_count() < readers
        ]
        found += [each.topic_name for each in self._states if not each.get_publisher_count()]
        found += [] if self._recorded else [READY]
        return found + ([] if self._reset.service_is_ready() else [self._reset.srv_name])

    def run(self, seconds: float) -> None:
        """Publish for so many seconds."""
        self.run_until(lambda: False, seconds)

    def run_until(self, is_over: Callable[[], bool], seconds: float) -> bool:
        """Publish until something is so, for at most so many seconds; return whether it is."""
        end = time.monotonic_ns() + round(seconds * 1e9)
        while not is_over():
            now = time.monotonic_ns()
            if now >= end:
                return False
            if now >= self._due[0][0]:
                self._publish_next()
            else:
                left = min(self._due[0][0], end) - now
                self._executor.spin_once(timeout_sec=left / 1e9)
            if time.monotonic() - self._watched >= 1.0:
                self._watched = time.monotonic()
                self._watch()
            if not ok():
                raise KeyboardInterrupt
        return True

    def reset(self, seconds: float) -> bool:
        """Ask for a reset until no action is active; return whether it came to that in time."""
        end = time.monotonic() + seconds
        while any(self.active.values()):
            if time.monotonic() > end:
                return False
            answer = self._reset.call_async(Trigger.Request())
            if not self.run_until(answer.done, seconds):
                return False
            if not self.run_until(lambda: not any(self.active.values()), _RESET_AGAIN):
                continue
        return True

    def close(self) -> None:
        """Leave the domain."""
        self._executor.shutdown()
        self._node.destroy_node()
        try_shutdown()

    def _publish_next(self) -> None:
        instant, _, topic, due = heapq.heappop(self._due)
        self._schedule(topic, due + self._periods[topic])
        now = _BEGIN + instant - self._start if self._simulated else time.monotonic_ns()
        seconds, nanoseconds = divmod(now, 1_000_000_000)
        if topic == _CLOCK:
            told = Clock()
            told.clock.sec, told.clock.nanosec = seconds, nanoseconds
            self._clock.publish(told)
        else:
            told = self._messages[topic]
            if hasattr(told, "header"):
                told.header.stamp.sec, told.header.stamp.nanosec = seconds, nanoseconds
            self._publishers[topic].publish(told)

    def _schedule(self, topic: str, due: int) -> None:
        """Have a topic published at an instant; simulated, at the step that comes then or next."""
        instant = due
        if self._simulated:
            instant = self._start - (self._start - due) // TICK * TICK
        # At one instant the clock comes first.
        heapq.heappush(self._due, (instant, topic != _CLOCK, topic, due))

    def _taker(self, topic: str) -> Callable[[Bool], None]:
        def take(told: Bool) -> None:
            self.active[topic] = told.data

        return take
