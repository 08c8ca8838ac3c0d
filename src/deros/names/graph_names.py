"""Resolution of relative and private names in the ROS graph."""

from __future__ import annotations

ANY_ROOT = "/\ue003"
"""Stands for the namespace that a system is started in; it begins the names that depend on it."""


def from_root(name: str) -> str:
    """Return a name with ``/`` in place of :data:`ANY_ROOT`."""
    return name.removeprefix(ANY_ROOT) or "/"


def resolve_name(name: str, namespace: str, node_name: str = "") -> str:
    """Return the graph name of ``name`` in ``namespace``, for the node ``node_name``."""
    if name.startswith("/"):
        return name
    if name == "~" or name.startswith("~/"):
        return f"{resolve_name(node_name, namespace)}{name[1:]}"
    return f"{namespace.rstrip('/')}/{name}"
