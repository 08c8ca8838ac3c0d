"""What a safety node knows beside a message: when it came, and who publishes, on middleware."""

from __future__ import annotations

import os
import sys
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any

import pytest

from deros.generators.output.writer import write
from deros.generators.runtime.interface import PYTHON_RUNTIME, with_runtime
from deros.generators.safety_package.cpp import generate as safety_cpp
from deros.generators.safety_package.python import generate as safety_python
from tests.support.cpp import colcon_build, overlay, program
from tests.support.generating import output_of
from tests.support.needs import needs
from tests.support.ros import Peer, running

pytestmark = pytest.mark.ros

MODEL = Path(__file__).with_name("python") / "models/late.deros"
RULES = """\
use "robot.system" import Robot
action late publishes true on /stop : std_msgs.Bool reset_by fresh;
action fresh;
input imu = topic /imu on_second_publisher unknown timeout 600 sec
entity imu_stage {
  failsafe late: imu.latency() not in [0 sec, 100 sec];
  fresh: imu.latency() in [0 sec, 100 sec];
}
if imu_stage.late then { late; };
if imu_stage.fresh then { fresh; };
"""


@pytest.fixture(params=["python", pytest.param("cpp", marks=needs("rclcpp"))])
def node(
    request: pytest.FixtureRequest, ros_env: dict[str, str], tmp_path: Path
) -> AbstractContextManager[Any]:
    """Return the running node, in one language after the other."""
    generate = (safety_python if request.param == "python" else safety_cpp).generate
    write(with_runtime(output_of(generate, MODEL, RULES)), tmp_path)
    if request.param == "cpp":
        install = colcon_build(tmp_path)
        command = [program(install, "late_safety_cpp", "late_safety_node_cpp")]
        return running(command, overlay(install, ros_env))
    paths = os.pathsep.join((str(tmp_path / "late_safety"), str(tmp_path / PYTHON_RUNTIME)))
    command = [sys.executable, "-m", "late_safety.late_safety_node"]
    return running(command, {**ros_env, "PYTHONPATH": paths})


class Sensor:
    """The test's end: it publishes the attitude, and receives the state of the action."""

    def __init__(self, peer: Peer) -> None:
        """Publish, and subscribe."""
        from rclpy.qos import DurabilityPolicy, QoSProfile
        from sensor_msgs.msg import Imu
        from std_msgs.msg import Bool

        self.peer = peer
        self._message = Imu
        self._states: list[bool] = []
        kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        peer.node.create_subscription(Bool, "/stop", lambda m: self._states.append(m.data), kept)
        self._publisher = peer.node.create_publisher(Imu, "/imu", 10)

    def meet(self) -> None:
        """Wait for the safety node, whose action is not active yet."""
        self.peer.until(lambda: self._publisher.get_subscription_count() == 1)
        self.peer.until(lambda: self._states[-1:] == [False])

    def publish(self, stamp: Any) -> None:
        """Publish a message with a stamp."""
        msg = self._message()
        msg.header.stamp = stamp.to_msg()
        msg.orientation.w = 1.0
        self._publisher.publish(msg)

    def show(self, stamp: Any, *, is_late: bool) -> None:
        """Publish a message until the verdict on it comes.

        The node may find the publisher later than the publisher finds the node, and what is
        published in between is lost.
        """

        def is_seen() -> bool:
            self.publish(stamp)
            return self._states[-1] is is_late

        self.peer.until(is_seen)

    def repeat(self, *, is_late: bool) -> None:
        """Publish messages of the present until the verdict comes."""

        def is_seen() -> bool:
            self.publish(self.peer.node.get_clock().now())
            return self._states[-1] is is_late

        self.peer.until(is_seen)


def test_stamps_are_compared_with_the_clock_that_sets_them(
    node: AbstractContextManager[Any], ros_peer: Peer
) -> None:
    """A message is late by the system's time, with a stamp of zero, and from the future."""
    from rclpy.duration import Duration
    from rclpy.time import Time

    sensor, clock = Sensor(ros_peer), ros_peer.node.get_clock()
    with node:
        sensor.meet()
        sensor.show(clock.now() - Duration(seconds=1000), is_late=True)
        sensor.show(clock.now(), is_late=False)
        sensor.show(Time(), is_late=True)
        sensor.show(clock.now(), is_late=False)
        sensor.show(clock.now() + Duration(seconds=1000), is_late=True)


def test_second_publisher_makes_the_input_unknown_until_it_ends(
    node: AbstractContextManager[Any], ros_peer: Peer
) -> None:
    """Neither of them is believed, and the one that stays is again."""
    from sensor_msgs.msg import Imu

    sensor = Sensor(ros_peer)
    with node:
        sensor.meet()
        sensor.show(ros_peer.node.get_clock().now(), is_late=False)
        second = ros_peer.node.create_publisher(Imu, "/imu", 10)
        sensor.repeat(is_late=True)
        ros_peer.node.destroy_publisher(second)
        sensor.repeat(is_late=False)
