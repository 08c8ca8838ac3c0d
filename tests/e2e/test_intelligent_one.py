"""The smallest robot on the real middleware: as its README says, and without its safety node."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from tests.support.examples import EXAMPLES
from tests.support.ros import Peer, running

README = EXAMPLES / "intelligent_one/README.md"
STARTED = re.compile(r"\] safety started, process (\d+)")


def commands(folder: Path) -> tuple[list[str], list[str]]:
    """Return the README's commands for ``folder``: those that generate, and the one that runs."""
    block = README.read_text().split("```sh\n")[1].split("```")[0]
    *generate, up = block.replace(".demo/intelligent_one", str(folder)).strip().splitlines()
    return generate, up.split()


@pytest.fixture
def packages(tmp_path: Path, ros_env: dict[str, str]) -> tuple[list[str], dict[str, str]]:
    """Generate the packages as the README says; return the command that runs them."""
    environment = dict(ros_env)
    environment["PATH"] = f"{Path(sys.executable).parent}{os.pathsep}{environment['PATH']}"
    generate, up = commands(tmp_path / "packages")
    for line in generate:
        subprocess.run(line, shell=True, check=True, cwd=EXAMPLES.parent, env=environment)
    up[2] = str(EXAMPLES.parent / up[2])
    return [str(Path(sys.executable).with_name(up[0])), *up[1:]], environment


def watch(peer: Peer) -> list[tuple[float, int]]:
    """Collect speeds, with the time in ns at which each was sent."""
    from nav_msgs.msg import Odometry

    speeds: list[tuple[float, int]] = []

    def receive(msg: Any, info: dict[str, int]) -> None:
        speeds.append((msg.twist.twist.linear.x, info["source_timestamp"]))

    peer.node.create_subscription(Odometry, "/odometry", receive, 50)
    return speeds


@pytest.mark.ros
def test_the_robot_is_stopped_after_two_seconds_of_excess_speed(
    packages: tuple[list[str], dict[str, str]], ros_peer: Peer
) -> None:
    """The stop comes 2 s after the first message with the excess speed, and the robot halts."""
    from std_msgs.msg import Bool

    stops: list[int] = []

    def receive(msg: Any, info: dict[str, int]) -> None:
        if msg.data:
            stops.append(info["received_timestamp"])

    ros_peer.node.create_subscription(Bool, "/stop", receive, 10)
    speeds = watch(ros_peer)
    with running(*packages):
        ros_peer.until(lambda: stops)
        ros_peer.until(lambda: speeds[-1][0] == 0.0)
    first = next(sent for speed, sent in speeds if speed > 0.5)
    assert 2.0 <= (stops[0] - first) / 1e9 < 2.3


@pytest.mark.ros
def test_the_robot_halts_when_the_safety_node_is_killed(
    packages: tuple[list[str], dict[str, str]], ros_peer: Peer
) -> None:
    """No heartbeat, no drive: nobody has to say so."""
    command, environment = packages
    speeds = watch(ros_peer)
    with running([*command, "--keep-going"], environment) as robot:
        assert robot.stdout is not None
        started = next(filter(None, map(STARTED.search, robot.stdout)))
        ros_peer.until(lambda: speeds and speeds[-1][0] > 0.0)
        os.kill(int(started[1]), signal.SIGKILL)
        ros_peer.until(lambda: speeds[-1][0] == 0.0)
