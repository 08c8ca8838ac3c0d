"""The monitors that come with deros: of the processor load of a node, and of one transform."""

from __future__ import annotations

from deros.diagnostics import Span
from deros.names.graph_names import resolve_name
from deros.systems.flat import FlatNode

_PACKAGE = "deros_runtime"

WATCHED = "node"
"""The parameter that names the node whose load is measured."""

PARENT, CHILD = "parent", "child"
"""The parameters that name the frames of the transform that is watched."""


def is_load_monitor(node: FlatNode) -> bool:
    """Return whether a node measures the load of another one."""
    return _is(node, "load_monitor")


def is_transform_monitor(node: FlatNode) -> bool:
    """Return whether a node watches a transform."""
    return _is(node, "transform_monitor")


def _is(node: FlatNode, program: str) -> bool:
    described = node.type
    return described is not None and (
        (described.package, described.executable_name) == (_PACKAGE, program)
    )


def watched_node(node: FlatNode) -> str | None:
    """Return the full name of the node whose load a monitor measures; ``None`` if none is named."""
    name = dict(node.parameters).get(WATCHED)
    return resolve_name(name, node.namespace) if isinstance(name, str) and name else None


def watched_transform(node: FlatNode) -> tuple[str, str]:
    """Return the parent and the child that a monitor watches, as tf2 has them; empty if unset."""
    values = dict(node.parameters)
    parent, child = (str(values.get(name, "")).removeprefix("/") for name in (PARENT, CHILD))
    return parent, child


def place_of(node: FlatNode, parameter: str) -> Span:
    """Return where the system sets a parameter of a monitor, else the name of the monitor."""
    settings = (each.value_span for each in node.instance.parameters if each.name == parameter)
    return next(settings, node.instance.name_span)
