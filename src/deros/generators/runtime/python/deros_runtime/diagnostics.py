"""Publishes the current state of a safety node on /diagnostics."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
import dataclasses
from dataclasses import dataclass
import itertools

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.node import Node

from .event_reporter import cause, HARDWARE_ID, shown
from .look_ahead import LookAhead, NextVerdict
from .one_shot_timer import NodeClock, OneShotTimer
from .report_types import Behaviour, Event, EventKind, Explanation, RuleState

OK, WARN = DiagnosticStatus.OK, DiagnosticStatus.WARN
ERROR, STALE = DiagnosticStatus.ERROR, DiagnosticStatus.STALE
SOON = 50_000_000  # ns from a change to its message, in which further changes are collected
CHUNK = 8  # statuses in one message: more would delay the monitor for too long
PAUSE = 1_000_000  # ns between the messages of one state


@dataclass(frozen=True)
class ActionState:
    """The state of an action, and what caused it."""

    lasts: bool  # whether it has a state, and is not just run
    active: bool = False
    cause: str = ''
    because: str = ''
    since: int | None = None
    runs: int = 0


class Diagnostics:
    """
    Publishes one status for the node, for each action, for each rule, and for all inputs.

    All of it is published regularly, and soon after a change.
    """

    def __init__(
        self,
        node: Node,
        steady: NodeClock,
        behaviours: Mapping[str, Behaviour],
        actions: Mapping[str, bool],
        publish: Callable[[DiagnosticArray], None],
        frequency: float,
        defer: Callable[[], int],
    ) -> None:
        """Set up; actions says of each action whether it has a state, defer is that of a timer."""
        self.faults: dict[str, str] = {}  # by what they are about
        self.actions = {name: ActionState(lasts) for name, lasts in actions.items()}
        self._node = node
        self._behaviours = behaviours
        self._publish = publish
        self._period = round(1e9 / frequency)
        self._rest: Iterator[DiagnosticStatus | None] | None = None
        self._again = False
        self._steady = steady
        self._timer = OneShotTimer(steady, self._fire, defer)

    def begin(
        self,
        explain: Callable[[], Explanation],
        holding: Callable[[], Sequence[str]],
        clock: NodeClock,
        summary: Callable[[], str],
        look_ahead: Callable[[], LookAhead | None],
        received: Callable[[], Mapping[str, int | None]],
    ) -> None:
        """
        Start publishing.

        explain returns the verdicts of the rules, holding the behaviours whose conditions hold,
        clock is theirs, and summary returns why the node does not watch all rules; empty if it
        does. look_ahead returns what becomes of the verdicts, None while no time passes, and
        received when the last message of each input came.
        """
        self._explain, self._holding = explain, holding
        self._clock, self._summary = clock, summary
        self._look_ahead, self._received = look_ahead, received
        self._timer.schedule(0)

    def changed(self) -> None:
        """Publish soon."""
        soon = self._steady.now() + SOON
        if not self._timer.is_scheduled or self._timer.due > soon:
            self._timer.schedule(soon)
        self._again = True

    def update(self, event: Event, explained: Explanation) -> None:
        """Update an action after an event of the monitor, which explained is about."""
        before = self.actions.get(event.action)
        if before is None or event.kind not in (EventKind.TRIGGER, EventKind.RESET):
            return
        active = event.kind == EventKind.TRIGGER
        runs = before.runs + active
        if before.active and active:
            after = dataclasses.replace(before, runs=runs)
        else:
            because = cause(event.behaviour, explained)
            after = ActionState(
                before.lasts, before.lasts and active, event.behaviour, because, event.t, runs
            )
        self.actions[event.action] = after

    def latched(self, action: str) -> None:
        """Show an action that was active before the start."""
        self.actions[action] = ActionState(True, active=True, cause='active before the start')

    def fault(self, subject: str, text: str) -> bool:
        """Set or, with an empty text, clear a fault; return whether this is a change."""
        if self.faults.get(subject, '') == text:
            return False
        self.faults.pop(subject, None)
        if text:
            self.faults[subject] = text
        self.changed()
        return True

    def _fire(self) -> None:
        if self._rest is None:
            self._again = False
            self._rest = self._statuses()
        done = list(itertools.islice(self._rest, CHUNK))
        statuses = [status for status in done if status is not None]
        now = self._steady.now()
        if len(done) == CHUNK:
            self._timer.schedule(now + PAUSE)
        else:
            self._rest = None
            self._timer.schedule(now + (SOON if self._again else self._period))
        if statuses:
            message = DiagnosticArray(status=statuses)
            message.header.stamp = self._node.get_clock().now().to_msg()
            self._publish(message)

    def _statuses(self) -> Iterator[DiagnosticStatus | None]:
        """Yield all statuses, and None after other work that takes as long as one."""
        name = self._node.get_fully_qualified_name()
        now, origin = self._clock.now(), self._clock.origin
        rules, holding, received = self._explain().rules, self._holding(), self._received()
        ahead = self._look_ahead()
        steps = 0
        for _ in () if ahead is None else ahead.steps():
            steps += 1
            yield None
        yield from itertools.repeat(None, -steps % CHUNK)  # the messages are the same each time
        changes = {} if ahead is None else ahead.found
        yield self._node_status(name, rules)
        for action, state in self.actions.items():
            yield _action_status(f'{name}: action {action}', state, now, origin)
        blamed = {rule.name for behaviour in holding for rule in self._causes(behaviour, rules)}
        for place, rule in enumerate(rules):
            is_blamed, then = rule.name in blamed, changes.get(place, {})
            yield _rule_status(f'{name}: {rule.name}', rule, is_blamed, then, now, origin)
        if received:
            yield _input_status(f'{name}: inputs', received, now)

    def _causes(self, behaviour: str, rules: Sequence[RuleState]) -> list[RuleState]:
        """Return the rules that make a behaviour hold: the true ones, else all it names."""
        named = [rule for rule in rules if rule.name in self._behaviours[behaviour].rules]
        return [rule for rule in named if rule.value] or named

    def _node_status(self, name: str, rules: Sequence[RuleState]) -> DiagnosticStatus:
        reason = self._summary()
        level = ERROR if self.faults else WARN if reason else OK
        message = '; '.join(self.faults.values()) or reason or f'watching {len(rules)} rules'
        return _status(level, name, message, {'state': reason or 'watching', **self.faults})


def _action_status(name: str, state: ActionState, now: int, origin: int) -> DiagnosticStatus:
    message = 'active' if state.active else 'inactive'
    if not state.lasts:
        message = f'run {state.runs} times'
    values: dict[str, object] = {'runs': state.runs}
    if state.cause:
        values['cause'] = state.cause
    if state.because:
        values['because'] = state.because
    if state.since is not None:
        values |= _since(state.since, now, origin)
    return _status(WARN if state.active else OK, name, message, values)


def _rule_status(
    name: str,
    rule: RuleState,
    blamed: bool,
    ahead: Mapping[str, NextVerdict],
    now: int,
    origin: int,
) -> DiagnosticStatus:
    true = ERROR if blamed else WARN
    level = {None: STALE, False: ERROR if blamed else OK, True: true}[rule.value]
    values: dict[str, object] = {term: shown(value) for term, value in rule.reads}
    if rule.causes:
        values['cause'] = '; '.join(rule.causes)
    values |= {**_since(rule.since, now, origin), 'line': rule.line}
    for case, change in ahead.items():
        left = max(change.at - now, 0) / 1e9
        values[case] = f'{shown(change.value)} in {left:.3f} s'
    return _status(level, name, f'{shown(rule.value)}: {rule.text}', values)


def _input_status(name: str, received: Mapping[str, int | None], now: int) -> DiagnosticStatus:
    """Return the age of the last message of each input; a step back of the clock forgets it."""
    ages = {
        each: None if at is None or at > now else (now - at) / 1e9 for each, at in received.items()
    }
    never = [each for each, age in ages.items() if age is None]
    message = f'never received: {", ".join(never)}' if never else 'all received'
    values = {each: 'never' if age is None else f'{age:.3f} s ago' for each, age in ages.items()}
    return _status(OK, name, message, values)


def _since(since: int, now: int, origin: int) -> dict[str, object]:
    return {'since': f'{max(now - since, 0) / 1e9:.3f} s ago', 'since_ns': since + origin}


def _status(
    level: bytes, name: str, message: str, values: Mapping[str, object]
) -> DiagnosticStatus:
    pairs = [KeyValue(key=key, value=str(value)) for key, value in values.items()]
    return DiagnosticStatus(
        level=level, name=name, message=message, hardware_id=HARDWARE_ID, values=pairs
    )
