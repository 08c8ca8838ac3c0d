"""Plays a timeline, and says what differs from it, and why."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from typing import Any, NamedTuple

from deros.diagnostics import Span
from deros.interfaces.fields import FieldPath
from deros.interfaces.store import InterfaceStore
from deros.rules.engine.engine import Engine, Event
from deros.rules.engine.explain import Explanation
from deros.rules.engine.state import LeafValue
from deros.rules.program import walk
from deros.rules.program.ir import Behaviour, Program, Trigger
from deros.simulation.gate_simulation import GateAnswer, GateSimulation
from deros.simulation.simulate import Explained, event_line, play_all
from deros.simulation.timelines.cells import ANSWERS
from deros.simulation.timelines.coverage import Coverage
from deros.simulation.timelines.timeline import (
    Command,
    Effect,
    Happening,
    Moment,
    Timeline,
    decimal,
)
from deros.simulation.trace import TraceLine, TraceTime, start_of

OCCASIONS = frozenset({"command_refused", "gate_reset", "gate_reset_refused"})
"""The events of gates that happen at a time; all others last until the next one."""

_EXPLAINED = 10
"""So many missing effects of a timeline are explained: each takes playing it once more."""

_RELATIVE, _ABSOLUTE = 1e-9, 1e-12
EFFECTS = {"trigger": "", "reset": " reset", "refused": " refused"}
"""What stands behind an action in a cell, by what happens to it."""

EVENTS = {event: word for word, event in ANSWERS.items()}
"""What a cell says of a gate, by the event."""


@dataclass(frozen=True, slots=True)
class Difference:
    """Something that a timeline expects and that did not happen, or the other way round.

    Attributes:
        t_ns: when.
        span: the cell that expects it; of what no cell expects, the timeline.
        expected: what was expected; empty: nothing.
        actual: what happened instead; empty: nothing.
        why: the reasons, one a text.
    """

    t_ns: int
    span: Span
    expected: str
    actual: str
    why: tuple[str, ...]

    @property
    def text(self) -> str:
        """What differs, as a sentence."""
        at = f"at {decimal(self.t_ns)} s"
        if not self.expected:
            return f"{at} {self.actual}, which no row expects"
        if not self.actual:
            return f"{at} {self.expected} is expected, and does not happen"
        return f"{at} {self.expected} is expected, but {self.actual}"


@dataclass(frozen=True, slots=True)
class Outcome:
    """What playing a timeline shows: it passes without differences."""

    timeline: Timeline
    differences: tuple[Difference, ...]


class _Observed:
    """The reference engine, which is observed after each event."""

    def __init__(self, engine: Engine, coverage: Coverage | None) -> None:
        self.engine = engine
        self.events = engine.events
        self._coverage = coverage

    @property
    def next_deadline(self) -> int | None:
        return self.engine.next_deadline

    @property
    def waiting(self) -> bool:
        return self.engine.waiting

    def message(self, t_ns: int, topic: str, leaves: Mapping[int, LeafValue]) -> list[Event]:
        return self._observed(self.engine.message(t_ns, topic, leaves))

    def advance(self, t_ns: int) -> list[Event]:
        return self._observed(self.engine.advance(t_ns))

    def reset(self, t_ns: int) -> bool:
        return self.engine.reset(t_ns)

    def enable(self, t_ns: int, behaviour: str, enabled: bool) -> list[Event]:
        return self._observed(self.engine.enable(t_ns, behaviour, enabled))

    def explain(self) -> Explanation:
        return self.engine.explain()

    def _observed(self, events: list[Event]) -> list[Event]:
        if self._coverage is not None:
            self._coverage.observe(self.engine)
        return events


class _Happened(NamedTuple):
    """An event of the monitor, with its causes."""

    explained: Explained

    @property
    def happening(self) -> Happening:
        event = self.explained.event
        return event.t_ns, event.action, event.kind


class Player:
    """Plays timelines of one program.

    Attributes:
        file: where its rules stand.
        program: the rules.
        store: the message definitions.
        coverage: what was seen in all of them.
        played: how many were played.
    """

    def __init__(
        self, file: str, program: Program, store: InterfaceStore, grace_ns: int = 0
    ) -> None:
        """Play the rules of ``program``; inputs may be late by ``grace_ns`` at the start."""
        self.file = file
        self.program = program
        self.store = store
        self.coverage = Coverage(program)
        self.played = 0
        self._grace_ns = grace_ns

    def play(self, timeline: Timeline, lines: Sequence[TraceLine]) -> Outcome:
        """Play a timeline with the lines of its trace."""
        self.played += 1
        lines = _with_times(timeline, lines)
        lines = lines[: _count(lines, timeline.until)]
        start_ns = start_of(lines)
        monitor = _Observed(Engine(self.program, start_ns, self._grace_ns), self.coverage)
        gates = None
        if timeline.commands:
            gates = GateSimulation(self.program, self.store, start_ns=start_ns, report_all=True)
        happened: list[_Happened] = []
        answers: list[GateAnswer] = []
        for each in play_all(monitor, lines, timeline.until.t_ns, gates):
            if isinstance(each, GateAnswer):
                answers.append(each)
            elif each.event.kind != "clock_step":
                happened.append(_Happened(each))
        differences = [*self._effects(timeline, lines, happened)]
        differences += _commands(timeline.commands, answers)
        return Outcome(timeline, tuple(sorted(differences, key=lambda each: each.t_ns)))

    def _effects(
        self, timeline: Timeline, lines: Sequence[TraceLine], happened: Sequence[_Happened]
    ) -> Iterator[Difference]:
        expected = [each.happening for each in timeline.effects]
        actual = [each.happening for each in happened]
        if expected == actual:
            return
        unexpected = _without(happened, expected)
        missing = _without(timeline.effects, actual)
        if not missing and not unexpected:
            yield from _order(timeline, happened)
        for number, each in enumerate(missing):
            why = self._why_not(lines, each, happened) if number < _EXPLAINED else ()
            when = _nearest(each, unexpected)
            yield Difference(each.moment.t_ns, each.span, _named(each.happening), when, why)
        for one in unexpected:
            event, causes = one.explained.event, one.explained.causes
            line = event_line(event, causes).partition(" ")[2]
            span = timeline.span
            yield Difference(event.t_ns, span, "", f"{_named(one.happening)} happens", (line,))

    def _why_not(
        self, lines: Sequence[TraceLine], effect: Effect, happened: Sequence[_Happened]
    ) -> tuple[str, ...]:
        """Return why something did not happen: the state of the rules at that moment."""
        engine = self._at(lines, effect.moment)
        action = next(each for each in self.program.actions if each.name == effect.action)
        if effect.kind != "trigger":
            is_active = engine.is_active(action)
            return (f"{action.name} is {'active' if is_active else 'not active'} then",)
        callers = [each for each in walk.behaviours(self.program) if _runs(each, action.index)]
        if not callers:
            return (f"no behaviour has the action {action.name}",)
        until_ns = effect.moment.t_ns
        before = [each.explained.event for each in happened if each.happening[0] <= until_ns]
        return tuple(_state(engine, each, before) for each in callers)

    def _at(self, lines: Sequence[TraceLine], moment: Moment) -> Engine:
        """Return a monitor that has played a timeline up to a moment."""
        lines = lines[: _count(lines, moment)]
        engine = Engine(self.program, start_of(lines), self._grace_ns)
        for _ in play_all(engine, lines, moment.t_ns):
            pass
        return engine


def _with_times(timeline: Timeline, lines: Sequence[TraceLine]) -> list[TraceLine]:
    """Return lines with the last times that rows name before each step back of the clock.

    The clock runs on to these before it steps back, although no message shows it.
    """
    latest: dict[int, int] = {}
    moments = [each.moment for each in timeline.effects]
    for moment in [*moments, *(each.moment for each in timeline.commands)]:
        if moment.steps < timeline.until.steps:
            latest[moment.steps] = max(moment.t_ns, latest.get(moment.steps, 0))
    found = list(lines)
    for steps, t_ns in latest.items():
        found.insert(_count(found, Moment(steps, t_ns)), TraceTime(t_ns))
    return found


def _count(lines: Sequence[TraceLine], moment: Moment) -> int:
    """Return how many lines come up to a moment."""
    now = Moment(0, 0)
    for number, line in enumerate(lines):
        now = Moment(now.steps + (line.t_ns < now.t_ns), line.t_ns)
        if now > moment:
            return number
    return len(lines)


def _without(found: Sequence[Any], others: Iterable[Happening]) -> list[Any]:
    """Return what has no partner among others, each of which is the partner of one."""
    rest = Counter(others)
    left = []
    for each in found:
        if rest[each.happening]:
            rest[each.happening] -= 1
        else:
            left.append(each)
    return left


def _nearest(effect: Effect, others: Sequence[_Happened]) -> str:
    """Return when the same happens instead, if it does at another time."""
    t_ns, *what = effect.happening
    times = [each.happening[0] for each in others if [*each.happening[1:]] == what]
    if not times:
        return ""
    return f"happens at {decimal(min(times, key=lambda each: abs(each - t_ns)))} s"


def _order(timeline: Timeline, happened: Sequence[_Happened]) -> Iterator[Difference]:
    """Yield the first place where the same things happen in another order."""
    for effect, one in zip(timeline.effects, happened, strict=True):
        if effect.happening != one.happening:
            expected, actual = _named(effect.happening), _named(one.happening)
            why = ("actions run in the order in which the behaviours are written",)
            yield Difference(
                effect.moment.t_ns, effect.span, expected, f"{actual} comes before it", why
            )
            return


def _named(happening: Happening) -> str:
    """Return what happens as a table says it."""
    _, action, kind = happening
    return f"'{action}{EFFECTS[kind]}'"


def _runs(behaviour: Behaviour, action: int) -> bool:
    return any(isinstance(each, Trigger) and each.action == action for each in behaviour.body)


def _state(engine: Engine, behaviour: Behaviour, events: Sequence[Event]) -> str:
    """Return why a behaviour does not act at the last event of an engine."""
    name = behaviour.name
    if not engine.is_enabled(behaviour):
        return f"{name} is disabled"
    if engine.holds(behaviour) is not True:
        verdict = "is false" if engine.holds(behaviour) is False else "is unknown"
        return f"{name} {verdict}: {'; '.join(engine.against(behaviour))}"
    acted = [each.t_ns for each in events if each.behaviour == name and each.kind == "trigger"]
    since = f", it has acted at {decimal(acted[-1])} s" if acted else ""
    return f"{name} is true already, and acts when it turns true{since}"


# Gates --------------------------------------------------------------------------------------------


def _commands(expected: Sequence[Command], answers: Sequence[GateAnswer]) -> Iterator[Difference]:
    """Yield what gates do otherwise."""
    for command in expected:
        told = [each for each in _until(answers, command.moment) if each.gate == command.gate]
        published = [each for each in told if each.event not in OCCASIONS]
        last = published[-1] if published else None
        if command.event in OCCASIONS:
            now = [EVENTS[each.event] for each in told if each.t_ns == command.moment.t_ns]
            if EVENTS[command.event] not in now:
                actual = ", ".join(f"'{each}'" for each in dict.fromkeys(now)) or "nothing"
                yield _differs(command, EVENTS[command.event], f"{actual} happens", last)
        elif last is None:
            yield _differs(command, _shown(command), "it has published nothing", last)
        elif command.event:
            if last.event != command.event:
                actual = f"it is '{EVENTS[last.event]}'"
                yield _differs(command, _shown(command), actual, last)
        else:
            value = _field(last.message, command.path)
            if not _is_equal(value, command.value):
                yield _differs(command, _shown(command), f"it is {value}", last)


def _until(answers: Sequence[GateAnswer], moment: Moment) -> Iterator[GateAnswer]:
    """Yield the answers up to a moment."""
    now = Moment(0, 0)
    for each in answers:
        now = Moment(now.steps + (each.t_ns < now.t_ns), each.t_ns)
        if now > moment:
            return
        yield each


def _differs(command: Command, expected: str, actual: str, last: GateAnswer | None) -> Difference:
    why = last.why if last is not None else ()
    text = f"{command.gate} '{expected}'"
    return Difference(command.moment.t_ns, command.span, text, actual, why)


def _shown(command: Command) -> str:
    if command.event:
        return EVENTS[command.event]
    path = ".".join(map(str, command.path))
    return f"{path} = {command.value}"


def _field(message: Any, path: FieldPath) -> Any:
    """Return a field of a command; ``None`` if it has none of that name."""
    try:
        for step in path:
            message = message[step]
    except (KeyError, IndexError, TypeError):
        return None
    return message


def _is_equal(actual: Any, expected: Any) -> bool:
    """Return whether values are equal, numbers to nine digits."""
    if isinstance(actual, bool) or isinstance(expected, bool):
        return actual is expected
    if isinstance(actual, int | float) and isinstance(expected, int | float | Decimal):
        return math.isclose(actual, expected, rel_tol=_RELATIVE, abs_tol=_ABSOLUTE)
    return bool(actual == expected)
