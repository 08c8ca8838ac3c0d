"""Which container each node of a system is loaded into."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from deros.names.graph_names import from_root, resolve_name
from deros.systems.flat import FlatNode


def in_containers(nodes: Sequence[FlatNode]) -> tuple[FlatNode, ...]:
    """Return the nodes with the full names of their containers, as far as these are known.

    A plain name is that of a container in the node's subsystem, or in one around it, whatever its
    namespace is. Any other relative name is looked for in the node's namespace and in outer ones;
    an absolute name may be that of a container elsewhere.
    """
    if all(node.instance.into is None for node in nodes):
        return tuple(nodes)
    by_name: dict[str, FlatNode] = {}
    by_place: dict[object, str] = {}
    for node in nodes:
        if node.instance.is_container:
            by_name.setdefault(node.full_name, node)
            by_place[node.path, node.instance.name_span] = node.full_name
            by_place.setdefault((node.frame, node.path, node.instance.name), node.full_name)
    return tuple(
        node
        if node.instance.into is None
        else replace(node, container=_container(node, by_name, by_place))
        for node in nodes
    )


def _container(
    node: FlatNode, by_name: dict[str, FlatNode], by_place: dict[object, str]
) -> str | None:
    into = node.instance.into
    assert into is not None
    if into.braces is not None:
        return by_place.get((node.path, into.braces))
    name, namespace = into.container, node.namespace
    if name.startswith("/"):
        return next((full for full in by_name if from_root(full) == name), name)
    for depth in range(len(node.path), -1, -1):
        beside = by_place.get((node.frame, node.path[:depth], name))
        if beside is not None:
            return beside
    while True:
        found = by_name.get(resolve_name(name, namespace))
        if found is not None:
            return found.full_name
        if namespace in ("/", node.frame):
            return None
        namespace = namespace.rpartition("/")[0] or "/"
