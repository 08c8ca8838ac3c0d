"""The player's end of the running system: it watches every topic, and moves the world's levers.

All waiting is for messages. One thread spins ROS and feeds the listeners; the thread that plays a
case waits on the state that these messages add up to.
"""

from __future__ import annotations

import math
import os
import signal
import threading
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import rclpy
from geometry_msgs.msg import Vector3
from nav_msgs.msg import Odometry
from rclpy.clock import Clock, ClockType
from rclpy.executors import SingleThreadedExecutor
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rosgraph_msgs.msg import Clock as ClockMessage
from sensor_msgs.msg import Imu, LaserScan
from std_msgs.msg import Bool, Float64, UInt8, UInt64
from std_srvs.srv import Trigger

from demonstration.pace import Pace
from demonstration.referee import Event, RobotState, nearest_ahead

MANUAL, LEARN, AUTOMATIC = 0, 1, 2
"""The positions of the mode switch."""

VIEW = math.radians(30.0)
"""Half the angle ahead, in rad, that the rules look at."""

CONTACTS = {
    "stop_button": "/panel/stop_button",
    "front_bumper": "/contact/front_bumper",
    "rear_bumper": "/contact/rear_bumper",
    "feeding_arm": "/contact/feeding_arm",
}
"""What the PLC reports as, and the topic that presses it."""

_LATCHED = QoSProfile(
    depth=1,
    reliability=ReliabilityPolicy.RELIABLE,
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
)

Values = dict[str, Any]
Listener = Callable[[Event], None]


class OverdueError(Exception):
    """Something that the player waited for did not happen in time."""


def _data(name: str) -> Callable[[Any], Values]:
    return lambda message: {name: message.data}


def _attitude(message: Imu) -> Values:
    q = message.orientation
    roll = math.atan2(2 * (q.w * q.x + q.y * q.z), 1 - 2 * (q.x * q.x + q.y * q.y))
    pitch = math.asin(max(-1.0, min(1.0, 2 * (q.w * q.y - q.z * q.x))))
    return {"roll": roll, "pitch": pitch}


def _nearest(message: LaserScan) -> Values:
    return {
        "nearest": nearest_ahead(message.ranges, message.angle_min, message.angle_increment, VIEW)
    }


_NODES_TO_RESET = {"safety": "/safety", "gate": "/actuators_command_gate"}

_WATCHED: tuple[tuple[str, type, Callable[[Any], Values]], ...] = (
    ("/odometry", Odometry, lambda message: {"speed": message.twist.twist.linear.x}),
    ("/imu", Imu, _attitude),
    ("/scan", LaserScan, _nearest),
    ("/plc/mode", UInt8, _data("mode")),
    ("/plc/stop_button", Bool, _data("stop_button")),
    ("/plc/front_bumper", Bool, _data("front_bumper")),
    ("/plc/rear_bumper", Bool, _data("rear_bumper")),
    ("/plc/feeding_arm", Bool, _data("feeding_arm")),
    ("/plc/engine_running", Bool, _data("engine_running")),
    ("/plc/keep_alive", UInt64, _data("plc_keep_alive")),
    ("/machine/engine_enable", Bool, _data("engine_enabled")),
    ("/controller/keep_alive", UInt64, _data("controller_keep_alive")),
    ("/safety/heartbeat", UInt64, _data("heartbeat")),
    ("/safety/low_speed", Bool, _data("low_speed")),
    ("/safety/stop", Bool, _data("stop")),
    ("/safety/motor_stop", Bool, _data("motor_stop")),
    ("/safety/controller_ok", Bool, _data("controller_ok")),
)


