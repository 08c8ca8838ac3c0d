"""What safety nodes and gates report as time goes on: verdicts, actions, events, silence."""

from __future__ import annotations

import re
import time
from collections import Counter, deque
from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass, field, replace
from typing import Any, Literal

from deros.live.observer import printable
from deros.live.states import DEPTH, LEVELS, NODE, Kind, kind_of, level_of

Verdict = Literal["true", "false", "unknown"]

SILENCE_S = 3.0
"""Seconds after which a node counts as silent: both kinds report every second by default."""

_TEXT_LIMIT = 2000
"""Characters of a text that are kept."""

_CUT = "\N{HORIZONTAL ELLIPSIS}"

_AGO = re.compile(r"(\d+(?:\.\d+)?) s ago")
_INTEGER = re.compile(r"-?\d{1,19}")
_IN = re.compile(r"(true|false|unknown) in (\d{1,12}\.\d{1,9}) s")

Condition = Literal["values stay", "no message comes"]

CONDITIONS: tuple[Condition, ...] = ("values stay", "no message comes")
"""What has to be the case for a rule to become what a node foretells, in the node's words."""

_OWN = ("since", "since_ns", "line", *(f"if {each}" for each in CONDITIONS))
"""Keys of a rule's status that are not terms."""

_INPUTS = "inputs"
"""The part of a report that is about inputs."""


@dataclass(frozen=True)
class WatchedNext:
    """What a rule becomes next, as the safety node foretells it.

    Attributes:
        condition: what has to be the case until then.
        verdict: what it becomes.
        in_s: in how many seconds.
    """

    condition: Condition
    verdict: Verdict
    in_s: float


@dataclass(frozen=True)
class WatchedInput:
    """An input of the rules.

    Attributes:
        name: as in the rules.
        is_received: whether a message has come on its topic.
        age_s: for how many seconds at most no other has; ``None`` if that is unknown.
    """

    name: str
    is_received: bool
    age_s: float | None


@dataclass(frozen=True)
class WatchedRule:
    """A rule, as the safety node reports it.

    Attributes:
        name: of the entity and the rule.
        verdict: true, false or unknown.
        is_blamed: whether a behaviour that names it holds.
        text: the condition as written.
        values: the terms that it reads, with their values.
        cause: what makes it true; empty unless it is.
        since_s: for how many seconds the verdict has been so; ``None`` if that is unknown.
        next: what it becomes, by condition; without what is overdue, as messages have come since.
    """

    name: str
    verdict: Verdict
    is_blamed: bool
    text: str
    values: tuple[tuple[str, str], ...]
    cause: str
    since_s: float | None
    next: tuple[WatchedNext, ...] = ()


@dataclass(frozen=True)
class WatchedAction:
    """An action, as the safety node reports it.

    Attributes:
        name: of the action.
        is_active: whether it is.
        message: ``active``, ``inactive``, or how often it was run.
        behaviour: that changed it last, or why it is active otherwise; empty if nothing did.
        because: the cause at that time; empty if none is known.
        since_s: seconds since then; ``None`` if that is unknown.
    """

    name: str
    is_active: bool
    message: str
    behaviour: str
    because: str
    since_s: float | None


@dataclass(frozen=True)
class WatchedEvent:
    """An event of a safety node.

    Attributes:
        node: its full name.
        kind: such as ``trigger``; the kinds are those of the topic.
        level: one of :data:`deros.live.states.LEVELS`.
        message: what happened, in the words of the node.
        ros_time_ns: when it was reported, in ROS time; ``None`` if that is unknown.
        values: all values of the message.
    """

    node: str
    kind: str
    level: str
    message: str
    ros_time_ns: int | None
    values: tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class WatchedNode:
    """A safety node or gate at one moment.

    Attributes:
        node: its full name.
        kind: which of the two it is; ``None`` if it has never reported.
        level: that of its last report; ``unknown`` if there is none.
        message: of its last report.
        since_s: for how many seconds that is so; gates alone report it.
        silent_s: seconds since its last report, or since it was found if there is none; ``None``
            while it is not silent.
        actions: in the order of the rules.
        rules: in their order.
        inputs: in the order of the rules.
    """

    node: str
    kind: Kind | None
    level: str
    message: str
    since_s: float | None
    silent_s: float | None
    actions: tuple[WatchedAction, ...] = ()
    rules: tuple[WatchedRule, ...] = ()
    inputs: tuple[WatchedInput, ...] = ()


