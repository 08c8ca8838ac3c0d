"""The differences between one look at a graph and what a system says of it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from deros.live.snapshots import SeenNode, Snapshot
from deros.live.verify.containers import container_differences, is_known
from deros.live.verify.differences import About, Comparison, Difference, Kind
from deros.live.verify.ends import end_differences, unconnected
from deros.live.verify.expectation import Expectation, ExpectedNode
from deros.live.verify.parameters import FirstValues, parameter_differences
from deros.models.node import PortKind

_HELPERS = re.compile(r"launch_ros_\d+|transform_listener_impl_[0-9a-f]+", re.ASCII)
"""Nodes that ``ros2 launch`` and listeners of tf2 make, by their last names."""

_CONFIGURED = frozenset({"inactive", "active", "activating", "deactivating"})
"""States in which a managed node has its ends and parameters."""

_TWICE = "one that was killed counts until its lease ends, 20 s with Fast DDS"


def compare(
    expected: Expectation, snapshot: Snapshot, first: FirstValues | None = None
) -> Comparison:
    """Return what differs.

    Args:
        expected: what the system says.
        snapshot: what was seen.
        first: the values of parameters of which the system says nothing, as they were seen first;
            those of new ones are added. Without it, they are not compared.
    """
    everything = {node.full_name: node for node in snapshot.nodes}
    seen = {
        name: node
        for name, node in everything.items()
        if not expected.is_ignored(name) and not _HELPERS.fullmatch(node.name)
    }
    found = [*_nodes(expected, seen)]
    second = [*_second_publishers(expected, seen)]
    told = {(each.node, each.subject) for each in second}
    for name, node in expected.nodes.items():
        if name in seen:
            found += _of_node(node, seen[name], first)
    found = [
        each
        for each in found
        if each.kind is not Kind.EXTRA_END or (each.node, each.subject) not in told
    ]
    found += second
    found += container_differences(expected, everything)
    found += unconnected(seen.values(), found)
    order = list(Kind)
    found.sort(key=lambda each: (order.index(each.kind), each.node, each.subject))
    return Comparison(tuple(found), frozenset(_unknown(expected, everything)))


def _nodes(expected: Expectation, seen: Mapping[str, SeenNode]) -> Iterator[Difference]:
    for name, node in expected.nodes.items():
        if name not in seen:
            yield Difference(Kind.MISSING_NODE, name, span=node.span)
    for name, found in seen.items():
        span = expected.nodes[name].span if name in expected.nodes else None
        if found.count > 1:
            yield Difference(
                Kind.REPEATED_NODE, name, "", "1", str(found.count), note=_TWICE, span=span
            )
        if name not in expected.nodes and not expected.may_run(name):
            yield Difference(Kind.EXTRA_NODE, name)


def _of_node(node: ExpectedNode, seen: SeenNode, first: FirstValues | None) -> Iterator[Difference]:
    if node.state is not None and seen.lifecycle not in (node.state, "unknown"):
        there = seen.lifecycle or "not a managed node"
        yield Difference(Kind.WRONG_STATE, node.full_name, "", node.state, there, span=node.span)
    is_whole = not node.is_managed or seen.lifecycle in (None, *_CONFIGURED)
    yield from end_differences(node, seen, is_whole=is_whole)
    if seen.parameters is not None:
        yield from parameter_differences(node, seen, first, is_whole=is_whole)


def _second_publishers(expected: Expectation, seen: Mapping[str, SeenNode]) -> Iterator[Difference]:
    for name, node in seen.items():
        for end in node.ends:
            meant = expected.sole_publishers.get(end.name)
            if end.kind is not PortKind.PUBLISHER or meant in (None, name):
                continue
            subject = f"{end.kind.word} {end.name}"
            note = f"{meant} alone is meant to publish it"
            yield Difference(Kind.SECOND_PUBLISHER, name, subject, note=note)


def _unknown(expected: Expectation, seen: Mapping[str, SeenNode]) -> Iterator[tuple[str, About]]:
    """Yield what is not known of the nodes that have to run."""
    for name in expected.nodes:
        node = seen.get(name)
        if node is None:
            yield name, "ends"
        if node is None or node.parameters is None:
            yield name, "parameters"
        if node is None or node.lifecycle == "unknown":
            yield name, "state"
        if name not in seen or not is_known(expected.nodes[name], seen):
            yield name, "container"
