"""A small graph with an end of each kind, in one process: ``python graph_program.py``.

It prints ``up`` when all of its nodes are there, and runs until it is interrupted.
"""

from __future__ import annotations

import contextlib
import sys
from typing import Any

import rclpy
from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy.action.client import ActionClient
from rclpy.action.server import ActionServer
from rclpy.duration import Duration
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.lifecycle import LifecycleNode
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import (
    DurabilityPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
    qos_profile_sensor_data,
)
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Bool, String
from std_srvs.srv import SetBool, Trigger
from test_msgs.action import Fibonacci

LATCHED = QoSProfile(
    depth=1,
    reliability=ReliabilityPolicy.RELIABLE,
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
)
WATCHED = QoSProfile(
    depth=3,
    deadline=Duration(nanoseconds=250_000_000),
    lifespan=Duration(seconds=2),
    liveliness=LivelinessPolicy.MANUAL_BY_TOPIC,
    liveliness_lease_duration=Duration(nanoseconds=1_500_000_000),
)


def lidar(namespace: str) -> Node:
    """Return a lidar: relative, private and absolute names, parameters with ranges."""
    node = Node("lidar", namespace=namespace, enable_rosout=True)
    node.create_publisher(LaserScan, "scan", qos_profile_sensor_data)
    node.create_publisher(String, "~/health", LATCHED)
    node.create_subscription(Bool, "/stop", lambda _: None, LATCHED)
    node.create_service(SetBool, "~/enable", lambda _, response: response)
    rate = ParameterDescriptor(
        description='Turns a second, "nominal"',
        floating_point_range=[FloatingPointRange(from_value=0.5, to_value=40.0)],
    )
    node.declare_parameter("rate", 10.0 if namespace == "/left" else 12.5, rate)
    frame = ParameterDescriptor(description="Of the scans", read_only=True)
    node.declare_parameter("frame_id", f"{namespace[1:]}_lidar", frame)
    return node


def pilot(namespace: str = "/") -> Node:
    """Return a node with clients, watched topics, and a parameter of each type."""
    node = Node("pilot", namespace=namespace)
    node.create_publisher(Bool, "stop", LATCHED)
    node.create_publisher(Bool, "beat", WATCHED)
    node.create_subscription(LaserScan, "/left/scan", lambda _: None, qos_profile_sensor_data)
    node.create_subscription(LaserScan, "/right/scan", lambda _: None, qos_profile_sensor_data)
    node.create_subscription(String, "/nobody", lambda _: None, 10)
    node.create_client(SetBool, "/left/lidar/enable")
    node.create_client(Trigger, "/elsewhere")
    ActionClient(node, Fibonacci, "/count")
    steps = IntegerRange(from_value=-2, to_value=8, step=2)
    node.declare_parameter("steps", 4, ParameterDescriptor(integer_range=[steps]))
    for name, value in {
        "on": True,
        "text": 'a "text" of ${two}\nlines \\ with a tab\t',
        "bytes": [b"\x00", b"\xff"],
        "bools": [True, False],
        "integers": [-1, 2**40],
        "doubles": [0.1, float("inf"), -1e-7],
        "texts": ["", "x, y"],
        "qos_overrides./beat.publisher.depth": 3,
    }.items():
        node.declare_parameter(name, value)
    node.declare_parameter("no_value", Parameter.Type.INTEGER)
    return node


def counter() -> Node:
    """Return a node with an action."""
    node = Node("counter", namespace="/far/away", start_parameter_services=False)
    ActionServer(node, Fibonacci, "/count", lambda _: Fibonacci.Result())
    return node


def crane() -> LifecycleNode:
    """Return a managed node that is inactive."""
    node = LifecycleNode("crane")
    node.create_lifecycle_publisher(String, "~/load", 10)
    node.trigger_configure()
    return node


def main() -> None:
    """Run the nodes that are named on the command line, or all of them."""
    rclpy.init()
    known: dict[str, Any] = {
        "left": lambda: lidar("/left"),
        "right": lambda: lidar("/right"),
        "pilot": pilot,
        "counter": counter,
        "crane": crane,
    }
    executor = SingleThreadedExecutor()
    nodes = [known[name]() for name in sys.argv[1:] or known]
    for node in nodes:
        executor.add_node(node)
    print("up", flush=True)
    with contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        executor.spin()


if __name__ == "__main__":
    main()
