"""Readers of the safety node: none is required, any may join, and none has an influence."""

from __future__ import annotations

import functools
from typing import Any

import pytest

from tests.support.faults import NODE, Robot
from tests.support.played import speed
from tests.support.ros import Peer

pytestmark = pytest.mark.ros

OWN = ("/stop", "/halt", "/slow", f"/{NODE}/heartbeat", f"/{NODE}/events", "/diagnostics")
"""Topics published by the node."""


@pytest.mark.slow
def test_node_does_not_read_its_own_topics(robot: Robot) -> None:
    """It subscribes to none of them, so messages on them have no effect."""
    reports = {
        f"/{NODE}/events": "diagnostic_msgs/msg/DiagnosticStatus",
        "/diagnostics": "diagnostic_msgs/msg/DiagnosticArray",
    }
    with robot.safety_node(), robot.sensors(reports) as readers:
        for topic in OWN:
            subscriptions = robot.peer.node.get_subscriptions_info_by_topic(topic)
            assert NODE not in [each.node_name for each in subscriptions]
        for topic in reports:
            readers.play(topic, b"\x00\x01\x00\x00garbage", rate=100.0)
        robot.until_beats()


def test_late_readers_get_the_states(robot: Robot) -> None:
    """Any number of unknown participants get the states published before they joined."""
    from rclpy.qos import DurabilityPolicy, QoSProfile
    from std_msgs.msg import Bool

    kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    with robot.sensors() as sensors:
        # During the test it repeats nothing: a state is published when it changes.
        node = robot.start(NODE, ["publish_freq:=0.001"])
        sensors.match("/speed")
        sensors.play("/speed", speed(2.0))
        robot.until_stopped()
        strangers = [Peer(int(robot.env["ROS_DOMAIN_ID"]), f"reader_{n}") for n in range(5)]
        for stranger in strangers:
            states: list[bool] = []
            receive = functools.partial(_receive, states)
            stranger.node.create_subscription(Bool, "/stop", receive, kept)
            stranger.until(states.copy)
            assert states == [True]
            stranger.close()
        node.end()


def _receive(states: list[bool], message: Any) -> None:
    states.append(message.data)
