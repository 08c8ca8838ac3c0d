"""A running graph that is watched: looked at often enough, and asked when something has changed."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from deros.live.ends import Graph, NodeEnds
from deros.live.graph_reader import GraphReader
from deros.live.inquiries import Inquiry
from deros.live.looks import ANSWER_S, AT_ONCE, seen_node
from deros.live.observer import Observer
from deros.live.snapshots import SeenNode, Snapshot
from deros.live.verify.compare import compare
from deros.live.verify.differences import Comparison, Kind
from deros.live.verify.expectation import Expectation
from deros.live.verify.graces import Event, Graces
from deros.live.verify.parameters import FirstValues
from deros.live.verify.restarts import Restarts

TURN_S = 0.25
"""Seconds between two turns: whether the graph has changed is known by then, without a look."""

ENDS_S = 1.0
"""Seconds between two looks at the names of all ends, at least, while the graph changes.

While the names of nodes stay the same, they are as rare as keeps them below half a percent of a
core: every 2 s in a graph of 100 nodes with 600 topics.
"""

QOS_S = 30.0
"""Seconds between two looks at the QoS of all ends, at least, while their names stay the same.

An end keeps its QoS as long as it lives; one of another QoS may take its place unseen.
"""

_ENDS_SHARE = 1 / 200
_QOS_SHARE = 1 / 500
"""Shares of a core that these looks may take."""

ASK_S = 5.0
"""Seconds after which one more node is asked though it has not published any change."""

_ANSWERING_S = 0.02
"""Seconds between two looks while nodes are asked, or are found."""

_CLEAR_S = 1.0
"""Seconds in which the nodes of all ends are known, while a graph changes."""


class Watch:
    """Looks at a graph again and again, and compares it with what a system says.

    Nodes publish changes of their parameters and of their lifecycle states: they are asked then,
    when they are new, and otherwise seldom, one after the other.
    """

    def __init__(
        self,
        observer: Observer,
        expected: Expectation,
        first: Snapshot,
        graces_ns: Mapping[Kind, int],
    ) -> None:
        """Start with a first look, whose values of parameters are those that must not change."""
        self._observer = observer
        self._expected = expected
        self._graces = Graces(graces_ns)
        self._restarts = Restarts(expected.nodes)
        self._first: FirstValues = {}
        self._seen = {node.full_name: node for node in first.nodes}
        self._reader = GraphReader(observer)
        self._version = observer.graph_version
        self._graph = self._without_qos = Graph(())
        self._unclear_since: float | None = None
        self._inquiries: dict[str, tuple[Inquiry, NodeEnds, float]] = {}
        self._waiting: dict[str, bool] = {}
        self._turns: list[tuple[str, bool]] = []
        self._states: dict[str, Any] = {}
        self._names: list[tuple[str, str]] = []
        self._has_changed = False
        self._is_new = True
        self._comparison = Comparison(())
        self._ends_at = self._qos_at = 0.0
        self._ask_at = time.monotonic() + ASK_S
        self._listen()
        self._look_at_ends(time.monotonic(), is_first=True)

    @property
    def graces(self) -> Graces:
        """What is reported by now."""
        return self._graces

    @property
    def seen(self) -> Snapshot:
        """The graph as it is known by now."""
        return Snapshot(tuple(map(self._node, self._graph.nodes)))

    def close(self) -> None:
        """Remove what the open questions have added to the graph."""
        for inquiry, _, _ in self._inquiries.values():
            inquiry.close()
        self._inquiries.clear()

    def turn(self) -> list[Event]:
        """Wait for a moment, look, and return what is to be reported."""
        is_busy = self._inquiries or self._unclear_since is not None
        self._observer.wait(_ANSWERING_S if is_busy else TURN_S)
        now = time.monotonic()
        names = self._changed_names()
        # Questions make ends, too: those that are made and removed are looked at once.
        ends_at = self._ends_at + (ENDS_S if self._inquiries else 0)
        is_due = now >= self._qos_at or (self._has_changed and now >= ends_at)
        if names is not None or is_due or self._unclear_since is not None:
            self._has_changed = False
            self._look_at_ends(now)
        self._ask(now)
        if self._is_new:
            self._is_new = False
            self._comparison = compare(self._expected, self.seen, self._first)
        now_ns = time.monotonic_ns()
        restarting = self._restarts.look(now_ns, names)
        seen = replace(self._comparison, differences=(*self._comparison.differences, *restarting))
        return self._graces.look(now_ns, seen)

    def _changed_names(self) -> list[str] | None:
        """Return the full names of all nodes, if others are there than in the last turn."""
        version = self._observer.graph_version
        if version == self._version:
            return None
        self._version, self._has_changed = version, True
        names = self._observer.node.get_node_names_and_namespaces()
        if names == self._names:
            return None
        self._names = names
        return [_full_name(*each) for each in names]

    # Messages -------------------------------------------------------------------------------------

    def _listen(self) -> None:
        from rcl_interfaces.msg import ParameterEvent
        from rclpy.qos import qos_profile_parameter_events

        def changed(event: Any) -> None:
            self._wait_for(event.node)

        self._observer.node.create_subscription(
            ParameterEvent, "/parameter_events", changed, qos_profile_parameter_events
        )

    def _listen_to_states(self, node: NodeEnds) -> None:
        from lifecycle_msgs.msg import TransitionEvent

        name = node.full_name
        if name not in self._states and node.is_managed:
            self._states[name] = self._observer.node.create_subscription(
                TransitionEvent, f"{name}/transition_event", lambda _: self._wait_for(name), 10
            )

    def _wait_for(self, name: str) -> None:
        """Have a node asked for all that it says, as soon as it can be."""
        if name in self._expected.nodes:
            self._waiting[name] = True

    def _wait_for_containers(self) -> None:
        """Have all containers asked: nodes have come or gone, and some may be theirs."""
        for node in self._graph.nodes:
            if node.is_container:
                self._waiting[node.full_name] = True

    # Looks ----------------------------------------------------------------------------------------

    def _look_at_ends(self, now: float, *, is_first: bool = False) -> None:
        """Read the names of all ends, and the QoS of those that changed; all of it in its turn."""
        names = self._reader.names()
        self._ends_at = now + max(ENDS_S, (time.monotonic() - now) / _ENDS_SHARE)
        is_qos_due = now >= self._qos_at
        if names == self._without_qos and not is_qos_due:
            self._unclear_since = None
            return
        graph = self._reader.whole(afresh=is_qos_due)
        if not graph.complete and not self._is_long_unclear(now):
            return
        self._unclear_since = None
        if is_qos_due:
            self._qos_at = now + max(QOS_S, (time.monotonic() - now) / _QOS_SHARE)
        before, self._without_qos = self._graph, names
        if graph != before:
            self._graph, self._is_new = graph, True
            self._follow(before, is_first=is_first)

    def _follow(self, before: Graph, *, is_first: bool) -> None:
        """Ask the nodes that are new, and those whose services have changed."""
        old = {each.full_name: each for each in before.nodes}
        there = {each.full_name: each for each in self._graph.nodes}
        for name in self._seen.keys() - there.keys():
            del self._seen[name]
            self._stop_asking(name)
        if [(node.full_name, node.count) for node in before.nodes] != [
            (node.full_name, node.count) for node in self._graph.nodes
        ]:
            self._wait_for_containers()
        for name, node in there.items():
            if name not in self._expected.nodes:
                continue
            self._listen_to_states(node)
            is_known = is_first and name in self._seen
            if not is_known and (name not in old or old[name].services != node.services):
                self._stop_asking(name)
                self._wait_for(name)

    def _is_long_unclear(self, now: float) -> bool:
        """Return whether the nodes of some ends stay unknown, so that nothing else is to come."""
        if self._unclear_since is None:
            self._unclear_since = now
        return now - self._unclear_since >= _CLEAR_S

    def _node(self, node: NodeEnds) -> SeenNode:
        said = self._seen.get(node.full_name)
        if said is not None:
            parameters, state, components = said.parameters, said.lifecycle, said.components
        else:
            parameters, state, components = None, "unknown" if node.is_managed else None, None
        return SeenNode(
            node.full_name, node.ends, parameters, state, node.is_container, node.count, components
        )

    # Questions ------------------------------------------------------------------------------------

    def _ask(self, now: float) -> None:
        """Ask the nodes that have to be, and take what others have answered by now."""
        if now >= self._ask_at:
            self._ask_at = now + ASK_S
            every = (True, False)
            self._turns = self._turns or [(n, all_) for all_ in every for n in self._expected.nodes]
            self._waiting.setdefault(*self._turns.pop())
            # A container says that it has a node once that is made, which may take its time.
            if any(each.kind is Kind.WRONG_CONTAINER for each in self._comparison.differences):
                self._wait_for_containers()
        there = {each.full_name: each for each in self._graph.nodes} if self._waiting else {}
        for name in [*self._waiting]:
            if len(self._inquiries) >= AT_ONCE:
                break
            if name not in self._inquiries:  # what it answers now may be older than the change
                is_for_all = self._waiting.pop(name)
                if name in there:
                    names = () if is_for_all else self._names_of_parameters(name)
                    inquiry = Inquiry(
                        self._observer.node, there[name], described=False, names=names
                    )
                    self._inquiries[name] = (inquiry, there[name], now + ANSWER_S)
        for name, (inquiry, node, deadline) in [*self._inquiries.items()]:
            if inquiry.is_done() or now >= deadline:
                self._stop_asking(name)
                if inquiry.has_other_names() or not inquiry.is_done():
                    self._waiting[name] = True
                if not inquiry.has_other_names():
                    found = seen_node(node, inquiry)
                    self._is_new |= found != self._seen.get(name)
                    self._seen[name] = found

    def _names_of_parameters(self, name: str) -> tuple[str, ...]:
        """Return the names of a node's parameters as they are known, none if they are not."""
        known = self._seen[name].parameters if name in self._seen else None
        return tuple(each.name for each in known or ())

    def _stop_asking(self, name: str) -> None:
        if name in self._inquiries:
            self._inquiries.pop(name)[0].close()


def _full_name(name: str, namespace: str) -> str:
    return f"{namespace.rstrip('/')}/{name}"
