"""Publishers and subscriptions of other nodes, as the graph of the middleware lists them."""

from __future__ import annotations

from rclpy.qos import qos_check_compatible, QoSCompatibility, QoSProfile
from rclpy.topic_endpoint_info import TopicEndpointInfo


def node_of(info: TopicEndpointInfo) -> str:
    """
    Return the fully qualified name of the node of an endpoint; empty if it is not known yet.

    The middleware may discover a node later than its endpoints.
    """
    if info.node_name in ('', '_NODE_NAME_UNKNOWN_'):
        return ''
    return f'{info.node_namespace.rstrip("/")}/{info.node_name}'


def shown_node_of(info: TopicEndpointInfo) -> str:
    """Return the name of the node of an endpoint for a message, also if it is not known yet."""
    return node_of(info) or 'a node that is not known yet'


def incompatibility(offered: QoSProfile, requested: QoSProfile) -> str:
    """Return why a publisher and a subscription are not connected; empty if they are."""
    fits, reason = qos_check_compatible(offered, requested)
    if fits != QoSCompatibility.ERROR:
        return ''
    return '; '.join(part.strip() for part in reason.replace('ERROR: ', '').split(';') if part)
