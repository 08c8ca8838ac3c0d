"""The nodes of a running graph and their ends, as rclpy shows them at one moment."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fnmatch import fnmatchcase
from typing import Any

from deros.interfaces.durations import LONGEST_NS
from deros.interfaces.standard_services import OF_EVERY_NODE, OF_MANAGED_NODES
from deros.interfaces.types import InterfaceType
from deros.live.observer import Observer
from deros.live.snapshots import End
from deros.models.common import QosProfile
from deros.models.node import PortKind
from deros.names.graph_names import resolve_name

LIFECYCLE_STATE = "lifecycle_msgs/srv/GetState"
PARAMETER_LIST = "rcl_interfaces/srv/ListParameters"

_EVERYWHERE = frozenset({"/rosout", "/parameter_events"})
_EVERYWHERE_TYPES = frozenset({"rcl_interfaces/msg/Log", "rcl_interfaces/msg/ParameterEvent"})
_OF_CONTAINERS = {
    name: InterfaceType("composition_interfaces", "srv", kind)
    for name, kind in {
        "_container/load_node": "LoadNode",
        "_container/unload_node": "UnloadNode",
        "_container/list_nodes": "ListNodes",
    }.items()
}
_OF_LOGGERS = {
    name: InterfaceType("rcl_interfaces", "srv", kind)
    for name, kind in {
        "get_logger_levels": "GetLoggerLevels",
        "set_logger_levels": "SetLoggerLevels",
    }.items()
}
OF_NODES = {**OF_EVERY_NODE, **OF_MANAGED_NODES, **_OF_CONTAINERS, **_OF_LOGGERS}
"""Services that a node has because it is one, or because it is managed, or a container."""

_GOALS = "/_action/send_goal"
_ACTIONS = {PortKind.SERVICE: PortKind.ACTION, PortKind.CLIENT: PortKind.ACTION_CLIENT}

_NO_NAME = "_NODE_NAME_UNKNOWN_"
"""What rmw reports of an end whose node is not yet known."""


@dataclass(frozen=True, slots=True)
class NodeEnds:
    """A node and its ends at one moment.

    Attributes:
        doubtful: what of it has no single answer.
        count: how many nodes have that name.
    """

    full_name: str
    ends: tuple[End, ...]
    services: tuple[tuple[str, str], ...]
    doubtful: tuple[str, ...]
    count: int = 1

    def offers(self, service: str, of_type: str) -> bool:
        """Return whether it offers one of the services that nodes have, such as ``~/get_state``."""
        return (resolve_name(service, "/", self.full_name), of_type) in self.services

    @property
    def is_managed(self) -> bool:
        """Whether it has the services of a managed node."""
        return self.offers("~/get_state", LIFECYCLE_STATE)

    @property
    def is_container(self) -> bool:
        """Whether it loads components."""
        return self.offers("~/_container/list_nodes", "composition_interfaces/srv/ListNodes")


@dataclass(frozen=True, slots=True)
class Graph:
    """All nodes but hidden ones, and whether the ends of each node are known by now."""

    nodes: tuple[NodeEnds, ...]
    complete: bool = True


def graph_now(observer: Observer, pattern: str = "*", *, with_qos: bool = True) -> Graph:
    """Return the nodes whose full names match a pattern of the shell, with their ends.

    Without QoS, that takes an eighth of the time.

    Nodes whose names begin with ``_`` are hidden (ROS 2 design, "Topic and Service name mapping");
    the observer is one, as are the daemon and the commands of ``ros2``.
    """
    known = observer.node.get_node_names_and_namespaces()
    names = [(name, space) for name, space in known if not name.startswith("_")]
    names = [each for each in names if fnmatchcase(resolve_name(*each), pattern)]
    qos = _Qos(observer, wanted=with_qos)
    count: dict[str, int] = {}
    for name, space in names:
        full = resolve_name(name, space)
        count[full] = count.get(full, 0) + 1
    nodes = [
        _node(observer, name, space, qos, count[resolve_name(name, space)])
        for name, space in sorted(set(names), key=lambda each: resolve_name(*each))
    ]
    found = tuple(each for each in nodes if each is not None)
    return Graph(found, qos.complete and len(found) == len(nodes))


def _node(observer: Observer, name: str, space: str, qos: _Qos, count: int) -> NodeEnds | None:
    """Return a node with its ends; ``None`` if it has left in the meantime."""
    from rclpy.impl.implementation_singleton import rclpy_implementation as implementation

    full = resolve_name(name, space)
    of = observer.node
    readers = {
        PortKind.PUBLISHER: of.get_publisher_names_and_types_by_node,
        PortKind.SUBSCRIPTION: of.get_subscriber_names_and_types_by_node,
        PortKind.SERVICE: of.get_service_names_and_types_by_node,
        PortKind.CLIENT: of.get_client_names_and_types_by_node,
    }
    try:
        seen = [
            _action(kind, end, types)
            for kind, read in readers.items()
            for end, types in read(name, space)
        ]
    except implementation.RCLError:
        return None
    services = tuple(
        (end, each) for kind, end, types in seen if kind is PortKind.SERVICE for each in types
    )
    found = NodeEnds(full, (), services, ())
    doubtful: list[str] = []
    ends: list[End] = []
    for kind, end, types in seen:
        if belongs_to_nodes(kind, end, types, found):
            continue
        if len(types) > 1:
            doubtful.append(f"{full} has {kind.word} {end} of {len(types)} types: {listed(types)}")
        profiles = qos.of(kind, end, name, space)
        if len(profiles) > 1:
            doubtful.append(f"{full} has {kind.word} {end} with {len(profiles)} kinds of QoS")
        ends.append(End(kind, end, min(types), profiles[0] if profiles else None))
    ends.sort(key=lambda each: (list(PortKind).index(each.kind), each.name))
    return NodeEnds(full, tuple(ends), services, tuple(doubtful), count)


def _action(kind: PortKind, name: str, types: list[str]) -> tuple[PortKind, str, list[str]]:
    """Return the action whose goals a service or a client is for; what else there is as it is.

    Source: ROS 2 design, "Actions", section "Topics and Services Used".
    """
    if kind not in _ACTIONS or not name.endswith(_GOALS):
        return kind, name, types
    return _ACTIONS[kind], name.removesuffix(_GOALS), [t.removesuffix("_SendGoal") for t in types]


def listed(words: Iterable[str]) -> str:
    """Return words in a row, sorted."""
    return ", ".join(sorted(words))


def belongs_to_nodes(kind: PortKind, name: str, types: list[str], node: NodeEnds) -> bool:
    """Return whether an end is one that a node has because it is a node, managed or a container."""
    if "/_action/" in name:
        return True
    if kind is PortKind.SERVICE:
        return str(OF_NODES.get(name.removeprefix(f"{node.full_name}/"))) in types
    event = f"{node.full_name}/transition_event"
    if kind is PortKind.PUBLISHER and node.is_managed and name == event:
        return True
    topics = (PortKind.PUBLISHER, PortKind.SUBSCRIPTION)
    return kind in topics and name in _EVERYWHERE and not _EVERYWHERE_TYPES.isdisjoint(types)


class _Qos:
    """The profiles of the ends of topics, each topic read once.

    Attributes:
        complete: whether the node of each end that was read is known.
    """

    def __init__(self, observer: Observer, *, wanted: bool) -> None:
        self._wanted = wanted
        self._node = observer.node
        self._known: dict[tuple[PortKind, str], dict[tuple[str, str], list[QosProfile]]] = {}
        self.complete = True

    def of(self, kind: PortKind, topic: str, name: str, space: str) -> list[QosProfile]:
        """Return the different profiles of a node's ends of a topic."""
        read = {
            PortKind.PUBLISHER: self._node.get_publishers_info_by_topic,
            PortKind.SUBSCRIPTION: self._node.get_subscriptions_info_by_topic,
        }.get(kind)
        if read is None or not self._wanted:
            return []
        if (kind, topic) not in self._known:
            profiles: dict[tuple[str, str], list[QosProfile]] = {}
            for info in read(topic):
                self.complete &= info.node_name != _NO_NAME
                own = profiles.setdefault((info.node_name, info.node_namespace), [])
                if (profile := _profile(info.qos_profile)) not in own:
                    own.append(profile)
            self._known[kind, topic] = profiles
        profiles_of_node = self._known[kind, topic].get((name, space), [])
        self.complete &= bool(profiles_of_node)
        return sorted(profiles_of_node, key=repr)


