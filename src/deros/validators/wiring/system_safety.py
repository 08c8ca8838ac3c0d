"""Checks for a second publisher of an action's state or of a heartbeat."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence

from deros import codes
from deros.diagnostics import Code, Diagnostic, Related, report
from deros.models.node import Port, PortKind
from deros.models.rules import Rules
from deros.names.graph_names import resolve_name
from deros.systems import safety_nodes
from deros.systems.flat import FlatNode, FlatSystem
from deros.systems.safety_nodes import HEARTBEAT, HEARTBEAT_TYPE, is_gate
from deros.validators.wiring.graph import End


def check_safety_publishers(flat: FlatSystem, watchers: Iterable[Rules]) -> Iterator[Diagnostic]:
    """Yield each second publisher of the state of an action, or of a heartbeat.

    The state of an action is what ``watchers``, the rules that use the system, publish, or what a
    generated safety node of the system does.
    """
    publishers = _publishers(flat)
    for topic in sorted(_states(flat, watchers) & publishers.keys()):
        yield from _seconds(
            codes.STATE_PUBLISHED_TWICE, topic, "the state of an action", publishers[topic]
        )
    for topic in sorted(_heartbeats(flat) & publishers.keys()):
        yield from _seconds(
            codes.HEARTBEAT_PUBLISHED_TWICE, topic, "a heartbeat", publishers[topic]
        )
    yield from _programs(watchers)


def _publishers(flat: FlatSystem) -> dict[str, list[End]]:
    found: dict[str, list[End]] = defaultdict(list)
    for node in flat.nodes:
        for port in node.ports:
            if port.port.kind is PortKind.PUBLISHER:
                found[port.topic].append(End(node, port))
    return found


def _seconds(code: Code, topic: str, what: str, publishers: Sequence[End]) -> Iterator[Diagnostic]:
    """Report all publishers of a topic but the safety node, or the first if none is one."""
    first = next((each for each in publishers if is_safety_node(each.node)), publishers[0])
    for each in publishers:
        if each is not first:
            yield report(
                code,
                f"'{each.node.full_name}' publishes '{topic}', {what}, besides"
                f" '{first.node.full_name}'",
                each.span,
                "give each safety node its own topics, and publish them from no other node",
                (Related(first.span, "the other publisher"),),
            )


def _states(flat: FlatSystem, watchers: Iterable[Rules]) -> set[str]:
    bindings = (action.binding for rules in watchers for action in rules.actions)
    found = {resolve_name(each.topic.text, "/") for each in bindings if each is not None}
    for node in flat.nodes:
        if is_safety_node(node):
            found |= {port.topic for port in node.ports if is_state(port.port)}
    return found


def is_state(port: Port) -> bool:
    """Return whether a port of a safety node publishes the states of actions."""
    qos = port.qos
    is_latched = qos is not None and qos.durability == "transient_local" and qos.depth == 1
    return port.kind is PortKind.PUBLISHER and is_latched


def _heartbeats(flat: FlatSystem) -> set[str]:
    """Return the topics with heartbeats: of safety nodes, and those that gates listen to."""
    found: set[str] = set()
    for node in flat.nodes:
        for port in node.ports:
            if port.port.type != HEARTBEAT_TYPE:
                continue
            is_own = port.port.kind is PortKind.PUBLISHER and port.port.name == HEARTBEAT
            is_heard = port.port.kind is PortKind.SUBSCRIPTION and is_a_gate(node)
            if is_own or (is_heard and port.port.name.endswith("/heartbeat")):
                found.add(port.topic)
    return found


def is_of_safety(node: FlatNode) -> bool:
    """Return whether a node is a generated safety node or a gate."""
    return is_safety_node(node) or is_a_gate(node)


def is_safety_node(node: FlatNode) -> bool:
    """Return whether a node has the heartbeat of a generated safety node."""
    return node.type is not None and safety_nodes.is_safety_node(node.type)


def is_a_gate(node: FlatNode) -> bool:
    """Return whether a node has the name of a gate."""
    return node.type is not None and is_gate(node.type.name)


def _programs(watchers: Iterable[Rules]) -> Iterator[Diagnostic]:
    """Report actions of two programs, whose safety nodes are two, on one topic."""
    first: dict[str, Rules] = {}
    for rules in watchers:
        for action in rules.actions:
            if action.binding is None:
                continue
            topic = resolve_name(action.binding.topic.text, "/")
            other = first.setdefault(topic, rules)
            if other is not rules:
                place = next(
                    each.binding.topic.span
                    for each in other.actions
                    if each.binding and resolve_name(each.binding.topic.text, "/") == topic
                )
                yield report(
                    codes.STATE_PUBLISHED_TWICE,
                    f"the rules '{rules.name}' and '{other.name}' both publish '{topic}', the"
                    " state of an action",
                    action.binding.topic.span,
                    "give the safety node of each its own topics",
                    (Related(place, "the other action"),),
                )
