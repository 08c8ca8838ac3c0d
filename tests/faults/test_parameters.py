"""Faults of parameters: invalid values, changes by other nodes, clients that disappear."""

from __future__ import annotations

import time

import pytest

from tests.support.faults import NODE, PROMPT, Robot
from tests.support.ros import Peer, set_parameter

pytestmark = pytest.mark.ros

FIXED = {
    "publish_freq": 1.0,
    "startup_grace": 1.0,
    "state_file": "/tmp/another",
    "diagnostics_freq": 5.0,
    "realtime_priority": 1,
    "lock_memory": True,
    "garbage_collection": False,
}
"""All parameters that the node reads at its start, with other values."""


@pytest.mark.parametrize(
    "wrong",
    [
        *("publish_freq:=0.0", "publish_freq:=.nan", "publish_freq:=often"),
        *("startup_grace:=-1.0", "startup_grace:=.inf", "diagnostics_freq:=-1.0"),
        *("realtime_priority:=100", "state_file:=3", "lock_memory:=2"),
    ],
)
def test_invalid_parameter_prevents_the_start(robot: Robot, wrong: str) -> None:
    """The node names it, exits with 1, and has published no heartbeat."""
    node = robot.start(NODE, [wrong])
    robot.until(lambda: node.popen.poll() is not None)
    assert node.popen.returncode == 1
    assert wrong.partition(":")[0] in node.output()
    assert "terminate called" not in node.output()
    assert robot.beats == []


def test_parameters_of_a_running_node_cannot_be_changed(robot: Robot) -> None:
    """Every request is rejected, also to disable a behaviour that is not optional."""
    stranger = Peer(int(robot.env["ROS_DOMAIN_ID"]), "stranger")
    with robot.safety_node():
        for name, value in {**FIXED, "behaviours.racing.enabled": False}.items():
            (result,) = set_parameter(stranger, NODE, **{name: value})
            assert not result.successful, name
            assert result.reason
        robot.until_beats()
    stranger.close()


@pytest.mark.slow
@pytest.mark.parametrize("service", ["set_parameters", "reset"])
def test_vanished_client_delays_the_node_only_briefly(robot: Robot, service: str) -> None:
    """The middleware waits 0.1 s per request for a vanished client; then the node continues."""
    from rcl_interfaces.srv import SetParameters
    from std_srvs.srv import Trigger

    kind = Trigger if service == "reset" else SetParameters
    stranger = Peer(int(robot.env["ROS_DOMAIN_ID"]), "stranger")
    client = stranger.node.create_client(kind, f"/{NODE}/{service}")
    requests = 10
    with robot.safety_node():
        stranger.until(client.service_is_ready)
        for _ in range(requests):
            client.call_async(kind.Request())
        stranger.close()
        now, stalled = time.time(), robot.peer.held_up
        robot.until_alive()
        held_up = robot.beats[-1].received - now - (robot.peer.held_up - stalled)
        print(f"held up for {held_up:.3f} s")
        assert held_up < 0.1 * requests + PROMPT
