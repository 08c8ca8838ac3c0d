"""The robots in physics on real middleware, as the README starts them: hardware fails."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.support.ros import LIMIT, Peer, running
from tests.support.started_examples import start_example

pytest.importorskip("mujoco", reason="the extra 'physics' is not installed")

STANDING = 10
"""Messages in a row, 20 ms apart, with which the robot stands."""


@pytest.mark.ros
@pytest.mark.parametrize(
    ("robot", "fault", "reason"),
    [
        ("frobit", "left_encoder", "stop: a wheel does not turn in spite of thrust"),
        ("frobit", "line", "stop: a wheel or the odometry is silent"),
        ("kobuki", "left_encoder", "stop: it spins"),
        ("kobuki", "runaway", "stop: too fast"),
    ],
)
def test_robot_stands_after_a_fault_of_its_hardware(
    robot: str, fault: str, reason: str, tmp_path: Path, ros_env: dict[str, str], ros_peer: Peer
) -> None:
    """It sets off and drives, is stopped for the reason that the fault is, and truly rests."""
    from nav_msgs.msg import Odometry
    from std_msgs.msg import Bool

    stopped: list[bool] = []
    motions: list[tuple[float, float]] = []

    def on_stop(msg: Any) -> None:
        if msg.data:
            stopped.append(True)

    def on_truth(msg: Any) -> None:
        motions.append((msg.twist.twist.linear.x, msg.twist.twist.angular.z))

    ros_peer.node.create_subscription(Bool, "/safety/stop", on_stop, 10)
    ros_peer.node.create_subscription(Odometry, "/truth", on_truth, 50)
    packages = tmp_path / "packages"
    command = start_example("physics", packages, ros_env, fault, f"{robot}_in_physics")
    with running(command, ros_env) as process:
        ros_peer.until(lambda: any(forward > 0.15 for forward, _ in motions), 2 * LIMIT)
        assert not stopped, "stopped before the fault"
        ros_peer.until(lambda: stopped, 2 * LIMIT)
        at_the_stop = len(motions)
        ros_peer.until(
            lambda: (
                len(motions) > at_the_stop + STANDING
                and all(v < 0.01 and abs(w) < 0.05 for v, w in motions[-STANDING:])
            )
        )
        assert process.stdout is not None
        process.terminate()
        output = process.communicate(timeout=LIMIT)[0]
    assert f"fault: {fault}" in output
    reasons = [line for line in output.splitlines() if "[safety]: stop: " in line]
    assert reason in reasons[0], output
