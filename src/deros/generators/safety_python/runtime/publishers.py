"""Publishers that a node cannot hear."""

from __future__ import annotations

from collections.abc import Callable
import itertools
from typing import Any

from rclpy.node import Node
from rclpy.qos import qos_check_compatible, QoSCompatibility
from rclpy.subscription import Subscription


class Publishers:
    """
    Looks, one topic at a time, for publishers of another type or of an unfit quality of service.

    The middleware keeps silent about the first, and does not say when the second ends.
    """

    def __init__(self, node: Node, report: Callable[[str, str], None]) -> None:
        """Prepare; report takes a topic and what is wrong with it, empty if nothing is."""
        self._node = node
        self._report = report
        self._subscriptions = itertools.cycle(list(node.subscriptions))

    def look(self) -> None:
        """Look at the next topic."""
        subscription = next(self._subscriptions, None)
        if subscription is not None:
            self._report(subscription.topic_name, '; '.join(self._faults(subscription)))

    def _faults(self, subscription: Subscription) -> list[str]:
        kind: Any = subscription.msg_type
        wanted = f'{kind.__module__.split(".")[0]}/msg/{kind.__name__}'
        found: dict[str, None] = {}
        for info in self._node.get_publishers_info_by_topic(subscription.topic_name):
            name = f'{info.node_namespace.rstrip("/")}/{info.node_name}'
            if info.topic_type != wanted:
                found[f'{name} publishes {info.topic_type} on it, which is not heard'] = None
                continue
            fits, reason = qos_check_compatible(info.qos_profile, subscription.qos_profile)
            if fits == QoSCompatibility.ERROR:
                reason = reason.removeprefix('ERROR: ').strip(' ;')
                found[f'{name} offers a QoS on it that is not heard: {reason}'] = None
        return list(found)
