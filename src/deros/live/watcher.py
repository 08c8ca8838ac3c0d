"""Listens to the diagnostics and the events of safety nodes and gates, for as long as it takes."""

from __future__ import annotations

import time
from functools import partial

from deros.live.foxglove import DIAGNOSTICS, Subject
from deros.live.observer import Observer
from deros.live.states import DEPTH, DiagnosticsListener, awaited
from deros.live.watched import Watched, WatchedEvent, WatchedNode
from deros.systems.safety_nodes import DIAGNOSTICS_TYPE, HEARTBEAT

EVENTS = "events"
"""The topic below a safety node's name."""

_LOOK_S = 1.0
"""Seconds between two looks for nodes that are in the graph and do not report."""

_STATES = frozenset(
    f"std_msgs/msg/{name}"
    for name in ("Bool", "String", "Int8", "Int16", "Int32", "UInt8", "UInt16", "UInt32")
)
"""Types of action topics whose value is shown as a state over time."""


class Watcher:
    """Feeds :class:`Watched` from the topics of a running graph.

    Attributes:
        watched: what has been received.
    """

    def __init__(self, observer: Observer, node: str | None, silence_s: float) -> None:
        """Start listening.

        Args:
            observer: the node that listens.
            node: the full name of the only one to show; ``None`` for all of them.
            silence_s: seconds without a report after which a node is silent.
        """
        self.watched = Watched(silence_s=silence_s)
        self._observer = observer
        self._node = node
        self._listener = DiagnosticsListener(observer, self.watched.take)
        self._followed: set[str] = set()
        self._looked = float("-inf")

    def listen(self) -> int:
        """Subscribe to what is new in the graph; return how many messages have been taken."""
        self._listener.listen()
        for node in self.watched.safety_nodes() - self._followed:
            self._follow(node)
        if (now := time.monotonic()) - self._looked >= _LOOK_S:
            self._looked = now
            self.watched.expect(awaited(self._observer, self.watched))
        return self.watched.changes

    def nodes(self) -> tuple[WatchedNode, ...]:
        """Return the nodes to show, as they are now; those that have begun to report are left out.

        A node whose report is not complete yet, or that was not found, is not among them.
        """
        complete = self.watched.complete()
        return tuple(
            state
            for state in self.watched.nodes()
            if (state.node in complete or state.silent_s is not None)
            and self._node in (None, state.node)
        )

    def found(self) -> frozenset[str]:
        """Return the names of the nodes to show that are in the graph or have reported."""
        self.watched.expect(awaited(self._observer, self.watched))
        known = self.watched.expected() | self.watched.complete() | self.watched.incomplete()
        return frozenset(name for name in known if self._node in (None, name))

    def silent(self) -> tuple[str, ...]:
        """Return the names of the nodes that are in the graph and have not reported completely."""
        return tuple(sorted(self.found() - self.watched.complete()))

    def has_reports(self) -> bool:
        """Whether a node to show has reported completely."""
        complete = self.watched.complete()
        return self._node in complete if self._node else bool(complete)

    def settle(self, timeout: float) -> None:
        """Wait until every node to show that was found has reported, its events included."""
        deadline = time.monotonic() + timeout
        if self._node is None:
            self._observer.settled(lambda: self.listen() and self.found(), deadline)
        self._observer.until(self._is_settled, deadline)

    def _is_settled(self) -> bool:
        """Whether there is nothing to wait for; each safety node has an event, of its start."""
        self.listen()
        shown = [self._node] if self._node else self.found()
        is_reporting = self.has_reports() and not self.silent()
        return is_reporting and all(
            self.watched.event_total(node)
            for node in self.watched.safety_nodes().intersection(shown)
        )

    def events(self) -> list[WatchedEvent]:
        """Return the events of the nodes to show, in order of ROS time."""
        names = [self._node] if self._node else sorted(self.watched.safety_nodes())
        found = [event for name in names for event in self.watched.events(name)]
        return sorted(found, key=lambda event: event.ros_time_ns or 0)

    def subjects(self) -> tuple[Subject, ...]:
        """Return the nodes to show that have reported, for a layout; safety nodes first."""
        subjects = [self._subject(node) for node in self.nodes() if node.kind is not None]
        return tuple(sorted(subjects, key=lambda each: (not each.has_events, each.node)))

    def _subject(self, node: WatchedNode) -> Subject:
        namespace, _, name = node.node.rpartition("/")
        graph = self._observer.node
        topics = graph.get_publisher_names_and_types_by_node(name, namespace or "/")
        published = {topic: types[0] for topic, types in topics}
        diagnostics = [t for t, of_type in published.items() if of_type == str(DIAGNOSTICS_TYPE)]
        states = {
            topic: f"{topic}.data"
            for topic, of_type in published.items()
            if of_type in _STATES and not topic.endswith(HEARTBEAT.removeprefix("~"))
        }
        parts = [f"action {action.name}" for action in node.actions]
        parts += [rule.name for rule in node.rules]
        return Subject(
            node.node,
            min(diagnostics, default=DIAGNOSTICS),
            node.kind == "safety node",
            states,
            tuple(parts),
        )

    def _follow(self, node: str) -> None:
        from diagnostic_msgs.msg import DiagnosticStatus
        from rclpy.qos import DurabilityPolicy, QoSProfile

        self._followed.add(node)
        profile = QoSProfile(depth=DEPTH, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        take = partial(self.watched.take_event, node)
        self._observer.node.create_subscription(DiagnosticStatus, f"{node}/{EVENTS}", take, profile)
