"""Driving the reference engine and a generated C monitor side by side."""

from __future__ import annotations

import math
import struct
from array import array
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any, cast

from deros.generators.monitor.c.code.handlers import Parameter
from deros.rules.engine import early
from deros.rules.engine.engine import Engine, Event, EventKind
from deros.rules.engine.evaluate import evaluate_value
from deros.rules.engine.state import LeafValue
from deros.rules.program.ir import Scalar
from deros.rules.program.operators import Verdict
from tests.support.c_library import Library
from tests.support.monitors import ORDINARY_START, START_NS, call, remark, timed
from tests.support.strategies import Start, Step

KINDS: tuple[EventKind, ...] = ("trigger", "reset", "refused", "clock_step")
NEVER = 2**63 - 1


@dataclass(frozen=True)
class Known:
    """The state of a monitor after a call, as far as both kinds of monitors report it.

    Attributes:
        verdicts: of each rule, with the time when it last became true or ceased to be.
        conditions: of each behaviour, with all around it.
        active: of each action that can be reset.
        values: of each value that conditions compare, ``None`` for unknown.
    """

    verdicts: tuple[tuple[Verdict, int], ...]
    conditions: tuple[Verdict, ...]
    active: tuple[bool, ...]
    values: tuple[Scalar | None, ...]


class CMonitor:
    """One monitor of a library, with the methods of the reference engine.

    Attributes:
        events: all that has happened since the start, in order, with the line of each.
        known: what it knows.
        next_deadline: when to call :meth:`advance` at the latest.
        waiting: whether an input waits for its first message and is not missing yet.
    """

    def __init__(
        self,
        library: Library,
        number: int,
        start_ns: int = 0,
        start: Start = ORDINARY_START,
    ) -> None:
        """Start the monitor of that number."""
        self._library = library
        self._number = number
        self._view = library.units[number].view
        self._program = library.units[number].program
        self.events: list[tuple[Event, int]] = []
        self.next_deadline: int | None = None
        self.waiting = False
        self._handlers = {
            each.handler.topic: (200 + n, each.handler.parameters)
            for n, each in enumerate(self._view.messages)
        }
        self._optional = {name: 100 + n for n, (name, _, _) in enumerate(self._view.optional)}
        latched = [each.name in start.latched for each in self._view.actions if each.latched]
        library.begin(number)
        tunables = {each.name: each.default for each in self._program.tunables}
        constants = map(_bits, (tunables | dict(start.constants)).values())
        valid = self._call(0, start_ns, start.grace_ns, *constants, *latched)
        assert valid == bool(tunables)

    def message(self, t_ns: int, topic: str, leaves: Mapping[int, LeafValue]) -> None:
        """Take a message."""
        operation, parameters = self._handlers[topic]
        words = [word for each in parameters for word in _words(each, leaves[each.leaves[0]])]
        self._call(operation, t_ns, *words)

    def advance(self, t_ns: int) -> None:
        """Settle all that is due up to and including ``t_ns``."""
        due = self._call(1, t_ns)
        assert due == (NEVER if self.next_deadline is None else self.next_deadline)

    def reset(self, t_ns: int) -> bool:
        """Reset every latched action that is active; return whether none was refused."""
        if not self._view.has_latched:  # C has no such function then
            self.advance(t_ns)
            return True
        return bool(self._call(2, t_ns))

    def enable(self, t_ns: int, behaviour: str, enabled: bool) -> None:
        """Enable or disable an optional behaviour."""
        self._call(self._optional[behaviour], t_ns, enabled)

    def _call(self, *words: int) -> int:
        answer = iter(self._library.step(self._number, array("q", words)))
        while next(answer):
            self.events.append(self._event(answer))
        result = next(answer)
        due = next(answer)
        self.next_deadline = None if due == NEVER else due
        self.waiting = bool(next(answer))
        self.known = self._knowledge(answer)
        assert next(answer, None) is None
        return result

    def _event(self, answer: Iterator[int]) -> tuple[Event, int]:
        t_ns, kind, site = next(answer), KINDS[next(answer)], next(answer)
        if site < 0:
            return Event(t_ns, kind), 0
        action, behaviour, line, count = (next(answer) for _ in range(4))
        arguments = tuple(_argument(answer) for _ in range(count))
        name = self._program.actions[action].name
        within = None if behaviour < 0 else self._view.behaviour_names[behaviour][0]
        event = Event(t_ns, kind, name, within, arguments)
        if kind == "refused":
            event = self._refused(event, action, answer)
        return event, line

    def _refused(self, event: Event, action: int, answer: Iterator[int]) -> Event:
        """Add what the conditions of the behaviours were when the reset was refused."""
        holds = [(False, None, True)[next(answer)] for _ in self._view.layout.conditions]
        names = [name for name, _ in self._view.behaviour_names]
        callers = self._program.actions[action].triggered_by
        found = early.refusing(callers, early.early_ones(self._view.program), holds)
        holding, unknown, coming = (tuple(names[each] for each in kind) for kind in found)
        return replace(event, holding=holding, unknown=unknown, coming=coming)

    def _knowledge(self, answer: Iterator[int]) -> Known:
        layout = self._view.layout
        verdicts: list[tuple[Verdict, int]] = []
        for _ in layout.verdicts:
            verdict = (False, None, True)[next(answer)]
            verdicts.append((verdict, next(answer)))
        conditions = tuple((False, None, True)[next(answer)] for _ in layout.conditions)
        active = tuple(bool(next(answer)) for _ in layout.active)
        values: list[Scalar | None] = []
        for term in layout.terms.values():
            known, word = next(answer), next(answer)
            value: Scalar = _double(word) if term.type == "double" else word
            if term.type == "uint64_t":
                value = word % 2**64
            elif term.texts:  # which of those that it is compared with, if any
                value = ("", *term.texts)[word] if word else ""
            values.append(value if known else None)
        return Known(tuple(verdicts), conditions, active, tuple(values))


