"""The nodes of a running graph and their ends at one moment."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from deros.interfaces.standard_services import OF_EVERY_NODE, OF_MANAGED_NODES
from deros.interfaces.types import InterfaceType
from deros.live.snapshots import End
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
