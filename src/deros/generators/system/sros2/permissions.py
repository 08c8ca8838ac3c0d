"""What a node needs to be allowed: its ports as wired, and what every ROS 2 node opens by itself.

The names are those on the wire, so remappings have been applied. Sources of what stands in no node
description, all of Jazzy: ``rclcpp/src/rclcpp/node.cpp`` and ``time_source.cpp``,
``rclpy/rclpy/node.py`` and ``time_source.py``, ``rcl_lifecycle/src/com_interface.c``.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

from deros.interfaces.standard_services import OF_EVERY_NODE, OF_MANAGED_NODES
from deros.models.node import PortKind
from deros.names.graph_names import resolve_name
from deros.systems.flat import FlatNode

Right = tuple[
    Literal["topic", "service", "action"],
    Literal["publish", "subscribe", "reply", "request", "call", "execute"],
]
"""A kind of name and what may be done with it, in the words of a policy."""

PUBLISH: Right = ("topic", "publish")
SUBSCRIBE: Right = ("topic", "subscribe")
REPLY: Right = ("service", "reply")
REQUEST: Right = ("service", "request")
EXECUTE: Right = ("action", "execute")
CALL: Right = ("action", "call")

RIGHTS = (PUBLISH, SUBSCRIBE, REPLY, REQUEST, EXECUTE, CALL)
"""All rights, in the order in which a policy lists them."""

_BY_KIND = {
    PortKind.PUBLISHER: PUBLISH,
    PortKind.SUBSCRIPTION: SUBSCRIBE,
    PortKind.SERVICE: REPLY,
    PortKind.CLIENT: REQUEST,
    PortKind.ACTION: EXECUTE,
    PortKind.ACTION_CLIENT: CALL,
}
_TYPE_DESCRIPTION = "get_type_description"
_MANAGER_SERVICES = ("change_state", "get_state")

Permission = tuple[Right, str]
"""A right and the full name that it is for."""


def permissions_of(node: FlatNode) -> Iterator[Permission]:
    """Yield what a node needs to be allowed, in no certain order.

    Args:
        node: for certain values of all arguments.
    """
    for port in node.ports:
        yield _BY_KIND[port.port.kind], port.topic
    for right, name in _without_description(node):
        yield right, _remapped(node, right, resolve_name(name, node.namespace, node.instance.name))


def permissions_of_bring_up(name: str, managed: tuple[str, ...]) -> Iterator[Permission]:
    """Yield what the process needs that brings managed nodes to active.

    Args:
        name: its full name, which may be a pattern.
        managed: the full names of the nodes.
    """
    yield PUBLISH, "/rosout"
    yield PUBLISH, "/parameter_events"
    yield REPLY, f"{name}/{_TYPE_DESCRIPTION}"
    for node in managed:
        for service in _MANAGER_SERVICES:
            yield REQUEST, f"{node}/{service}"


def _without_description(node: FlatNode) -> Iterator[tuple[Right, str]]:
    """Yield what a client library opens for a node, by the names that it asks for."""
    settings = dict(node.parameters)
    yield PUBLISH, "/rosout"
    yield PUBLISH, "/parameter_events"
    # A time source of rclcpp watches use_sim_time there; that of rclpy does without. The language
    # of a node is known only where it is generated from rules.
    if node.statement is None or node.statement.target != "python":
        yield SUBSCRIBE, "/parameter_events"
    if settings.get("use_sim_time") is True:
        yield SUBSCRIBE, "/clock"
    for service in OF_EVERY_NODE:
        is_off = settings.get("start_type_description_service") is False
        if service != _TYPE_DESCRIPTION or not is_off:
            yield REPLY, f"~/{service}"
    if node.type is not None and node.type.lifecycle:
        yield PUBLISH, "~/transition_event"
        for service in OF_MANAGED_NODES:
            yield REPLY, f"~/{service}"


def _remapped(node: FlatNode, right: Right, name: str) -> str:
    """Return the name that the rules of a node give to a full name; the first one for it counts."""
    scheme_of_right = "rostopic" if right[0] == "topic" else "rosservice"
    for source, target in node.remappings:
        scheme, _, asked = source.rpartition("://")
        requested = resolve_name(asked, node.namespace, node.instance.name)
        if scheme in ("", scheme_of_right) and requested == name:
            return target
    return name
