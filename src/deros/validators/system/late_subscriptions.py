"""Checks of subscriptions that miss the last message of a latched topic where they start later."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from deros import codes
from deros.diagnostics import Diagnostic, Related, report
from deros.models.qos import policies
from deros.validators.wiring.graph import End, Vertex, publishers, subscribers

if TYPE_CHECKING:
    import networkx as nx


def check_late_subscriptions(graph: nx.MultiDiGraph[Vertex]) -> Iterator[Diagnostic]:
    """Yield a finding for each volatile subscription to a topic that is latched.

    Latched is what is published reliably, ``transient_local`` and with depth 1: the last message is
    kept for those who come later. A program of which no QoS is known is not accused, nor is a node
    that reads what it publishes itself.
    """
    for vertex in graph:
        if vertex[0] != "topic":
            continue
        latching = [each for each in publishers(graph, vertex) if _is_latched(each)]
        for sink in subscribers(graph, vertex) if latching else ():
            others = (each for each in latching if each.node is not sink.node)
            other = next(others, None)
            is_volatile = not sink.is_assumed and policies(sink.qos).durability == "volatile"
            if other is not None and is_volatile:
                yield _missed(vertex[1], other, sink)


def _is_latched(end: End) -> bool:
    offered = policies(end.qos)
    return (offered.reliability, offered.durability, offered.depth) == (
        "reliable",
        "transient_local",
        1,
    )


def _missed(topic: str, latching: End, sink: End) -> Diagnostic:
    again = ""
    if sink.node.instance.respawn is not None:
        again = ", as it does after each respawn"
    elif sink.node.type is not None and sink.node.type.lifecycle:
        again = ", as it does after each configuration"
    return report(
        codes.LATE_SUBSCRIPTION,
        f"{sink.name} asks for volatile messages of '{topic}', of which {latching.name} keeps the"
        f" last one for those who come later: where it starts later{again}, it misses that one",
        sink.span,
        "let the subscription ask for 'transient_local'",
        (
            Related(sink.qos_span, "it asks for volatile messages here"),
            Related(latching.qos_span, "the last message is kept here"),
        ),
    )
