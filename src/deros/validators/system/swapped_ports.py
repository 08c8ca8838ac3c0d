"""Connections of a node that are probably swapped, judged by the words of their names."""

from __future__ import annotations

import itertools
from collections import defaultdict
from collections.abc import Iterator

from deros import codes
from deros.diagnostics import Diagnostic, Related, report
from deros.interfaces.types import InterfaceType
from deros.names.topic_likeness import words_of
from deros.systems.flat import FlatNode, FlatPort, FlatSystem
from deros.systems.safety_nodes import is_safety_node
from deros.validators.wiring.graph import CHANNEL, SOURCES, VertexKind

_COMPARED = 64
"""So many ports of a node and type are compared with each other."""


def check_swapped(flat: FlatSystem) -> Iterator[Diagnostic]:
    """Yield the pairs of connections whose port and target names match crosswise.

    Only ports of one type can be exchanged without another finding, and of services and actions
    only those on one side. Safety nodes and gates are compared with their rules instead.
    """
    reported: set[tuple[int, int]] = set()
    for node in flat.nodes:
        if node.type is None or is_safety_node(node.type) or len(node.instance.wirings) < 2:
            continue
        for first, second in _pairs(node):
            assert first.wiring is not None
            assert second.wiring is not None
            # Of a system that is used several times, each instance would say the same.
            pair = (id(first.wiring), id(second.wiring))
            if pair in reported or not are_swapped(
                (first.port.name, first.topic), (second.port.name, second.topic)
            ):
                continue
            reported.add(pair)
            yield report(
                codes.LIKELY_SWAPPED,
                f"'{first.port.name}' of '{node.instance.name}' is connected to '{first.topic}',"
                f" and '{second.port.name}' to '{second.topic}': they are probably swapped",
                first.wiring.span,
                f"connect '{first.port.name}' to '{second.wiring.target}' and"
                f" '{second.port.name}' to '{first.wiring.target}'",
                (Related(second.wiring.span, "the other connection"),),
            )


def _pairs(node: FlatNode) -> Iterator[tuple[FlatPort, FlatPort]]:
    """Yield the pairs of connected ports that could be confused."""
    groups: dict[tuple[VertexKind, bool, InterfaceType], list[FlatPort]] = defaultdict(list)
    for port in node.ports:
        if port.wiring is not None:
            kind = CHANNEL[port.port.kind]
            is_source = kind != "topic" and port.port.kind in SOURCES
            groups[kind, is_source, port.port.type].append(port)
    for alike in groups.values():
        for first, second in itertools.combinations(alike[:_COMPARED], 2):
            if first.wiring is not second.wiring and first.topic != second.topic:
                yield first, second


def are_swapped(first: tuple[str, str], second: tuple[str, str]) -> bool:
    """Return whether two ports share words with each other's targets, and none with their own.

    Words that both ports have, or both targets, say nothing. Each argument is the name of a port
    and the full name that it is connected to.
    """
    port, other = words_of(first[0]), words_of(second[0])
    target, elsewhere = words_of(first[1]), words_of(second[1])
    crossed = (port - other) & (elsewhere - target) or (other - port) & (target - elsewhere)
    straight = (port - other) & (target - elsewhere) or (other - port) & (elsewhere - target)
    return bool(crossed) and not straight
