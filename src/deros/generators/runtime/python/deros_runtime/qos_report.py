"""Reports endpoints of other nodes whose QoS does not match."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import (
    qos_check_compatible,
    qos_policy_name_from_kind,
    QoSCompatibility,
    QoSProfile,
)
from rclpy.topic_endpoint_info import TopicEndpointInfo

UNNAMED = '_NODE_NAME_UNKNOWN_'  # the name of a node that the middleware has not discovered yet


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
        found = {*self._unserved(), *self._unheard()}
        policy = qos_policy_name_from_kind(event.last_policy_kind)
        unknown = f'an end of another node does not match in the QoS policy {policy}'
        for text in sorted(found - self._known) or [unknown]:
            self._node.get_logger().error(text)
        self._known = found

    def _unserved(self) -> Iterable[str]:
        for publisher in self._node.publishers:
            for info in self._node.get_subscriptions_info_by_topic(publisher.topic_name):
                reason = _incompatible(publisher.qos_profile, info.qos_profile)
                if reason:
                    yield f'{publisher.topic_name} does not reach {_node_of(info)}: {reason}'

    def _unheard(self) -> Iterable[str]:
        for subscription in self._node.subscriptions:
            for info in self._node.get_publishers_info_by_topic(subscription.topic_name):
                reason = _incompatible(info.qos_profile, subscription.qos_profile)
                if reason:
                    yield f'{subscription.topic_name} is not heard from {_node_of(info)}: {reason}'


def _node_of(info: TopicEndpointInfo) -> str:
    """Return the name of a node, which the middleware may learn later than that of its topics."""
    if info.node_name in ('', UNNAMED):
        return 'a node that is not known yet'
    return f'{info.node_namespace.rstrip("/")}/{info.node_name}'


def _incompatible(offered: QoSProfile, requested: QoSProfile) -> str:
    """Return why the middleware does not connect a publisher with a subscription."""
    fits, reason = qos_check_compatible(offered, requested)
    if fits != QoSCompatibility.ERROR:
        return ''
    return '; '.join(part.strip() for part in reason.replace('ERROR: ', '').split(';') if part)
