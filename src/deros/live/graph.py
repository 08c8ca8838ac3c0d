"""What the graph shows of safety nodes and gates."""

from __future__ import annotations

from collections.abc import Collection

from deros.interfaces.types import InterfaceType
from deros.live.observer import Observer
from deros.names import names
from deros.names.graph_names import resolve_name
from deros.systems.safety_nodes import DIAGNOSTICS_TYPE, HEARTBEAT, HEARTBEAT_TYPE


def topics_of_diagnostics(observer: Observer) -> set[str]:
    """Return the topics with diagnostics: the common one, and private ones of safety nodes."""
    return _topics(observer, DIAGNOSTICS_TYPE)


def reporting_nodes(observer: Observer) -> set[str]:
    """Return the full names of the nodes that publish diagnostics."""
    return {
        resolve_name(end.node_name, end.node_namespace)
        for topic in topics_of_diagnostics(observer)
        for end in observer.node.get_publishers_info_by_topic(topic)
    }


def nodes_of_heartbeats(observer: Observer) -> set[str]:
    """Return the nodes that publish a heartbeat of a safety node, or subscribe to one."""
    node = observer.node
    ending = HEARTBEAT.removeprefix("~")
    return {
        resolve_name(end.node_name, end.node_namespace)
        for topic in _topics(observer, HEARTBEAT_TYPE)
        if topic.endswith(ending)
        for ends in (node.get_publishers_info_by_topic, node.get_subscriptions_info_by_topic)
        for end in ends(topic)
    }


def did_you_mean(node: str, known: Collection[str]) -> str:
    """Return the hint that names those of the known nodes that may be meant."""
    last = node.rpartition("/")[2]
    same = sorted(each for each in known if each.rpartition("/")[2] == last and each != node)
    return names.did_you_mean(same or names.near(node, known))


def _topics(observer: Observer, of_type: InterfaceType) -> set[str]:
    known = observer.node.get_topic_names_and_types()
    return {topic for topic, types in known if str(of_type) in types}
