"""The nodes that measure the processor load of others, and whose load each measures."""

from __future__ import annotations

from deros.names.graph_names import resolve_name
from deros.systems.flat import FlatNode

_PROGRAM = ("deros_runtime", "load_monitor")
"""Package and executable of the program that measures."""

WATCHED = "node"
"""The parameter that names the node whose load is measured."""


def is_load_monitor(node: FlatNode) -> bool:
    """Return whether a node measures the load of another one."""
    described = node.type
    return described is not None and (described.package, described.executable_name) == _PROGRAM


def watched_node(node: FlatNode) -> str | None:
    """Return the full name of the node whose load a monitor measures; ``None`` if none is named."""
    name = dict(node.parameters).get(WATCHED)
    return resolve_name(name, node.namespace) if isinstance(name, str) and name else None
