"""The remappings of groups, as ROS 2 applies them to the names that a node asks for.

A rule of ROS 2 is for a full name, of whatever port asks for it, or of what a library of the node
opens by itself; so each rule goes to each node. The first rule for a name counts, and those of the
node's own connections stand before.
"""

from __future__ import annotations

from dataclasses import replace

from deros.models.programs import Remapping
from deros.models.system import Wiring
from deros.names.graph_names import resolve_name
from deros.systems.flat import FlatNode, FlatPort
from deros.systems.remapping import remappings


def remapped(
    node: FlatNode, rules: tuple[Remapping, ...], *, comes_first: bool = False
) -> FlatNode:
    """Return a node with the remappings of the groups around it.

    Args:
        node: with the connections of its own alone.
        rules: the innermost first; of several for one full name, the first counts.
        comes_first: whether the rules stand before those of the node's own connections, as they do
            where a launch file starts it.
    """
    if not rules:
        return node

    def full(name: str) -> str:
        return resolve_name(name, node.namespace, node.instance.name)

    # A connection that sets a parameter gives no rule that could come before.
    connected = {port.topic for port in node.ports if port.sets_parameter}
    connected |= {untyped.topic for untyped in node.untyped}
    by_name: dict[str, Remapping] = {}
    for rule in rules:
        if full(rule.name) not in connected:
            by_name.setdefault(full(rule.name), rule)
    ports = tuple(
        port
        if (port.wiring is not None and not (comes_first and not port.sets_parameter))
        or port.requested not in by_name
        else replace(
            port,
            topic=full(by_name[port.requested].target),
            wiring=_wiring(by_name[port.requested], port),
        )
        for port in node.ports
    )
    covered = {p.requested for p in ports if p.wiring is not None and not p.sets_parameter}
    others = tuple(
        (rule.name, full(rule.target))
        for rule in rules
        if by_name.get(full(rule.name)) is rule and full(rule.name) not in covered
    )
    kept = (old for old, new in zip(node.ports, ports, strict=True) if old is new)
    own = {port.requested for port in kept if port.wiring is not None}
    places = {name: place for place, name in enumerate(by_name) if name not in own}

    # Where a launch file is included in no namespace, `scan` and `/scan` are one name, too.
    def place(rule: tuple[str, str]) -> int:
        return places.get(full(rule[0].rpartition("://")[2]), -1)

    ordered = sorted((*remappings(ports), *others), key=place)
    return replace(node, ports=ports, remappings=tuple(ordered))


def _wiring(rule: Remapping, port: FlatPort) -> Wiring:
    """Return a rule as the connection of a port, at the place of the rule."""
    return Wiring(
        port.port.name, rule.target, rule.span, rule.name_span, rule.target_span, port.port.kind
    )
