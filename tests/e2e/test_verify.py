"""The feeding robot as its system starts it has no difference from its model, and then has one."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.support.cli import Outcome
from tests.support.examples import EXAMPLES, example_module
from tests.support.ros import Peer, running
from tests.support.shell import DEROS, deros_until

SYSTEM = str(EXAMPLES / "feeding_robot/feeding_robot.system")


def _is_clean(outcome: Outcome) -> bool:
    return outcome.code == 0


@pytest.mark.ros
def test_robot_is_as_its_system_says(
    ros_env: dict[str, str], ros_peer: Peer, tmp_path: Path
) -> None:
    """Safety node and gate are no surprise; another commander is, and leaves no trace."""
    from geometry_msgs.msg import Twist

    packages = tmp_path / "packages"
    example_module("feeding_robot", "demonstration.build").build(Path(SYSTEM).parent, packages)
    verify = ("verify", "--live", SYSTEM)
    command = [DEROS, "up", SYSTEM, "--package-path", str(packages)]
    with running(command, ros_env):
        clean = deros_until(ros_env, _is_clean, *verify, "--except", "/test_peer")
        publisher = ros_peer.node.create_publisher(Twist, "/actuators/command", 1)
        wrong = deros_until(ros_env, lambda each: each.code == 1, *verify, "--format", "json")
        ros_peer.node.destroy_publisher(publisher)
        again = deros_until(ros_env, _is_clean, *verify, "--except", "/test_peer")
    assert clean.out == f"{SYSTEM}: 9 nodes, no difference\n"
    assert again.out == clean.out
    found = {(each["kind"], each["node"], each["subject"]) for each in json.loads(wrong.out)}
    assert found == {
        ("extra-node", "/test_peer", ""),
        ("second-publisher", "/test_peer", "publisher /actuators/command"),
    }
