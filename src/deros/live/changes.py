"""What has changed since one looked at the safety nodes and gates last: a line, or an object."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from typing import Any, Literal

from deros.live.watched import CONDITIONS, WatchedAction, WatchedEvent, WatchedNode, WatchedRule

What = Literal["node", "action", "rule", "event"]


@dataclass(frozen=True)
class Change:
    """A change of a node, an action or a rule; or an event.

    Attributes:
        node: the full name of the node.
        what: has changed.
        name: of the action or rule, or the kind of the event; empty for the node itself.
        state: the level, ``active``, the verdict, ...; empty for events.
        text: why, in one line.
        details: all that is known, for programs.
    """

    node: str
    what: What
    name: str
    state: str
    text: str
    details: dict[str, Any]

    def line(self) -> str:
        """Return the change in one line."""
        name = f"{self.what} {self.name}" if self.name else ""
        return "  ".join(filter(None, (self.node, name, self.state, self.text)))

    def as_object(self) -> dict[str, Any]:
        """Return the change for JSON."""
        return {"node": self.node, "what": self.what, **self.details}


class Changes:
    """Compares each state with the one before."""

    def __init__(self, events: int) -> None:
        """Start without a state.

        Args:
            events: how many of the events before the start are given.
        """
        self._events = events
        self._last: dict[tuple[str, str, str], object] = {}
        self._given: dict[str, int] = {}

    def states(self, nodes: Sequence[WatchedNode]) -> Iterator[Change]:
        """Yield what is new of nodes, actions and rules, in their order.

        Values alone are no change: they differ in each report.
        """
        for node in nodes:
            yield from self._new("", node_change(node), _node_key(node))
            if node.silent_s is None:
                for action in node.actions:
                    change = action_change(node.node, action)
                    key = (action.message, action.behaviour, action.because)
                    yield from self._new(f"action {action.name}", change, key)
                for rule in node.rules:
                    yield from self._new(rule.name, rule_change(node.node, rule), rule.verdict)

    def events(self, node: str, taken: Sequence[WatchedEvent], total: int) -> Iterator[Change]:
        """Yield the events that have not been given yet.

        Args:
            node: whose events they are.
            taken: the last ones, the oldest first.
            total: how many there have been, dropped ones included.
        """
        count = total - self._given.get(node, max(total - self._events, 0))
        self._given[node] = total
        yield from map(event_change, taken[max(len(taken) - count, 0) :])

    def _new(self, part: str, change: Change, key: object) -> Iterator[Change]:
        place = change.node, change.what, part
        if place not in self._last or self._last[place] != key:
            self._last[place] = key
            yield change


def as_object(node: WatchedNode) -> dict[str, Any]:
    """Return all that is known of a node, for JSON."""
    return {
        "node": node.node,
        **node_change(node).details,
        "actions": [action_change(node.node, action).details for action in node.actions],
        "rules": [rule_change(node.node, rule).details for rule in node.rules],
    }


def node_change(node: WatchedNode) -> Change:
    """Return the state of a node."""
    if node.silent_s is None:
        state, text = node.level, node.message
    else:
        state, text = "silent", silence(node)
    details = {
        "kind": node.kind,
        "level": node.level,
        "message": node.message,
        "since_s": _rounded(node.since_s),
        "silent_s": _rounded(node.silent_s),
        "inputs": [asdict(each) | {"age_s": _rounded(each.age_s)} for each in node.inputs],
    }
    return Change(node.node, "node", "", state, text, details)


def silence(node: WatchedNode) -> str:
    """Return for how long a node has been silent, and what it reported last."""
    how_long = duration(node.silent_s)
    if node.kind is None:
        return f"runs, but has not reported for {how_long}"
    return f"no report for {how_long}; the last: {node.message}"


def action_change(node: str, action: WatchedAction) -> Change:
    """Return the state of an action."""
    details = asdict(action) | {"since_s": _rounded(action.since_s)}
    return Change(node, "action", action.name, action.message, why(action), details)


def why(action: WatchedAction) -> str:
    """Return what has changed an action: the behaviour, and the cause."""
    return ": ".join(filter(None, (action.behaviour, action.because)))


def rule_change(node: str, rule: WatchedRule) -> Change:
    """Return the verdict of a rule."""
    details = asdict(rule) | {
        "values": dict(rule.values),
        "since_s": _rounded(rule.since_s),
        "next": [asdict(each) | {"in_s": _rounded(each.in_s)} for each in rule.next],
    }
    return Change(node, "rule", rule.name, rule.verdict, rule.cause or terms(rule), details)


def terms(rule: WatchedRule) -> str:
    """Return the terms of a rule with their values; its condition if it reads none."""
    return ", ".join(f"{term} {value}" for term, value in rule.values) or rule.text


def outlook(rule: WatchedRule) -> str:
    """Return what a rule becomes and when; in parentheses if no message may come until then."""
    for each in rule.next:
        text = f"{each.verdict} in {duration(each.in_s)}"
        return text if each.condition == CONDITIONS[0] else f"({text})"
    return ""


def event_change(event: WatchedEvent) -> Change:
    """Return an event."""
    details = asdict(event) | {"values": dict(event.values)}
    del details["node"]
    return Change(event.node, "event", event.kind, "", event.message, details)


def duration(seconds: float | None) -> str:
    """Return a duration for people: ``2.1 s``, ``3 min 5 s``, ``2 h 0 min``."""
    if seconds is None:
        return ""
    if seconds < 60:
        return f"{int(seconds * 10) / 10:.1f} s"
    minutes, rest = divmod(int(seconds), 60)
    if minutes < 60:
        return f"{minutes} min {rest} s"
    return f"{minutes // 60} h {minutes % 60} min"


def _node_key(node: WatchedNode) -> object:
    return "silent" if node.silent_s is not None else (node.level, node.message)


def _rounded(seconds: float | None) -> float | None:
    return None if seconds is None else round(seconds, 3)
