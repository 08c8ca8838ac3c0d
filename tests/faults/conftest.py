"""The robot that all fault tests use."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.support.faults import CppRobot, PythonRobot, Robot, Software
from tests.support.needs import needs
from tests.support.ros import Peer

RULES = Path(__file__).resolve().parent / "models" / "faulty.deros"


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
