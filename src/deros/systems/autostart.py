"""Which nodes are brought to active when the system is started, and how."""

from __future__ import annotations

from deros.models.lifecycle import Autostart, combined
from deros.models.system import NodeInstance


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