class Stage:
    """Watches the system and acts on its surroundings; use it as a context manager.

    Args:
        safety_node: finds the process of the safety node.
        simulated: whether the player sets the pace of time (see :class:`Pace`) or real time counts.
    """

    def __init__(self, safety_node: Callable[[], int], simulated: bool = False) -> None:
        """Join the system's ROS domain, which the environment names."""
        self.state = RobotState()
        self.now = 0
        self._safety_node = safety_node
        self._abandoned = ""
        self._listeners: list[Listener] = []
        self._changed = threading.Condition()
        self._done = threading.Event()
        self._context = rclpy.Context()
        self._context.init()
        self._node = Node("player", context=self._context)
        self._levers: dict[str, Any] = {}
        self._pace = self._make_pace() if simulated else None
        for topic, kind, values in _WATCHED:
            receive = self._receiver(values) if self._pace is None else self._stepper(values)
            self._node.create_subscription(kind, topic, receive, 50)
        self._resets = {
            node: self._node.create_client(Trigger, f"{full_name}/reset")
            for node, full_name in _NODES_TO_RESET.items()
        }
        # The events executor is several times faster, but cannot hand over time stamps.
        executor = EventsExecutor if simulated else SingleThreadedExecutor
        self._executor = executor(context=self._context)
        self._executor.add_node(self._node)
        self._spinner = threading.Thread(target=self._spin, name="player", daemon=True)

    def __enter__(self) -> Stage:
        """Start to listen."""
        self._spinner.start()
        return self

    def __exit__(self, *_: object) -> None:
        """Leave the domain."""
        self._done.set()
        self._spinner.join()
        self._executor.shutdown()
        self._node.destroy_node()
        self._context.try_shutdown()

    def _make_pace(self) -> Pace:
        """Set up what it takes to let time pass in steps."""
        steps = self._node.create_publisher(Float64, "/world/step", 10)
        # A node answers after it has handled what came before.
        # Its thread that takes the messages answers this, and there is nothing to reset meanwhile.
        question = self._node.create_client(Trigger, "/safety/reset")

        def ask() -> None:
            if question.service_is_ready():
                step = pace.now
                answer = question.call_async(Trigger.Request())
                # A question that was put twice is answered twice: the second time says nothing new.
                answer.add_done_callback(lambda _: pace.now == step and pace.answered())

        pace = Pace(lambda seconds: steps.publish(Float64(data=seconds)), ask)
        self._node.create_subscription(
            ClockMessage,
            "/clock",
            lambda message: pace.ticked(message.clock.sec * 10**9 + message.clock.nanosec),
            50,
        )
        self._node.create_timer(0.1, pace.remind, clock=Clock(clock_type=ClockType.STEADY_TIME))
        return pace

    def _spin(self) -> None:
        try:
            while not self._done.is_set():
                self._executor.spin_once(timeout_sec=0.1)
        except Exception as error:
            self.abandon(f"the player has failed: {error!r}")
            raise

    def _receiver(self, values: Callable[[Any], Values]) -> Callable[[Any, dict[str, int]], None]:
        """Return what takes a message with the real times at which it was sent and received."""

        def receive(message: Any, info: dict[str, int]) -> None:
            self._take(values(message), info["source_timestamp"], info["received_timestamp"])

        return receive

    def _stepper(self, values: Callable[[Any], Values]) -> Callable[[Any], None]:
        """Return what takes a message at the simulated time, and lets that time pass."""
        assert self._pace is not None
        pace = self._pace

        def receive(message: Any) -> None:
            taken = values(message)
            self._take(taken, pace.now, pace.now)
            for name in taken:
                pace.seen(name)

        return receive

    def _take(self, values: Values, sent: int, received: int) -> None:
        with self._changed:
            self.state = replace(self.state, **values)
            self.now = max(self.now, received)
            for name, value in values.items():
                for listener in self._listeners:
                    listener(Event(name, value, sent, received))
            self._changed.notify_all()

    def listen(self, listener: Listener) -> None:
        """Hand every further event to ``listener``, in the thread that receives it."""
        with self._changed:
            self._listeners.append(listener)

    def unlisten(self, listener: Listener) -> None:
        """Stop handing events to ``listener``."""
        with self._changed:
            self._listeners.remove(listener)

    def wait(
        self, what: str, condition: Callable[[RobotState], bool], within: float = 20.0
    ) -> None:
        """Wait until the state meets ``condition``.

        Raises:
            OverdueError: if it does not within so many seconds of real time, or the stage has
                been abandoned.
        """
        if not self.watch(lambda: condition(self.state), within):
            raise OverdueError(f"waited {within:g} s for {what}")

    def watch(self, condition: Callable[[], bool], within: float) -> bool:
        """Wait until ``condition`` holds after some message; return whether it did in time.

        Raises:
            OverdueError: if the stage has been abandoned.
        """
        with self._changed:
            self._changed.wait_for(lambda: self._abandoned or condition(), within)
            if self._abandoned:
                raise OverdueError(self._abandoned)
            return condition()

    def abandon(self, reason: str) -> None:
        """End all waiting, now and later: nothing will happen any more."""
        with self._changed:
            self._abandoned = reason
            self._changed.notify_all()

    def forget(self, **values: None) -> None:
        """Set values back to unknown, so that only a new message counts."""
        with self._changed:
            self.state = replace(self.state, **values)

    # The levers ---------------------------------------------------------------------------------

    def _pull(self, topic: str, message: Any) -> None:
        if topic not in self._levers:
            self._levers[topic] = self._node.create_publisher(type(message), topic, _LATCHED)
        self._levers[topic].publish(message)

    def obstacle(self, distance: float) -> None:
        """Put an obstacle so many metres ahead; infinity takes it away."""
        self._pull("/world/obstacle", Float64(data=distance))

    def hold_pedal(self, position: float) -> None:
        """Hold the pedal by hand; NaN lets it go."""
        self._pull("/world/pedal_override", Float64(data=position))

    def level_ground(self) -> None:
        """Put the robot on level ground."""
        self._pull("/world/slope", Vector3())

    def touch(self, contact: str, pressed: bool = True) -> None:
        """Press or release one of :data:`CONTACTS`."""
        self._pull(CONTACTS[contact], Bool(data=pressed))

    def switch_mode(self, mode: int) -> None:
        """Turn the mode switch."""
        self._pull("/panel/mode", UInt8(data=mode))

    def turn_key(self, turned: bool) -> None:
        """Turn the ignition key, or let it go."""
        self._pull("/panel/ignition", Bool(data=turned))

    def order(self, drive: bool) -> None:
        """Tell the mission to drive, or to stand."""
        self._pull("/mission/order", Bool(data=drive))

    def kill_safety_node(self) -> None:
        """Kill the process of the safety node, as a crash would."""
        os.kill(self._safety_node(), signal.SIGKILL)

    def reset(self, node: str, within: float = 20.0) -> bool:
        """Call the reset service of the safety node or of the gate; return whether it was granted.

        Raises:
            OverdueError: if there is no such service or no answer in time.
        """
        client = self._resets[node]
        if not client.wait_for_service(timeout_sec=within):
            raise OverdueError(f"waited {within:g} s for the service {client.srv_name}")
        answered = threading.Event()
        future = client.call_async(Trigger.Request())
        future.add_done_callback(lambda _: answered.set())
        if not answered.wait(within):
            raise OverdueError(f"waited {within:g} s for an answer of {client.srv_name}")
        return bool(future.result().success)
