"""Resolution of relative and private names in the ROS graph."""

from __future__ import annotations


def resolve_name(name: str, namespace: str, node_name: str = "") -> str:
    """Return the graph name of ``name`` in ``namespace``, for the node ``node_name``."""
    if name.startswith("/"):
        return name
    if name == "~" or name.startswith("~/"):
        return f"{resolve_name(node_name, namespace)}{name[1:]}"
    return f"{namespace.rstrip('/')}/{name}"
