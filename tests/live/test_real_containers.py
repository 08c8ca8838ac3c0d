"""The containers of ROS 2, in C++, with components in C++: imported and verified as they run."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest

from deros.systems.flatten import flatten
from tests.support import boxed
from tests.support.checks import checked
from tests.support.cli import Outcome
from tests.support.containers import Container, running_container
from tests.support.cpp import overlay, program
from tests.support.needs import needs
from tests.support.ros import Peer, running
from tests.support.shell import deros_at, deros_until
from tests.support.systems import load

pytestmark = [pytest.mark.ros, pytest.mark.slow, needs("rclcpp"), needs("ros2")]

KINDS = ("component_container", "component_container_mt", "component_container_isolated")
PEER = "  /test_peer has no parameter services: its parameters are not known"
"""What is said of the node of the test itself."""


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return an install folder with the components."""
    return boxed.installed(tmp_path_factory.mktemp("workspace"))


def fill(container: Container) -> str:
    """Load two cameras and a managed node; return the number of the first camera."""
    camera = (boxed.PACKAGE, f"{boxed.PACKAGE}::Camera")
    number = container.load(*camera, "--node-name", "left", "--parameter", "label:=l")
    placed = ("--node-name", "right", "--node-namespace", "/far")
    container.load(*camera, *placed, "--parameter", "use_sim_time:=true")
    container.load(boxed.PACKAGE, f"{boxed.PACKAGE}::Sink")
    return number


def listed(lines: Sequence[str], title: str) -> list[str]:
    """Return the indented lines below a title."""
    found = lines[lines.index(title) + 1 :]
    return [each for each in found if each.startswith("  ")]


def verdict(outcome: Outcome) -> list[str]:
    """Return what differs, without places in the model, and the last line."""
    lines = outcome.out.splitlines()
    said = [each for each in lines if not each.startswith("  ") and each != "not compared:"]
    return [each.partition("  (")[0] for each in said]


@pytest.mark.parametrize("kind", KINDS)
def test_containers_of_ros_are_imported_and_verified(
    kind: str, installed: Path, ros_env: dict[str, str], ros_peer: Peer, tmp_path: Path
) -> None:
    """What was imported is so, with what people set alone, until a node is another process."""
    system = tmp_path / "robot.system"
    env = overlay(installed, ros_env)
    with running_container(env, ros_peer, kind) as container:
        number = fill(container)
        outcome = deros_at(ros_env, "import", "--live", "-o", str(tmp_path))
        same = deros_at(ros_env, "verify", "--live", str(system))
        container.unload(number)
        missing = deros_until(
            ros_env, lambda found: found.code == 1, "verify", "--live", str(system)
        )
        command = [program(installed, boxed.PACKAGE, "camera"), "--ros-args", "-r", "__node:=left"]
        with running([*command, "-p", "label:=l"], env):
            ros_peer.until(lambda: "left" in ros_peer.node.get_node_names())
            moved = deros_at(ros_env, "verify", "--live", str(system))

    # Nothing is left out but of the node of the test.
    assert listed(outcome.out.splitlines(), "not in the models:") == [PEER]
    nodes = {each.full_name: each for each in flatten(load(system)).nodes}
    assert {name: each.container for name, each in nodes.items()} == {
        "/box": None,
        "/far/right": "/box",
        "/left": "/box",
        "/sink": "/box",
        "/test_peer": None,
    }
    assert {name: dict(each.parameters) for name, each in nodes.items()} == {
        "/box": {},
        "/far/right": {"label": "none", "rate": 1.0, "use_sim_time": True},
        "/left": {"label": "l", "rate": 1.0},
        "/sink": {},
        "/test_peer": {},
    }
    assert nodes["/far/right"].type is nodes["/left"].type
    kinds = {name: each.type for name, each in nodes.items() if each.container is not None}
    declared = {
        name: ([each.name for each in kind.parameters], kind.lifecycle)
        for name, kind in kinds.items()
        if kind is not None
    }
    assert declared == {
        "/far/right": (["label", "rate"], False),
        "/left": (["label", "rate"], False),
        "/sink": ([], True),
    }
    assert [each.severity.value for each in checked(system) if each.severity.value == "error"] == []

    compared = f"{system}: 5 nodes, "
    assert (same.code, verdict(same)) == (0, [f"{compared}no difference"])
    assert listed(same.out.splitlines(), "not compared:") == [PEER]
    assert verdict(missing) == ["missing-node /left", f"{compared}1 difference"]
    assert verdict(moved) == [
        "wrong-container /left: a process of its own in place of /box",
        f"{compared}1 difference",
    ]