@dataclass(frozen=True)
class _Inputs:
    """The part of a report that is about all inputs."""

    inputs: tuple[WatchedInput, ...]


Part = WatchedRule | WatchedAction | _Inputs


@dataclass
class _Heard:
    """What was received from one node, and when."""

    state: WatchedNode
    reports: int = 0
    at: float = 0.0
    parts: dict[str, tuple[Part, float]] = field(default_factory=dict)
    current: set[str] = field(default_factory=set)

    def begin(self, state: WatchedNode, now: float) -> None:
        """Begin another report: what the last one did not contain is gone, after a restart."""
        self.reports += 1
        self.state, self.at = state, now
        self.parts = {name: part for name, part in self.parts.items() if name in self.current}
        self.current = set()

    def add(self, name: str, part: Part, now: float) -> None:
        """Add a part of the report."""
        self.at = now
        self.parts[name] = part, now
        self.current.add(name)

    def is_complete(self) -> bool:
        """Whether a whole report was received: that of a safety node ends where the next begins."""
        return self.state.kind == "gate" or self.reports > 1


class Watched:
    """Collects diagnostics and events; those of other nodes are left out."""

    def __init__(
        self, *, silence_s: float = SILENCE_S, now: Callable[[], float] = time.monotonic
    ) -> None:
        """Start without any.

        Args:
            silence_s: seconds without a report after which a node is silent.
            now: the steady time, in seconds.
        """
        self._silence_s = silence_s
        self._now = now
        self._heard: dict[str, _Heard] = {}
        self._expected: dict[str, float] = {}
        self._events: dict[str, deque[WatchedEvent]] = {}
        self._event_totals: Counter[str] = Counter()
        self.changes = 0
        """How many messages have been taken."""

    def take(self, message: Any) -> None:
        """Take a ``diagnostic_msgs/DiagnosticArray``."""
        now = self._now()
        for status in message.status:
            name, _, part = status.name.partition(": ")
            values = {_text(pair.key): _text(pair.value) for pair in status.values}
            if kind := kind_of(status):
                state = _node(name, kind, status, values)
                self._heard.setdefault(name, _Heard(state)).begin(state, now)
                self.changes += 1
            elif part and name in self._heard:
                part = _text(part)
                self._heard[name].add(part, _part(part, status, values), now)
                self.changes += 1

    def take_event(self, node: str, status: Any) -> None:
        """Take a ``diagnostic_msgs/DiagnosticStatus`` from the events of a node."""
        values = {_text(pair.key): _text(pair.value) for pair in status.values}
        stamp = values.get("ros_time_ns", "")
        event = WatchedEvent(
            node=node,
            kind=values.get("kind", ""),
            level=level_of(status),
            message=_text(status.message),
            ros_time_ns=int(stamp) if _INTEGER.fullmatch(stamp) else None,
            values=tuple(values.items()),
        )
        self._events.setdefault(node, deque(maxlen=DEPTH)).append(event)
        self._event_totals[node] += 1
        self.changes += 1

    def expect(self, nodes: Collection[str]) -> None:
        """Expect reports of the nodes that are in the graph, and of no others.

        Names that the middleware does not know yet are left out.
        """
        now, before = self._now(), self._expected
        self._expected = {n: before.get(n, now) for n in nodes if NODE.fullmatch(n)}

    def expected(self) -> frozenset[str]:
        """Return the nodes whose reports are expected."""
        return frozenset(self._expected)

    def complete(self) -> frozenset[str]:
        """Return the nodes of which a whole report was received."""
        return frozenset(name for name, heard in self._heard.items() if heard.is_complete())

    def incomplete(self) -> frozenset[str]:
        """Return the nodes of which only a part of a report was received."""
        return frozenset(self._heard) - self.complete()

    def safety_nodes(self) -> frozenset[str]:
        """Return the safety nodes that have reported: those with events."""
        return frozenset(
            name for name, heard in self._heard.items() if heard.state.kind == "safety node"
        )

    def events(self, node: str) -> tuple[WatchedEvent, ...]:
        """Return the events of a node, the oldest first."""
        return tuple(self._events.get(node, ()))

    def event_total(self, node: str) -> int:
        """Return how many events of a node have been taken, those that are not kept included."""
        return self._event_totals[node]

    def nodes(self) -> tuple[WatchedNode, ...]:
        """Return all nodes as they are now, sorted by name."""
        now = self._now()
        seen = {name: self._seen(heard, now) for name, heard in self._heard.items()}
        seen |= dict(self._unheard(now))
        return tuple(seen[name] for name in sorted(seen))

    def _seen(self, heard: _Heard, now: float) -> WatchedNode:
        quiet = now - heard.at
        is_silent = quiet >= self._silence_s
        parts = [_older(part, now - at, is_silent) for part, at in heard.parts.values()]
        return replace(
            heard.state,
            since_s=_plus(heard.state.since_s, quiet),
            silent_s=quiet if is_silent else None,
            actions=tuple(part for part in parts if isinstance(part, WatchedAction)),
            rules=tuple(part for part in parts if isinstance(part, WatchedRule)),
            inputs=tuple(
                each for part in parts if isinstance(part, _Inputs) for each in part.inputs
            ),
        )

    def _unheard(self, now: float) -> Iterator[tuple[str, WatchedNode]]:
        """Yield the nodes that were found and have never reported, once that takes too long."""
        for name, found in self._expected.items():
            quiet = now - found
            if name not in self._heard and quiet >= self._silence_s:
                yield name, WatchedNode(name, None, "unknown", "", None, quiet)


