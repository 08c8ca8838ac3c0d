"""Checks the other endpoints of a node's topics: publishers and subscriptions."""

from __future__ import annotations

from collections.abc import Callable, Container, Iterator
import itertools
from typing import Any

from rclpy.node import Node
from rclpy.subscription import Subscription
from rclpy.topic_endpoint_info import TopicEndpointInfo

from .endpoints import incompatibility, node_of, shown_node_of

DIED = ' (one that died counts until the middleware forgets it: 20 s with Fast DDS)'


def matched_publishers(node: Node, subscription: Subscription) -> list[TopicEndpointInfo]:
    """Return the publishers that match a subscription, as far as the graph knows."""
    infos = node.get_publishers_info_by_topic(subscription.topic_name)
    return [info for info in infos if not _mismatch(info, subscription)]


def node_names(infos: list[TopicEndpointInfo]) -> str:
    """Return the names of the nodes of publishers, in order."""
    return ', '.join(sorted(map(shown_node_of, infos)))


def unmatched_subscriptions(node: Node, topic: str) -> str:
    """Return the subscriptions of a topic that do not match this node, and why."""
    matched = sum(
        each.get_subscription_count() for each in node.publishers if each.topic_name == topic
    )
    if matched == node.count_subscribers(topic):
        return ''  # counting is cheaper than to ask for the details of all ends
    own = node.get_fully_qualified_name()
    infos = node.get_publishers_info_by_topic(topic)
    offer = next((info for info in infos if node_of(info) == own), None)
    if offer is None:
        return ''
    unmatched: dict[str, None] = {}
    for info in node.get_subscriptions_info_by_topic(topic):
        reason = incompatibility(offer.qos_profile, info.qos_profile)
        if info.topic_type != offer.topic_type:
            reason = f'subscribes to {info.topic_type} on it, which is not published'
        elif reason:
            reason = f'asks for a QoS on it that is not offered: {reason}'
        if reason:
            unmatched[f'{node_of(info) or info.node_name} {reason}'] = None
    return '; '.join(unmatched)


class PublisherCheck:
    """
    Checks the publishers on the topics that a node subscribes to, one topic at a time.

    A publisher of another type or with an incompatible QoS does not match: the middleware does not
    report the first, nor when the second ends. And where one publisher is expected, a second one
    contradicts it, or hides that it has died.
    """

    def __init__(
        self,
        node: Node,
        report: Callable[[str, str], None],
        shared: Container[str] = (),
        alone: Container[str] = (),
    ) -> None:
        """
        Set up; report is called with a topic and its problem, empty if it has none.

        shared are the full names of topics that may have any number of publishers, alone those
        whose values are not known while there are several.
        """
        self.crowded: set[str] = set()  # the topics that had several when they were checked last
        self._node = node
        self._report = report
        self._shared = shared
        found = list(node.subscriptions)
        self._alone = [each for each in found if each.topic_name in alone]
        self._subscriptions = itertools.cycle(
            each for each in found if each.topic_name not in alone
        )

    def check(self) -> None:
        """Check all topics whose values depend on it, and the next one of the others."""
        for subscription in self._alone:
            self._check(subscription)
        following = next(self._subscriptions, None)
        if following is not None:
            self._check(following)

    def _check(self, subscription: Subscription) -> None:
        self._report(subscription.topic_name, '; '.join(self._faults(subscription)))

    def _faults(self, subscription: Subscription) -> Iterator[str]:
        topic = subscription.topic_name
        count = self._node.count_publishers(topic)
        if count <= 1 and count == subscription.get_publisher_count():
            self.crowded.discard(topic)
            return  # counting is cheaper than to ask for the details of all ends
        matched: list[TopicEndpointInfo] = []
        unmatched: dict[str, None] = {}
        for info in self._node.get_publishers_info_by_topic(topic):
            fault = _mismatch(info, subscription)
            if fault:
                unmatched[f'{node_of(info) or info.node_name} {fault}'] = None
            else:
                matched.append(info)
        yield from unmatched
        (self.crowded.add if len(matched) > 1 else self.crowded.discard)(topic)
        if len(matched) > 1 and topic not in self._shared:
            known = [name for name in map(node_of, matched) if name]
            died = DIED if len({*known}) < len(known) else ''
            yield f'{len(matched)} publishers where one is expected: {node_names(matched)}{died}'


def _mismatch(info: TopicEndpointInfo, subscription: Subscription) -> str:
    """Return why a publisher does not match a subscription; empty if it does."""
    kind: Any = subscription.msg_type
    if info.topic_type != f'{kind.__module__.split(".")[0]}/msg/{kind.__name__}':
        return f'publishes {info.topic_type} on it, which is not received'
    reason = incompatibility(info.qos_profile, subscription.qos_profile)
    return f'offers an incompatible QoS on it: {reason}' if reason else ''
