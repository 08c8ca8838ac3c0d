"""Which nodes are brought to active when the system is started, and how, or by which others."""

from __future__ import annotations

from collections.abc import Mapping

from deros.models.lifecycle import Autostart, combined
from deros.models.system import NodeInstance
from deros.names.graph_names import resolve_name
from deros.systems.flat import FlatNode


def autostart_of(node: NodeInstance, outer: Autostart | None) -> Autostart | None:
    """Return how a node is brought to active; ``None`` where nothing does so at the start.

    What is written for all nodes of a subsystem or system leaves out those that are not managed,
    and those that another node activates.

    Args:
        node: as written.
        outer: the ``autostart`` of what holds the node.
    """
    if node.autostart is None and (
        node.activated_by is not None or node.type is None or not node.type.lifecycle
    ):
        return None
    return combined(node.autostart, outer)


def manager_of(node: FlatNode, nodes: Mapping[str, FlatNode]) -> FlatNode | None:
    """Return the node that ``activated by`` names: in the node's namespace, or in an outer one.

    Args:
        node: of the system.
        nodes: all of the system, by full name.
    """
    name, namespace = node.instance.activated_by, node.namespace
    while name is not None:
        found = nodes.get(resolve_name(name, namespace))
        if found is not None or namespace in ("/", node.frame):
            return found
        namespace = namespace.rpartition("/")[0] or "/"
    return None
