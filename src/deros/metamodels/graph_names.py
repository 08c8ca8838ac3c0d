"""Names in the ROS graph: how a relative or private name becomes a full one."""

from __future__ import annotations


def resolve_name(name: str, namespace: str, node_name: str = "") -> str:
    """Return the graph name that ``name`` means under ``namespace``, for the node ``node_name``."""
    if name.startswith("/"):
        return name
    if name == "~" or name.startswith("~/"):
        return f"{resolve_name(node_name, namespace)}{name[1:]}"
    return f"{namespace.rstrip('/')}/{name}"
