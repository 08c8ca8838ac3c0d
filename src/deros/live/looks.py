"""A snapshot of a running graph, taken when the graph does not change any more."""

from __future__ import annotations

import time
from collections.abc import Sequence

from deros.live.ends import Graph, NodeEnds, changed, graph_now
from deros.live.inquiries import Inquiry
from deros.live.observer import SETTLED_S, Observer
from deros.live.snapshots import SeenNode, Snapshot, Unseen

EQUAL = 10
"""Equal looks in a row, at least, after which the graph counts as discovered.

They go on for as long as a process needs to announce itself again if its first announcement was
lost: a look at a large graph takes some 100 ms, at a small one less than the pause between two.
"""

ANSWER_S = 5.0
"""Seconds that a node has to answer what it is asked for."""

AT_ONCE = 20
"""Nodes that are asked at one time: each question makes ends that all processes learn of."""


class UnsteadyGraphError(Exception):
    """The graph kept changing; the text says what."""


def snapshot(
    observer: Observer,
    pattern: str = "*",
    timeout: float = 30.0,
    equal: int = EQUAL,
    quiet: float = SETTLED_S,
) -> Snapshot:
    """Return what is seen of a graph once it has been the same for some looks.

    Args:
        observer: the node that looks.
        pattern: of the shell, for the full names of nodes.
        timeout: seconds for the graph to stay the same.
        equal: looks in a row that have to be the same.
        quiet: seconds that they have to cover.

    Raises:
        UnsteadyGraphError: if it does not stay the same in time.
    """
    graph = _steady(observer, pattern, timeout, equal, quiet)
    nodes: list[SeenNode] = []
    unseen = [Unseen(each, node.full_name) for node in graph.nodes for each in node.doubtful]
    for first in range(0, len(graph.nodes), AT_ONCE):
        found, failed = _asked(observer, graph.nodes[first : first + AT_ONCE])
        nodes += found
        unseen += failed
    return Snapshot(tuple(nodes), tuple(unseen))


def _steady(observer: Observer, pattern: str, timeout: float, equal: int, quiet: float) -> Graph:
    """Return the graph once its names and types stay the same and the node of each end is known.

    An end keeps its QoS as long as it lives, so that is read once, at the end.
    """
    since = time.monotonic()
    deadline = since + timeout
    seen, count = graph_now(observer, pattern, with_qos=False), 0
    changes: dict[str, None] = {}

    def steady() -> Graph | None:
        nonlocal seen, count, since
        now = time.monotonic()
        current = graph_now(observer, pattern, with_qos=False)
        if current == seen:
            count += 1
        else:
            changes.update(dict.fromkeys(changed(seen, current)))
            seen, count, since = current, 0, now
        if not seen.nodes or count < equal or now - since < quiet:
            return None
        whole = graph_now(observer, pattern)
        return whole if whole.complete else None

    found = observer.until(steady, deadline)
    if found is None and seen.nodes:
        what = "; ".join([*changes][-5:]) or "the nodes of some ends stayed unknown"
        raise UnsteadyGraphError(
            f"the graph did not stay the same within {timeout:g} s: {what}. Wait until all nodes "
            "are up, give --timeout, or leave out what changes with --node"
        )
    return found or seen


def seen_node(node: NodeEnds, inquiry: Inquiry) -> SeenNode:
    """Return a node with what it has said of itself by now."""
    return SeenNode(
        node.full_name,
        node.ends,
        inquiry.parameters(),
        inquiry.state(),
        node.is_container,
        node.count,
    )


def _open(inquiries: Sequence[Inquiry]) -> list[Inquiry]:
    """Take the next step of each inquiry; return those that wait for an answer."""
    return [each for each in inquiries if not each.is_done()]


def _asked(observer: Observer, nodes: Sequence[NodeEnds]) -> tuple[list[SeenNode], list[Unseen]]:
    """Return nodes with what they say of themselves, and what they failed to say."""
    inquiries = [Inquiry(observer.node, node) for node in nodes]
    try:
        deadline = time.monotonic() + ANSWER_S
        observer.until(lambda: not _open(inquiries), deadline)
        seen = [seen_node(node, each) for node, each in zip(nodes, inquiries, strict=True)]
        return seen, [problem for each in inquiries for problem in each.problems(ANSWER_S)]
    finally:
        for each in inquiries:
            each.close()
