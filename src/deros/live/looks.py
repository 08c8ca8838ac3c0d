"""A snapshot of a running graph, taken when the graph does not change any more."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Sequence

from deros.live.ends import Graph, NodeEnds, changed
from deros.live.graph_reader import GraphReader
from deros.live.inquiries import Inquiry
from deros.live.observer import SETTLED_S, Observer
from deros.live.snapshots import SeenNode, Snapshot, Unseen

EQUAL = 10
"""Equal looks in a row, at least, after which the graph counts as discovered.

They go on for as long as a process needs to announce itself again if its first announcement was
lost.
"""

ANSWER_S = 5.0
"""Seconds that a node has to answer what it is asked for."""

AT_ONCE = 20
"""Nodes that are asked at one time: each question makes ends that all processes learn of."""

LATE = 5
"""So many nodes may still owe an answer when the next are asked.

The ends for the questions to many nodes come and go together: a process that learns of them one by
one has twice the work with them.
"""


class UnsteadyGraphError(Exception):
    """The graph kept changing; the text says what."""


def snapshot(
    observer: Observer,
    pattern: str = "*",
    timeout: float = 30.0,
    equal: int = EQUAL,
    quiet: float = SETTLED_S,
    *,
    described: bool = True,
) -> Snapshot:
    """Return what is seen of a graph once it has been the same for some looks.

    Args:
        observer: the node that looks.
        pattern: of the shell, for the full names of nodes.
        timeout: seconds for the graph to stay the same.
        equal: looks in a row that have to be the same.
        quiet: seconds that they have to cover.
        described: ask for the descriptions and ranges of parameters, too.

    Raises:
        UnsteadyGraphError: if it does not stay the same in time.
    """
    graph = _steady(observer, pattern, timeout, equal, quiet)
    unseen = [Unseen(each, node.full_name) for node in graph.nodes for each in node.doubtful]
    nodes, failed = _asked(observer, graph.nodes, described=described)
    return Snapshot(tuple(nodes), (*unseen, *failed))


def _steady(observer: Observer, pattern: str, timeout: float, equal: int, quiet: float) -> Graph:
    """Return the graph once its names and types stay the same and the node of each end is known.

    An end keeps its QoS as long as it lives, so that is read once, at the end.
    """
    since = time.monotonic()
    deadline = since + timeout
    reader = GraphReader(observer, pattern)
    version = observer.graph_version
    seen, count = reader.names(), 0
    changes: dict[str, None] = {}

    def steady() -> Graph | None:
        nonlocal version, seen, count, since
        now = time.monotonic()
        current = seen
        if (latest := observer.graph_version) != version:
            version, current = latest, reader.names()
        if current == seen:
            count += 1
        else:
            changes.update(dict.fromkeys(changed(seen, current)))
            seen, count, since = current, 0, now
        if not seen.nodes or count < equal or now - since < quiet:
            return None
        whole = reader.whole(afresh=False)
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
        inquiry.components(),
    )


def _asked(
    observer: Observer, nodes: Sequence[NodeEnds], *, described: bool
) -> tuple[list[SeenNode], list[Unseen]]:
    """Return nodes with what they say of themselves, and what they failed to say."""
    waiting = deque(nodes)
    asked: dict[str, tuple[NodeEnds, Inquiry, float]] = {}
    over: list[Inquiry] = []
    seen: dict[str, tuple[SeenNode, list[Unseen]]] = {}

    def close() -> None:
        for inquiry in over:
            inquiry.close()
        over.clear()

    def are_asked() -> bool:
        """Take the next step of each inquiry, and begin others once nearly all are over."""
        for name, (node, inquiry, deadline) in [*asked.items()]:
            if inquiry.is_done() or time.monotonic() >= deadline:
                seen[name] = seen_node(node, inquiry), [*inquiry.problems(ANSWER_S)]
                over.append(inquiry)
                del asked[name]
        if len(asked) <= LATE:
            close()
            while waiting and len(asked) < AT_ONCE:
                node = waiting.popleft()
                inquiry = Inquiry(observer.node, node, described=described)
                asked[node.full_name] = node, inquiry, time.monotonic() + ANSWER_S
                inquiry.is_done()
        return not asked

    try:
        observer.until(are_asked, float("inf"))
    finally:
        over += [inquiry for _, inquiry, _ in asked.values()]
        close()
    found = [seen[node.full_name] for node in nodes]
    return [node for node, _ in found], [each for _, failed in found for each in failed]
