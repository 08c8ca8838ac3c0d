"""What running safety nodes and gates report of themselves on the topics of diagnostics."""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, Protocol

from deros.live.graph import nodes_of_heartbeats, reporting_nodes, topics_of_diagnostics
from deros.live.observer import Observer, printable

Kind = Literal["safety node", "gate"]

_HARDWARE: Mapping[str, Kind] = {"deros safety node": "safety node", "deros gate": "gate"}
"""Whose reports these are, by the hardware that they name."""

NODE = re.compile(r"(?:/[A-Za-z_][A-Za-z0-9_]*)+")
"""The full name of a node."""

LEVELS = ("ok", "warning", "error", "stale")
"""The levels of a diagnostic status, by their number."""

DEPTH = 1000
"""Messages that may wait: those of a robot's nodes arrive in bursts.

It is also how many events a safety node keeps for subscribers that come late.
"""


@dataclass(frozen=True)
class ActiveAction:
    """An active action, as the safety node reports it.

    Attributes:
        name: of the action.
        behaviour: that triggered it; or why it is active otherwise.
        because: the cause at that time; empty if none is known.
        since: how long ago that was, in the words of the node; empty if that is unknown.
    """

    name: str
    behaviour: str
    because: str
    since: str


@dataclass(frozen=True)
class NodeState:
    """The last report of a safety node or a gate.

    Attributes:
        node: its full name.
        kind: which of the two it is.
        level: one of :data:`LEVELS`.
        message: what applies, or that commands pass, or that rules are watched.
        since: since when that is so, for gates.
        actions: those that are active, of safety nodes.
    """

    node: str
    kind: Kind
    level: str
    message: str
    since: str
    actions: tuple[ActiveAction, ...] = ()

    @property
    def is_clear(self) -> bool:
        """Whether nothing is active, and nothing is wrong or waited for."""
        return self.level == LEVELS[0] and not self.actions


@dataclass(frozen=True)
class RobotState:
    """The state of all safety nodes and gates.

    Attributes:
        nodes: of those that reported, sorted by name.
        silent: the names of those that are in the graph and did not report completely.
    """

    nodes: tuple[NodeState, ...]
    silent: tuple[str, ...]

    @property
    def is_clear(self) -> bool:
        """Whether each node reports, and none of them holds commands back."""
        return not self.silent and all(state.is_clear for state in self.nodes)


@dataclass
class _Heard:
    """What was received from one node."""

    reports: int = 0
    state: NodeState | None = None
    actions: dict[str, ActiveAction | None] = field(default_factory=dict)

    @property
    def is_complete(self) -> bool:
        """Whether a whole report was received, from its beginning.

        A gate reports in one status. A report of a safety node begins with the status of the node
        and takes several messages, so the next one shows that it has ended.
        """
        return self.state is not None and (self.state.kind == "gate" or self.reports > 1)


class Completeness(Protocol):
    """What says of which nodes something was received."""

    def complete(self) -> frozenset[str]:
        """Return the nodes of which a whole report was received."""
        ...

    def incomplete(self) -> frozenset[str]:
        """Return the nodes of which only a part of a report was received."""
        ...


class Reports:
    """Collects the reports of safety nodes and gates; other diagnostics are left out."""

    def __init__(self) -> None:
        """Start without any."""
        self._heard: dict[str, _Heard] = {}

    def take(self, message: Any) -> None:
        """Take a ``diagnostic_msgs/DiagnosticArray``."""
        for status in message.status:
            name, _, part = status.name.partition(": ")
            values = {pair.key: printable(pair.value) for pair in status.values}
            if kind := kind_of(status):
                heard = self._heard.setdefault(name, _Heard())
                heard.reports += 1
                heard.state = _node_state(status, kind, values)
            elif name in self._heard and part.startswith("action "):
                action = part.removeprefix("action ")
                is_active = level_of(status) != LEVELS[0]
                self._heard[name].actions[action] = _active(action, values) if is_active else None

    def complete(self) -> frozenset[str]:
        """Return the nodes of which a whole report was received."""
        return frozenset(name for name, heard in self._heard.items() if heard.is_complete)

    def incomplete(self) -> frozenset[str]:
        """Return the nodes of which only a part of a report was received."""
        return frozenset(self._heard) - self.complete()

    def states(self) -> tuple[NodeState, ...]:
        """Return the last states of the nodes with whole reports, sorted by name."""
        return tuple(_with_actions(self._heard[name]) for name in sorted(self.complete()))


def robot_state(observer: Observer, node: str | None, timeout: float) -> RobotState:
    """Return what the safety nodes and gates report.

    Args:
        observer: the node that listens.
        node: the full name of the only one to wait for; ``None`` for all of them.
        timeout: seconds after which those that have not reported are silent.
    """
    reports, deadline = Reports(), time.monotonic() + timeout
    listener = DiagnosticsListener(observer, reports.take)
    if node is not None:
        observer.until(lambda: listener.listen() and node in reports.complete(), deadline)
        found = tuple(state for state in reports.states() if state.node == node)
        is_silent = not found and node in reporting_nodes(observer)
        return RobotState(found, (node,) if is_silent else ())
    observer.settled(lambda: listener.listen() and awaited(observer, reports), deadline)
    observer.until(lambda: awaited(observer, reports) <= reports.complete(), deadline)
    silent = awaited(observer, reports) - reports.complete()
    return RobotState(reports.states(), tuple(sorted(silent)))


class DiagnosticsListener:
    """Subscribes to each topic of diagnostics once it is in the graph."""

    def __init__(self, observer: Observer, take: Callable[[Any], None]) -> None:
        """Start without subscriptions; ``take`` is called with each message."""
        self._observer = observer
        self._take = take
        self._topics: set[str] = set()

    def listen(self) -> bool:
        """Subscribe to new topics; return whether there are any, old or new."""
        from diagnostic_msgs.msg import DiagnosticArray

        for topic in topics_of_diagnostics(self._observer) - self._topics:
            self._topics.add(topic)
            node = self._observer.node
            node.create_subscription(DiagnosticArray, topic, self._take, DEPTH)
        return bool(self._topics)


def awaited(observer: Observer, reports: Completeness) -> frozenset[str]:
    """Return the nodes whose reports are needed: those known to be safety nodes or gates.

    A gate without heartbeat is recognized by its report alone.
    """
    known = nodes_of_heartbeats(observer) & reporting_nodes(observer)
    return frozenset(known) | reports.complete() | reports.incomplete()


def kind_of(status: Any) -> Kind | None:
    """Return whose status of the node itself this is; ``None`` for other statuses and nodes.

    What aggregators pass on keeps its hardware, and gets a name that no node has.
    """
    return _HARDWARE.get(status.hardware_id) if NODE.fullmatch(status.name) else None


def level_of(status: Any) -> str:
    """Return the level of a status, one of :data:`LEVELS`."""
    return LEVELS[min(status.level[0], len(LEVELS) - 1)]


def _node_state(status: Any, kind: Kind, values: Mapping[str, str]) -> NodeState:
    message, since = printable(status.message), values.get("since", "")
    return NodeState(status.name, kind, level_of(status), message, since)


def _active(name: str, values: Mapping[str, str]) -> ActiveAction:
    behaviour, because, since = (values.get(key, "") for key in ("cause", "because", "since"))
    return ActiveAction(name, behaviour, because, since)


def _with_actions(heard: _Heard) -> NodeState:
    state = heard.state
    assert state is not None
    actions = tuple(action for action in heard.actions.values() if action is not None)
    return NodeState(state.node, state.kind, state.level, state.message, state.since, actions)
