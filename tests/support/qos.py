"""Policies of models as profiles of rclpy."""

from __future__ import annotations

from typing import Any

from deros.models.qos import Policies


def profile(each: Policies) -> Any:
    """Return the profile of rclpy."""
    from rclpy.duration import Duration
    from rclpy.qos import DurabilityPolicy, LivelinessPolicy, QoSProfile, ReliabilityPolicy

    return QoSProfile(
        depth=1,
        reliability=ReliabilityPolicy[each.reliability.upper()],
        durability=DurabilityPolicy[each.durability.upper()],
        liveliness=LivelinessPolicy[each.liveliness.upper()],
        deadline=Duration(nanoseconds=each.deadline or 0),
        liveliness_lease_duration=Duration(nanoseconds=each.lease or 0),
    )
