"""Reports endpoints of other nodes whose QoS does not match."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import qos_policy_name_from_kind

from .endpoints import incompatibility, shown_node_of


class QosReport:
    """
    Logs an error when an endpoint of another node appears whose QoS does not match.

    No message ever passes between the two. The middleware reports one policy; the graph has the
    node, and all policies.
    """

    def __init__(self, node: Node) -> None:
        """Set up the callbacks to create publishers and subscriptions with."""
        self._node = node
        self._known: set[str] = set()
        self.of_publishers = PublisherEventCallbacks(incompatible_qos=self._on_incompatible)
        self.of_subscriptions = SubscriptionEventCallbacks(incompatible_qos=self._on_incompatible)

    def _on_incompatible(self, event: Any) -> None:
        found = {*self._receivers(), *self._senders()}
        policy = qos_policy_name_from_kind(event.last_policy_kind)
        unknown = f'an end of another node does not match in the QoS policy {policy}'
        for text in sorted(found - self._known) or [unknown]:
            self._node.get_logger().error(text)
        self._known = found

    def _receivers(self) -> Iterable[str]:
        for publisher in self._node.publishers:
            for info in self._node.get_subscriptions_info_by_topic(publisher.topic_name):
                reason = incompatibility(publisher.qos_profile, info.qos_profile)
                if reason:
                    other = shown_node_of(info)
                    yield f'{publisher.topic_name} does not reach {other}: {reason}'

    def _senders(self) -> Iterable[str]:
        for subscription in self._node.subscriptions:
            for info in self._node.get_publishers_info_by_topic(subscription.topic_name):
                reason = incompatibility(info.qos_profile, subscription.qos_profile)
                if reason:
                    other = shown_node_of(info)
                    yield f'{subscription.topic_name} is not received from {other}: {reason}'
