"""Features of C++ nodes only: termination, parameters compared with Python, and components."""

from __future__ import annotations

import signal
import sys
from pathlib import Path
from typing import Any

import pytest

from deros.generators.node.python.generate import generate as generate_python
from deros.generators.output.writer import write
from tests.support.containers import running_container
from tests.support.cpp import overlay
from tests.support.needs import needs
from tests.support.node_packages import MODELS, PICKY, CppPackages, Start, model_of
from tests.support.ros import LIMIT, Peer, running, set_parameter, stop

pytestmark = [pytest.mark.ros, needs("rclcpp")]


@pytest.fixture(scope="module")
def packages(tmp_path_factory: pytest.TempPathFactory) -> CppPackages:
    """Return the built packages."""
    return CppPackages(tmp_path_factory.mktemp("workspace"))


@pytest.fixture
def start(packages: CppPackages, ros_env: dict[str, str]) -> Start:
    """Return a function that starts a program of the packages."""
    return packages.starting(ros_env)


# Parameters ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("package", "node", "model"),
    [
        ("differential_odometry", "odometry_node", MODELS / "odometry_node.rnd"),
        ("fussy", "picky", PICKY),
    ],
)
def test_parameters_match_the_python_node(
    package: str,
    node: str,
    model: Path,
    start: Start,
    ros_peer: Peer,
    ros_env: dict[str, str],
    tmp_path: Path,
) -> None:
    """Names, values and descriptors are the same for both targets."""
    loaded, context = model_of(model)
    write(generate_python(loaded, context, {}), tmp_path)
    script = f"from {package}.{node} import main; main()"
    env = {**ros_env, "PYTHONPATH": str(tmp_path / package)}
    names = [parameter.name for parameter in loaded.parameters]
    with start(package, node):
        cpp = _descriptions(ros_peer, node, names)
    ros_peer.until(lambda: node not in ros_peer.node.get_node_names())
    with running([sys.executable, "-c", script], env):
        python = _descriptions(ros_peer, node, names)
    for parameter in loaded.parameters:
        (descriptor, value), (other, other_value) = (n[parameter.name] for n in (cpp, python))
        assert descriptor == other
        # rclpy cannot declare an empty sequence with a value; rclcpp can.
        assert parameter.default == () or value == other_value


def _descriptions(peer: Peer, node: str, names: list[str]) -> dict[str, Any]:
    """Return descriptor and value of each parameter from the services of a node."""
    from rcl_interfaces.srv import DescribeParameters, GetParameters

    peer.until(lambda: node in peer.node.get_node_names())
    describe = peer.node.create_client(DescribeParameters, f"/{node}/describe_parameters")
    get = peer.node.create_client(GetParameters, f"/{node}/get_parameters")
    descriptors = peer.call(describe, DescribeParameters.Request(names=names)).descriptors
    # One by one: rclpy answers nothing at all if one of the parameters has no value.
    values = [list(peer.call(get, GetParameters.Request(names=[n])).values) for n in names]
    peer.node.destroy_client(describe)
    peer.node.destroy_client(get)
    return dict(zip(names, zip(descriptors, values, strict=True), strict=True))


@pytest.mark.parametrize("value", [float("inf"), float("-inf"), float("nan"), 1.001])
def test_values_outside_a_range_are_rejected(value: float, start: Start, ros_peer: Peer) -> None:
    """Infinity and NaN, which rclcpp's own check accepts, are rejected too."""
    with start("process", "valve"):
        ros_peer.until(lambda: "valve" in ros_peer.node.get_node_names())
        (result,) = set_parameter(ros_peer, "valve", opening=value)
    assert not result.successful


# Termination --------------------------------------------------------------------------------------


def test_invalid_ros_arguments_are_rejected(start: Start) -> None:
    """An invalid remapping ends the program with a reason, without an abort."""
    with start("chat", "talker", "--ros-args", "-r", "nonsense") as node:
        output, _ = node.communicate(timeout=LIMIT)
    assert node.returncode == 1, output
    assert "nonsense" in output


def test_uncaught_exception_ends_the_program(start: Start, ros_peer: Peer) -> None:
    """The exception is printed, and the program fails without an abort."""
    from std_msgs.msg import String

    with start("chat", "listener") as process:
        publisher = ros_peer.node.create_publisher(String, "/chatter", 10)
        ros_peer.until(publisher.get_subscription_count)
        publisher.publish(String(data="noise"))
        output, _ = process.communicate(timeout=LIMIT)
    assert process.returncode == 1, output
    assert "cannot bear noise" in output


# Components ---------------------------------------------------------------------------------------


@needs("ros2")
def test_nodes_are_components(
    packages: CppPackages, ros_env: dict[str, str], ros_peer: Peer
) -> None:
    """Two nodes of one package run in one process, one of them under another name."""
    from std_srvs.srv import Trigger

    with running_container(overlay(packages.install, ros_env), ros_peer) as container:
        container.load("chat", "chat::Talker")
        container.load("chat", "chat::Listener", "--node-name", "ear")
        container.load("differential_odometry", "differential_odometry::OdometryNode")
        ros_peer.until(lambda: {"talker", "ear"} <= set(ros_peer.node.get_node_names()))
        client = ros_peer.node.create_client(Trigger, "/reset")
        assert ros_peer.call(client, Trigger.Request()) == Trigger.Response()
        code, output = stop(container.process, signal.SIGINT)
    assert code == 0, output
