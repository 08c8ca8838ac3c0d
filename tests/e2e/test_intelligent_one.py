"""The smallest robot on real middleware: as in its README, and without its safety node."""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import sys
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

from tests.support.cpp import colcon_build, python_overlay
from tests.support.examples import EXAMPLES
from tests.support.needs import needs
from tests.support.policies import await_policy, policy_text
from tests.support.ros import Peer, running
from tests.support.systems import load

README = EXAMPLES / "intelligent_one/README.md"
CYCLE = 20_000_000
"""The robot's cycle, in ns."""

STARTED = re.compile(r"\] safety started, process (\d+)")


def commands(folder: Path) -> tuple[list[str], list[str]]:
    """Return the README's commands for ``folder``: those that generate, and the one that runs."""
    block = README.read_text().split("```sh\n")[1].split("```")[0]
    *generate, up = block.replace(".demo/intelligent_one", str(folder)).strip().splitlines()
    return generate, up.split()


@pytest.fixture(params=["python", pytest.param("cpp", marks=needs("rclcpp"))])
def packages(
    request: pytest.FixtureRequest, tmp_path: Path, ros_env: dict[str, str]
) -> tuple[list[str], dict[str, str]]:
    """Generate the packages as in the README; return the command that runs them.

    For C++ the safety node and the gate are built, and one more word in the system selects each.
    """
    environment = dict(ros_env)
    environment["PATH"] = f"{Path(sys.executable).parent}{os.pathsep}{environment['PATH']}"
    generate, up = commands(tmp_path / "packages")
    for line in generate:
        subprocess.run(line, shell=True, check=True, cwd=EXAMPLES.parent, env=environment)
    up[2] = str(EXAMPLES.parent / up[2])
    if request.param == "cpp":
        subprocess.run(
            [*generate[-1].replace("python -o", "cpp -o").split()[:-1], str(tmp_path / "cpp")],
            check=True,
            cwd=EXAMPLES.parent,
            env=environment,
        )
        install = colcon_build(tmp_path / "cpp")
        up[2] = str(in_cpp(Path(up[2]), tmp_path))
        up += ["--package-path", str(install)]
        environment = python_overlay(install, environment)
    return [str(Path(sys.executable).with_name(up[0])), *up[1:]], environment


def in_cpp(system: Path, folder: Path) -> Path:
    """Copy the model with safety node and gate in C++; return the path of the system."""
    for model in (*system.parent.glob("*.rnd"), *system.parent.glob("*.deros")):
        shutil.copy(model, folder)
    text = system.read_text(encoding="utf-8")
    rules = 'safety "intelligent_one.deros"'
    assert text.count(rules) == 1
    path = folder / system.name
    path.write_text(text.replace(rules, f"{rules} target cpp"), encoding="utf-8")
    return path


@dataclass(frozen=True)
class Report:
    """A message of the robot's odometry: speed in m/s, and times of sending and receipt in ns."""

    speed: float
    sent: int
    received: int


def watch(peer: Peer) -> list[Report]:
    """Collect the odometry of the robot."""
    from nav_msgs.msg import Odometry

    reports: list[Report] = []

    def receive(msg: Any, info: dict[str, int]) -> None:
        speed = msg.twist.twist.linear.x
        reports.append(Report(speed, info["source_timestamp"], info["received_timestamp"]))

    peer.node.create_subscription(Odometry, "/odometry", receive, 50)
    return reports


def lateness(reports: list[Report]) -> int:
    """Return by how many ns the machine itself was late: in a cycle and in the delivery."""
    cycles = [after.sent - before.sent - CYCLE for before, after in pairwise(reports)]
    deliveries = [report.received - report.sent for report in reports]
    return max(max(cycles), 0) + max(deliveries)


@pytest.mark.ros
def test_robot_stops_after_two_seconds_of_overspeed(
    packages: tuple[list[str], dict[str, str]], ros_peer: Peer
) -> None:
    """The stop comes 2 s after the first message with excess speed, and the robot halts."""
    from std_msgs.msg import Bool

    stops: list[int] = []

    def receive(msg: Any, info: dict[str, int]) -> None:
        if msg.data:
            stops.append(info["received_timestamp"])

    ros_peer.node.create_subscription(Bool, "/stop", receive, 10)
    reports = watch(ros_peer)
    with running(*packages):
        ros_peer.until(lambda: stops)
        assert any(report.speed > 0.5 for report in reports), "stopped without excess speed"
        ros_peer.until(lambda: reports[-1].speed == 0.0)
    first = next(report.sent for report in reports if report.speed > 0.5)
    meanwhile = [report for report in reports if first <= report.received <= stops[0]]
    assert 0 <= stops[0] - first - 2_000_000_000 < 300_000_000 + lateness(meanwhile)


@pytest.mark.ros
def test_graph_is_what_the_policy_allows(
    packages: tuple[list[str], dict[str, str]], ros_peer: Peer
) -> None:
    """No node does more than its policy for SROS2 says, and none may do more than it does."""
    command, _ = packages
    policy = policy_text(load(Path(command[2])))
    with running(*packages):
        await_policy(policy, ros_peer, "/safety", "/command_gate")


@pytest.mark.slow
@pytest.mark.ros
def test_robot_halts_when_the_safety_node_is_killed(
    packages: tuple[list[str], dict[str, str]], ros_peer: Peer
) -> None:
    """The missing heartbeat is enough."""
    command, environment = packages
    reports = watch(ros_peer)
    with running([*command, "--keep-going"], environment) as robot:
        assert robot.stdout is not None
        started = next(filter(None, map(STARTED.search, robot.stdout)))
        ros_peer.until(lambda: reports and reports[-1].speed > 0.0)
        os.kill(int(started[1]), signal.SIGKILL)
        ros_peer.until(lambda: reports[-1].speed == 0.0)
