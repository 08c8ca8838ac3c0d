"""The Kobuki on real middleware, as its README starts it: each rule is broken, and it stands."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.support.ros import LIMIT, Peer, running
from tests.support.started_examples import start_example

STANDING = 10
"""Odometry messages in a row, 20 ms apart, with which the robot stands."""


@pytest.mark.ros
@pytest.mark.parametrize(
    ("fault", "reason"),
    [
        ("throttle", "stop: too fast"),
        ("spin", "stop: it spins"),
        ("load", "stop: the pilot needs too much of the processor"),
        ("astray", "stop: outside the yard"),
    ],
)
def test_robot_stands_after_each_fault(
    fault: str, reason: str, tmp_path: Path, ros_env: dict[str, str], ros_peer: Peer
) -> None:
    """The safety node publishes the stop for the reason that the fault is, and the robot rests.

    The pilot that works without end really does: its load is that of the running process.
    """
    from nav_msgs.msg import Odometry
    from std_msgs.msg import Bool, Float64

    stopped: list[bool] = []
    motions: list[tuple[float, float]] = []
    loads: list[float] = []

    def on_stop(msg: Any) -> None:
        if msg.data:
            stopped.append(True)

    def on_odometry(msg: Any) -> None:
        motions.append((msg.twist.twist.linear.x, msg.twist.twist.angular.z))

    node = ros_peer.node
    node.create_subscription(Bool, "/safety/stop", on_stop, 10)
    node.create_subscription(Odometry, "/odometry", on_odometry, 50)
    node.create_subscription(Float64, "/pilot/load", lambda msg: loads.append(msg.data), 10)
    command = start_example("kobuki", tmp_path / "packages", ros_env, fault)
    with running(command, ros_env) as process:
        ros_peer.until(lambda: any(abs(forward) > 0.1 for forward, _ in motions), 2 * LIMIT)
        assert not stopped, "stopped before the fault"
        ros_peer.until(lambda: stopped, 2 * LIMIT)
        at_the_stop = len(motions)
        ros_peer.until(
            lambda: (
                len(motions) > at_the_stop + STANDING
                and all(abs(v) < 0.01 and abs(w) < 0.1 for v, w in motions[-STANDING:])
            )
        )
        assert process.stdout is not None
        process.terminate()
        output = process.communicate(timeout=LIMIT)[0]
    reasons = [line for line in output.splitlines() if "[safety]: stop: " in line]
    assert reason in reasons[0], output
    assert (max(loads[-4:]) > 30.0) == (fault == "load")