def _text(text: str) -> str:
    """Return a text of another process, fit to be shown."""
    return printable(text if len(text) <= _TEXT_LIMIT else f"{text[: _TEXT_LIMIT - 1]}{_CUT}")


def _since(values: dict[str, str]) -> float | None:
    found = _AGO.fullmatch(values.get("since", ""))
    return float(found[1]) if found else None


def _plus(since_s: float | None, more_s: float) -> float | None:
    return None if since_s is None else since_s + more_s


def _older(part: Part, by_s: float, is_silent: bool) -> Part:
    """Return a part of a report after some seconds; a silent node foretells nothing."""
    if isinstance(part, _Inputs):
        ages = (None if is_silent else _plus(each.age_s, by_s) for each in part.inputs)
        return _Inputs(
            tuple(replace(each, age_s=age) for each, age in zip(part.inputs, ages, strict=True))
        )
    older = replace(part, since_s=_plus(part.since_s, by_s))
    if isinstance(older, WatchedRule):
        left = (replace(each, in_s=each.in_s - by_s) for each in older.next)
        return replace(older, next=() if is_silent else tuple(n for n in left if n.in_s >= 0))
    return older


def _node(name: str, kind: Kind, status: Any, values: dict[str, str]) -> WatchedNode:
    return WatchedNode(name, kind, level_of(status), _text(status.message), _since(values), None)


def _next(values: dict[str, str]) -> Iterator[WatchedNext]:
    for condition in CONDITIONS:
        if found := _IN.fullmatch(values.get(f"if {condition}", "")):
            yield WatchedNext(condition, _verdict(found[1]), float(found[2]))


def _verdict(text: str) -> Verdict:
    return "true" if text == "true" else "false" if text == "false" else "unknown"


def _part(name: str, status: Any, values: dict[str, str]) -> Part:
    if name == _INPUTS:
        return _Inputs(tuple(_input(*each) for each in values.items()))
    if name.startswith("action "):
        return WatchedAction(
            name=name.removeprefix("action "),
            is_active=level_of(status) != LEVELS[0],
            message=_text(status.message),
            behaviour=values.get("cause", ""),
            because=values.get("because", ""),
            since_s=_since(values),
        )
    shown, _, text = _text(status.message).partition(": ")
    verdict = _verdict(shown)
    cause = values.pop("cause", "") if verdict == "true" else ""
    terms = tuple((key, value) for key, value in values.items() if key not in _OWN)
    is_blamed = level_of(status) == "error"
    then = tuple(_next(values))
    return WatchedRule(name, verdict, is_blamed, text, terms, cause, _since(values), then)


def _input(name: str, age: str) -> WatchedInput:
    found = _AGO.fullmatch(age)
    return WatchedInput(name, found is not None, float(found[1]) if found else None)
