"""The clocks of a safety node that asks how old messages are, on real middleware."""

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
input imu = topic /imu timeout 600 sec
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


def test_stamps_are_compared_with_the_clock_that_sets_them(
    node: AbstractContextManager[Any], ros_peer: Peer
) -> None:
    """A message is late by the system's time, with a stamp of zero, and from the future."""
    from rclpy.duration import Duration
    from rclpy.qos import DurabilityPolicy, QoSProfile
    from rclpy.time import Time
    from sensor_msgs.msg import Imu
    from std_msgs.msg import Bool

    states: list[bool] = []
    kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    ros_peer.node.create_subscription(Bool, "/stop", lambda msg: states.append(msg.data), kept)
    publisher = ros_peer.node.create_publisher(Imu, "/imu", 10)

    def show(stamp: Time, expected: bool) -> None:
        msg = Imu()
        msg.header.stamp = stamp.to_msg()
        msg.orientation.w = 1.0
        publisher.publish(msg)
        ros_peer.until(lambda: bool(states) and states[-1] is expected)

    with node:
        ros_peer.until(lambda: publisher.get_subscription_count() == 1 and bool(states))
        assert states[-1] is False
        clock = ros_peer.node.get_clock()
        show(clock.now() - Duration(seconds=1000), expected=True)
        show(clock.now(), expected=False)
        show(Time(), expected=True)
        show(clock.now(), expected=False)
        show(clock.now() + Duration(seconds=1000), expected=True)