def compare(
    library: Library, number: int, steps: Iterable[Step], start: Start = ORDINARY_START
) -> None:
    """Drive the engine and a C monitor with the same calls; they must answer alike at each.

    The engine computes with the mathematical library that C computes with.

    Raises:
        AssertionError: they do not.
    """
    unit = library.units[number]
    remark(f"{start}")
    engine = Engine(unit.program, START_NS, start.grace_ns, start.latched, dict(start.constants))
    monitor = CMonitor(library, number, START_NS, start)
    earliest = 0 if any(each.timeout_ns == 0 for each in unit.program.inputs) else 1
    for t_ns, step in timed(steps):
        remark(f"at {t_ns} {step}")
        assert call(cast("Engine", monitor), t_ns, step) == call(engine, t_ns, step)
        lines = [each.span.line if each.span else 0 for each in engine.events]
        assert monitor.events == list(zip(engine.events, lines, strict=True))
        assert monitor.waiting == engine.waiting
        assert monitor.known == known_of(engine, monitor)
        _compare_deadlines(engine.next_deadline, monitor.next_deadline, earliest + t_ns)


def known_of(engine: Engine, monitor: CMonitor) -> Known:
    """Return what an engine knows, in the terms of a monitor of the same program."""
    state, layout = engine._state, monitor._view.layout
    values: list[Scalar | None] = []
    for term in layout.terms.values():
        value = evaluate_value(term.value, state)
        if term.texts and value is not None and value not in term.texts:
            value = ""
        values.append(value)
    return Known(
        tuple(zip(state.verdicts, state.turned_ns, strict=True)),
        tuple(state.holds),
        tuple(state.active[index] for index in layout.active),
        tuple(values),
    )


def _compare_deadlines(reference: int | None, generated: int | None, earliest_ns: int) -> None:
    """The monitor may ask to be called in vain, but never too late, nor for what is past."""
    if reference is not None:
        assert generated is not None
        assert generated <= reference
    assert generated is None or generated >= earliest_ns


# The words of arguments ---------------------------------------------------------------------------


def _words(parameter: Parameter, value: Any) -> Iterator[int]:
    """Yield the words of the arguments that stand for one field of a message."""
    absent = value is None
    match parameter.form:
        case "value":
            yield _word(parameter.declarations[0].split()[0], value)
        case "text":
            data = b"" if absent else value.encode()
            yield len(data)
            yield from data
        case "given":
            pass
        case "count":
            yield 0 if absent else len(value)
        case _:
            elements = () if absent else value
            yield len(elements)
            yield from (_word(parameter.element, each) for each in elements)
    if parameter.given:
        yield not absent


def _word(kind: str, value: Any) -> int:
    if kind in ("double", "float"):
        return _bits(math.nan if value is None else value)
    number = 0 if value is None else int(value)
    return number if number < 2**63 else number - 2**64


def _bits(value: float) -> int:
    (word,) = struct.unpack("q", struct.pack("d", value))
    return int(word)


def _double(word: int) -> float:
    (value,) = struct.unpack("d", struct.pack("q", word))
    return float(value)


def _argument(answer: Iterator[int]) -> Scalar:
    kind = next(answer)
    if kind == 3:
        return bytes(next(answer) for _ in range(next(answer))).decode()
    word = next(answer)
    values: tuple[Scalar, ...] = (bool(word), word, _double(word))
    return values[kind]
