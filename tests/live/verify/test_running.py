"""Running graphs and their models: real nodes, and what goes wrong with them."""

from __future__ import annotations

import signal
import sys
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from deros.live.looks import snapshot
from deros.live.observer import Observer
from deros.live.verify.compare import compare
from deros.live.verify.expectation import Expectation, expectation
from deros.live.verify.texts import line
from deros.systems.flatten import flatten
from tests.support.imported import import_into
from tests.support.ros import LIMIT, Peer, read_line, running, set_parameter
from tests.support.systems import load

PROGRAM = str(Path(__file__).resolve().parents[2] / "support" / "graph_program.py")


@pytest.fixture
def observer(ros_env: dict[str, str], ros_peer: Peer) -> Iterator[Observer]:
    """Give an observer in the domain of the test, started after the peer, which is seen, too."""
    del ros_peer
    with Observer(int(ros_env["ROS_DOMAIN_ID"])) as found:
        yield found


def imported(observer: Observer, folder: Path) -> Expectation:
    """Return what a model says that was made of the graph as it is, without the peer."""
    import_into(folder, snapshot(observer, "*/lidar", timeout=LIMIT))
    system = folder / "robot.system"
    text = system.read_text(encoding="utf-8")
    assert "external topic /left/scan" in text  # nobody reads it
    system.write_text(text.replace("external topic /left/scan", "topic /left/scan"), "utf-8")
    flat = flatten(load(system))
    return expectation(flat, ignored=["/test_peer"])


def until_found(observer: Observer, expected: Expectation, lines: list[str]) -> None:
    """Wait until exactly these differences are found."""
    found: list[str] = []

    def is_found() -> bool:
        seen = snapshot(observer, timeout=LIMIT, equal=2, quiet=0)
        differences = compare(expected, seen).differences
        found[:] = [line(replace(each, span=None)) for each in differences]
        return found == lines

    observer.until(is_found, time.monotonic() + LIMIT)
    assert found == lines


@pytest.mark.ros
def test_each_fault_of_running_nodes_is_found(
    ros_env: dict[str, str], ros_peer: Peer, observer: Observer, tmp_path: Path
) -> None:
    """An extra node, a changed value, a second publisher, a node that ends: only that differs."""
    from rclpy.qos import qos_profile_sensor_data
    from sensor_msgs.msg import LaserScan

    domain = int(ros_env["ROS_DOMAIN_ID"])
    with running([sys.executable, PROGRAM, "left"], ros_env) as left:
        assert read_line(left) == "up\n"
        with running([sys.executable, PROGRAM, "right"], ros_env) as right:
            assert read_line(right) == "up\n"
            expected = imported(observer, tmp_path)
            until_found(observer, expected, [])
            joker = Peer(domain, "joker")
            until_found(observer, expected, ["extra-node /joker"])
            joker.node.create_publisher(LaserScan, "/left/scan", qos_profile_sensor_data)
            second = "second-publisher /joker, publisher /left/scan"
            meant = "/left/lidar alone is meant to publish it"
            until_found(observer, expected, ["extra-node /joker", f"{second}; {meant}"])
            joker.node.create_subscription(LaserScan, "/right/scan", lambda _: None, 1)
            less = "best_effort instead of reliable (/right/lidar)"
            lost = f"not-connected /joker, subscriber /right/scan: {less}"
            until_found(observer, expected, ["extra-node /joker", lost, f"{second}; {meant}"])
            joker.close()
            until_found(observer, expected, [])
            assert set_parameter(ros_peer, "left/lidar", rate=20.0)[0].successful
            wrong = "wrong-value /left/lidar, rate: 20.0 in place of 10.0"
            until_found(observer, expected, [wrong])
            right.send_signal(signal.SIGINT)
            right.wait(LIMIT)
            until_found(observer, expected, ["missing-node /right/lidar", wrong])


@pytest.mark.ros
def test_node_of_the_same_name_is_not_the_same(
    ros_env: dict[str, str], observer: Observer, tmp_path: Path
) -> None:
    """Another program under the name has other types, QoS and ends."""
    from rclpy.context import Context
    from rclpy.node import Node
    from sensor_msgs.msg import LaserScan
    from std_msgs.msg import Bool, String
    from std_srvs.srv import SetBool

    with running([sys.executable, PROGRAM, "left"], ros_env) as left:
        assert read_line(left) == "up\n"
        expected = imported(observer, tmp_path)
    context = Context()
    context.init(domain_id=int(ros_env["ROS_DOMAIN_ID"]))
    other = Node("lidar", namespace="/left", context=context)
    try:
        other.create_publisher(LaserScan, "scan", 10)
        other.create_publisher(String, "~/health", 10)
        other.create_subscription(String, "/stop", lambda _: None, 10)
        other.create_client(SetBool, "~/enable")
        other.create_publisher(Bool, "~/more", 10)
        other.declare_parameter("rate", 10)
        # A publisher may be more reliable than is described. None spins the node, so that of its
        # parameters nothing is known.
        until_found(
            observer,
            expected,
            [
                "missing-end /left/lidar, service /left/lidar/enable: "
                "nothing in place of std_srvs/srv/SetBool",
                "extra-end /left/lidar, client /left/lidar/enable: std_srvs/srv/SetBool",
                "extra-end /left/lidar, publisher /left/lidar/more: std_msgs/msg/Bool",
                "wrong-type /left/lidar, subscriber /stop: "
                "std_msgs/msg/String in place of std_msgs/msg/Bool",
                "wrong-qos /left/lidar, publisher /left/lidar/health: "
                "volatile in place of transient_local",
            ],
        )
    finally:
        other.destroy_node()
        context.try_shutdown()
