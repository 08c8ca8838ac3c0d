"""The robot that all tests of faults break."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.support.faults import Robot, generate_robot
from tests.support.ros import Peer

RULES = Path(__file__).resolve().parent / "models" / "faulty.deros"


@pytest.fixture(scope="session")
def package(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give the folder of the generated package of the safety node."""
    return generate_robot(RULES, tmp_path_factory.mktemp("faulty"))


@pytest.fixture
def robot(
    package: Path, tmp_path: Path, ros_env: dict[str, str], ros_peer: Peer
) -> Iterator[Robot]:
    """Give the robot under test."""
    robot = Robot(package, tmp_path, ros_env, ros_peer)
    yield robot
    robot.clear()
