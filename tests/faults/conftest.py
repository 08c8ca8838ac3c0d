"""The robot that all fault tests use."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.support.faults import CppRobot, PythonRobot, Robot, Software
from tests.support.loader import Loader
from tests.support.needs import needs
from tests.support.rig import CppNodes, PythonNodes
from tests.support.rig import Software as Nodes
from tests.support.ros import Peer

RULES = Path(__file__).resolve().parent / "models" / "faulty.deros"
LOADER_RULES = RULES.parent / "loader" / "loader.deros"


@pytest.fixture(scope="session", params=["python", pytest.param("cpp", marks=needs("rclcpp"))])
def software(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Software:
    """Return the generated safety node and gate, in each language."""
    robot_class = PythonRobot if request.param == "python" else CppRobot
    return robot_class(RULES, tmp_path_factory.mktemp("faulty"))


@pytest.fixture
def robot(
    software: Software, tmp_path: Path, ros_env: dict[str, str], ros_peer: Peer
) -> Iterator[Robot]:
    """Return the robot under test."""
    robot = Robot(software, tmp_path, ros_env, ros_peer)
    yield robot
    robot.clear()


@pytest.fixture(scope="session", params=["python", pytest.param("cpp", marks=needs("rclcpp"))])
def loader_nodes(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Nodes:
    """Return the generated nodes of the loader, in each language."""
    nodes_class = PythonNodes if request.param == "python" else CppNodes
    return nodes_class(LOADER_RULES, tmp_path_factory.mktemp("loader"))


@pytest.fixture
def loader(loader_nodes: Nodes, tmp_path: Path, ros_env: dict[str, str], ros_peer: Peer) -> Loader:
    """Return the loader under test, which does not run yet."""
    return Loader(loader_nodes, tmp_path, ros_env, ros_peer)
