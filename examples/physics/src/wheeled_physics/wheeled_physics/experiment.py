"""A board in physics, in real or simulated time, which fails when it is to."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from builtin_interfaces.msg import Time
from geometry_msgs.msg import Quaternion
from nav_msgs.msg import Odometry
from rclpy.clock import Clock
from rclpy.impl.rcutils_logger import RcutilsLogger
from rclpy.timer import Timer
from rosgraph_msgs.msg import Clock as ClockMessage
from wheeled_physics.passing_time import CYCLE, PassingTime, RealTime, SimulatedTime
from wheeled_physics.robot import PULSE, Robot

SETTLED = 0.2
"""Time, in s, after which the robot rests on its wheels and casters; until then these give way."""


class Board(Protocol):
    """What drives a robot in physics."""

    robot: Robot

    def advance(self, duration: float) -> None:
        """Let time pass, in s."""

    def fail(self, fault: str) -> None:
        """Let something fail for good."""

    def moves(self) -> bool:
        """Return whether the robot moves."""


class Given(Protocol):
    """The parameters that each node in physics has."""

    @property
    def fault(self) -> str:
        """Return what is to fail; ``none`` is no fault."""

    @property
    def fault_after(self) -> float:
        """Return how many seconds after the robot has first moved."""

    @property
    def simulates_time(self) -> bool:
        """Return whether the physics makes the time of all nodes."""

    @property
    def real_time_factor(self) -> float:
        """Return how many seconds of simulated time pass in one of the machine."""


class NodeInPhysics(Protocol):
    """What the base class of each node in physics has."""

    timer_cycle: Timer
    clock_of_timers: Clock

    @property
    def parameters(self) -> Given:
        """Return the parameters as they are now."""

    def publish_clock(self, msg: ClockMessage) -> None:
        """Publish on clock."""

    def get_clock(self) -> Clock:
        """Return the clock of stamps."""

    def get_logger(self) -> RcutilsLogger:
        """Return where it says what happens."""


class Experiment:
    """One board and one fault, some time after the robot has first moved."""

    def __init__(
        self,
        board: Board,
        time: PassingTime,
        fault: str,
        fault_after: float,
        say: Callable[[str], None],
    ) -> None:
        """
        Begin; ``none`` is no fault.

        What happens is said: that the robot moves, and the fault.
        """
        self._board = board
        self._time = time
        self._fault = fault
        self._fault_after = fault_after
        self._say = say
        self._moving_since: float | None = None
        self._failed = fault == 'none'

    def advance(self) -> Time:
        """Let the time of a cycle pass in physics; return the stamp of what is then."""
        pulses = self._time.pass_on()
        if pulses > 0:
            self._board.advance(pulses * PULSE)
        self._fail_in_time()
        return self._time.stamp()

    def _fail_in_time(self) -> None:
        time = self._board.robot.time
        if self._moving_since is None and time > SETTLED and self._board.moves():
            self._moving_since = time
            self._say('the robot moves')
        since = self._moving_since
        if self._failed or since is None or time - since < self._fault_after:
            return
        self._failed = True
        self._board.fail(self._fault)
        self._say(f'fault: {self._fault}')


def begin(node: NodeInPhysics, board: Board) -> Experiment:
    """Return the experiment of a node, which is to advance it once in each of its cycles."""
    given = node.parameters
    time: PassingTime
    if given.simulates_time:
        node.timer_cycle.timer_period_ns = round(CYCLE / given.real_time_factor * 1e9)
        time = SimulatedTime(node.publish_clock)
    else:
        time = RealTime(
            lambda: float(node.clock_of_timers.now().nanoseconds) / 1e9,
            lambda: node.get_clock().now().to_msg(),
        )
    return Experiment(board, time, given.fault, given.fault_after, node.get_logger().warning)


def truth(robot: Robot, stamp: Time) -> Odometry:
    """Return where a robot really is, how it stands, and how fast it is over the ground."""
    msg = Odometry()
    msg.header.stamp = stamp
    msg.header.frame_id, msg.child_frame_id = 'world', 'base_link'
    pose, twist = msg.pose.pose, msg.twist.twist
    pose.position.x, pose.position.y = robot.position()
    pose.position.z = robot.height()
    x, y, z, w = robot.orientation()
    pose.orientation = Quaternion(x=x, y=y, z=z, w=w)
    twist.linear.x, twist.angular.z = robot.speed(), robot.turn_rate()
    return msg