def _profile(seen: Any) -> QosProfile:
    """Return what rclpy reports of an end; policies that have their usual value are not stated."""
    return QosProfile(
        reliability=seen.reliability.name.lower(),
        durability=seen.durability.name.lower(),
        deadline_ns=_finite(seen.deadline),
        lifespan_ns=_finite(seen.lifespan),
        liveliness=_unusual(seen.liveliness.name.lower(), seen.liveliness_lease_duration),
        lease_ns=_finite(seen.liveliness_lease_duration),
    )


def _unusual(liveliness: str, lease: Any) -> str | None:
    return None if liveliness == "automatic" and _finite(lease) is None else liveliness


def _finite(duration: Any) -> int | None:
    nanoseconds = int(duration.nanoseconds)
    return nanoseconds if 0 < nanoseconds < LONGEST_NS else None


def changed(before: Graph, after: Graph) -> Iterator[str]:
    """Yield what differs between two looks: nodes that came or went, and ends of others."""
    old = {each.full_name: each for each in before.nodes}
    new = {each.full_name: each for each in after.nodes}
    for name in sorted(old.keys() ^ new.keys()):
        yield f"{name} {'came' if name in new else 'left'}"
    for name in sorted(old.keys() & new.keys()):
        ends = set(old[name].ends) ^ set(new[name].ends)
        if ends:
            yield f"{listed({each.name for each in ends})} of {name}"
