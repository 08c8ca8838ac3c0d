"""The robot of the fault tests in virtual time."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from pathlib import Path

import pytest

pytest.importorskip("rclpy")
pytest.importorskip("diagnostic_msgs.msg")

from tests.support.faults import PythonRobot
from tests.support.virtual_graph import VirtualNode
from tests.support.virtual_robot import VirtualRobot, load

RULES = Path(__file__).resolve().parents[1] / "models/faulty.deros"

Classes = dict[str, Callable[..., VirtualNode]]


@pytest.fixture(scope="session")
def classes(tmp_path_factory: pytest.TempPathFactory) -> Classes:
    """Return the classes of the generated nodes, by their names."""
    folder = tmp_path_factory.mktemp("virtual")
    PythonRobot(RULES, folder)
    return load(folder / "faulty_safety")


@pytest.fixture
def robot(classes: Classes, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> VirtualRobot:
    """Return the robot, without a node yet; locks are in a folder of the test."""
    monkeypatch.setattr(tempfile, "gettempdir", lambda: str(tmp_path))
    return VirtualRobot(classes, tmp_path)


@pytest.fixture
def node(robot: VirtualRobot) -> VirtualNode:
    """Return the running safety node."""
    return robot.start()
