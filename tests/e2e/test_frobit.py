"""The Frobit on real middleware, as its README starts it: a line fails, and the robot stands."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.support.ros import LIMIT, Peer, running
from tests.support.started_examples import start_example

STANDING = 10
"""Equal states of an encoder, 20 ms apart, after which its wheel stands."""


@pytest.mark.ros
@pytest.mark.parametrize(
    ("fault", "watched"),
    [("left_encoder", "right"), ("right_motor", "left"), ("left_throttle", "left")],
)
def test_robot_stands_after_a_fault_of_its_board(
    fault: str, watched: str, tmp_path: Path, ros_env: dict[str, str], ros_peer: Peer
) -> None:
    """The safety node publishes the stop, and a wheel with a whole encoder comes to rest.

    The throttle that sticks drives on against the gate's zero: only the relay ends it.
    """
    from std_msgs.msg import Bool, Int32

    stopped: list[bool] = []
    ticks: list[int] = []

    def stop(msg: Any) -> None:
        if msg.data:
            stopped.append(True)

    ros_peer.node.create_subscription(Bool, "/safety/stop", stop, 10)
    ros_peer.node.create_subscription(
        Int32, f"/{watched}/encoder", lambda msg: ticks.append(msg.data), 50
    )
    with running(start_example("frobit", tmp_path / "packages", ros_env, fault), ros_env):
        ros_peer.until(lambda: ticks and abs(ticks[-1]) > 180, 2 * LIMIT)  # a turn of the wheel
        assert not stopped, "stopped before the fault"
        ros_peer.until(lambda: stopped, 2 * LIMIT)
        at_the_stop = len(ticks)
        ros_peer.until(
            lambda: len(ticks) > at_the_stop + STANDING and len({*ticks[-STANDING:]}) == 1
        )
