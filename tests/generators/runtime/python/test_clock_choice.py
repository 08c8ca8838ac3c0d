"""A node keeps the clock that it starts with."""

from __future__ import annotations

import pytest

pytest.importorskip("rclpy")

from deros.generators.runtime.python.deros_runtime.clock_choice import refuse_clock_change
from tests.support.ros import Peer


def test_clock_change_is_rejected_with_a_reason(ros_peer: Peer) -> None:
    """The clock stays; setting the current value, and all other parameters, is allowed."""
    from rclpy.parameter import Parameter

    node = ros_peer.node
    node.declare_parameter("other", 1)
    refuse_clock_change(node)
    (refused,) = node.set_parameters([Parameter("use_sim_time", value=True)])
    assert not refused.successful
    assert "use_sim_time cannot change" in refused.reason
    assert "/clock" not in [subscription.topic_name for subscription in node.subscriptions]
    for allowed in (Parameter("use_sim_time", value=False), Parameter("other", value=2)):
        assert node.set_parameters([allowed])[0].successful
