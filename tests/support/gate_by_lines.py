"""A second reading of the lines of a gate, without any steps, to compare the engine with.

It evaluates the lines themselves whenever something happens, and shares only the functions for
messages with the engine. It aims at being right at a glance.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

from deros.interfaces.fields import FieldPath
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import INTEGER_RANGES, FieldType
from deros.rules.gates.gate_engine import Output, OutputKind
from deros.rules.program.bounds import as_float32
from deros.rules.program.commands import Message, is_finite, is_zero, limited, put, value_at, zero
from deros.rules.program.ir import (
    Action,
    Gate,
    GateLine,
    InputBound,
    Limit,
    Stop,
    StopField,
    TunedBound,
)


@dataclass(frozen=True, slots=True)
class Decision:
    """The result of the lines that apply: how to stop, if at all, and limits beside a zero.

    ``sender`` is the index of the line that sends something.
    """

    stop: Stop | None = None
    limits: Mapping[FieldPath, Limit] = field(default_factory=dict)
    sender: int | None = None


class GateByLines:
    """Runs one gate, with the interface of :class:`deros.rules.gates.gate_engine.GateEngine`.

    Attributes:
        outputs: everything published since the start, in order.
    """

    def __init__(
        self,
        gate: Gate,
        actions: Sequence[Action],
        store: InterfaceStore,
        start_ns: int = 0,
        constants: Mapping[str, float] | None = None,
    ) -> None:
        """Start at ``start_ns``; ``actions`` are those of the gate's rules."""
        self._constants = constants or {}
        self.outputs: list[Output] = []
        self._gate = gate
        self._actions = [each for each in actions if _names(gate, each)]
        self._store = store
        self._now_ns = self._called_ns = start_ns
        self._active: dict[int, bool]
        self._counter: int | None
        self._heartbeat_ns: int | None
        self._command_ns: int | None
        self._latched: set[int] = set()  # indices of lines
        self._good: dict[int, Message] = {}  # the last good command of each source
        self._source = 0  # whose command passed last
        self._is_timed = gate.sources[0].silent_ns is not None
        self._executed: Message | None = None  # the last command, while it is in effect
        self._stopped_with: Message | None = None  # the zeros that were published last
        self._has_past = False  # in which a command has come, and no silence
        self._fell_from: Message | None = None  # the one that was when the gate began to stop
        self._fell_on: dict[FieldPath, tuple[int, int, Any]] = {}  # what a limit has made of it
        self._course: list[tuple[int, Stop]] = []  # how it has stopped since, and from when
        self._stops = [i for i, line in enumerate(gate.lines) if line.stop]
        self._last_stop = self._stops[0] if self._stops else None
        self._waiting = [line for line in gate.lines if line.wait_ns]
        self._forget()
        self._hold()
        self._decision = Decision()
        self._zero_due_ns: int | None = start_ns  # whether it stops is decided then

    @property
    def next_deadline(self) -> int | None:
        """The earliest instant at which something can happen by itself, if there is one."""
        return min(self._deadlines(), default=None)

    @property
    def applying(self) -> tuple[bool, ...]:
        """Whether each condition that can hold commands back does, as of the last call."""
        lines = tuple(
            self._is_held if line.wait_ns else self._applies(line) for line in self._gate.lines
        )
        latched = tuple(
            index in self._latched and not lines[index]
            for index, line in enumerate(self._gate.lines)
            if line.until_reset
        )
        can_wait = self._gate.resume_on_zero or any(each.from_zero for each in self._gate.sources)
        waits = (self._is_waiting() and not self._is_stopped(),) if can_wait else ()
        unknown = (self._number(each) is None for each in self._gate.inputs)
        return (*lines, *latched, *waits, *unknown)

    # Events -------------------------------------------------------------------------------

    def command(self, t_ns: int, message: Message | None, source: int = 0) -> list[Output]:
        """Take a command (``None``: one that could not be decoded). Return what is published."""
        before = len(self.outputs)
        self._catch_up(t_ns)
        if message is not None and not is_finite(message):
            message = None
        self._spoken[source] = (t_ns, message)
        if message is not None:
            self._good[source] = message
        self._settle(source)
        return self.outputs[before:]

    def state(
        self, t_ns: int, topic: str, message: Message | None, *, is_trusted: bool = True
    ) -> list[Output]:
        """Take a message about the state of actions. Return what is published."""
        before = len(self.outputs)
        self._catch_up(t_ns)
        for each in self._actions:
            if each.binding is None or each.binding.topic != topic:
                continue
            if message is None:
                self._active.pop(each.index, None)
                if is_trusted:
                    self._known_since.setdefault(each.index, t_ns)
            else:
                active = value_at(message, each.binding.path) == each.binding.value
                if active or is_trusted:
                    self._active[each.index] = active
                if not active and is_trusted:
                    self._known_since.pop(each.index, None)
                if active and is_trusted:
                    self._known_since.setdefault(each.index, t_ns)
        self._settle()
        return self.outputs[before:]

    def reading(self, t_ns: int, topic: str, message: Message | None) -> list[Output]:
        """Take a message with numbers for limits. Return what is published."""
        before = len(self.outputs)
        self._catch_up(t_ns)
        self._read[topic] = (t_ns, message)
        self._settle()
        return self.outputs[before:]

    def heartbeat(self, t_ns: int, counter: int) -> list[Output]:
        """Take a heartbeat of the safety node. Return what is published."""
        before = len(self.outputs)
        self._catch_up(t_ns)
        is_alive = self._counter is not None and counter > self._counter
        self._counter = counter
        self._heartbeat_ns = t_ns if is_alive else None
        self._settle()
        return self.outputs[before:]

    def no_safety_node(self, t_ns: int) -> list[Output]:
        """Note that no node, or more than one, can be the safety node. Return what is published."""
        before = len(self.outputs)
        self._catch_up(t_ns)
        self._active.clear()
        self._known_since.clear()
        self._counter = self._heartbeat_ns = None
        self._settle()
        return self.outputs[before:]

    def reset(self, t_ns: int) -> tuple[int, ...]:
        """Take a reset. Return the indices of the lines that refuse it."""
        self._catch_up(t_ns)
        against = tuple(
            index
            for index, line in enumerate(self._gate.lines)
            if (line.lost or line.stop) and self._applies(line)
        )
        if not against:
            self._latched.clear()
            self._settle()
        return against

    def advance(self, t_ns: int) -> list[Output]:
        """Handle everything due up to and including ``t_ns``. Return what is published."""
        before = len(self.outputs)
        self._catch_up(t_ns)
        return self.outputs[before:]

    # Time ---------------------------------------------------------------------------------------

    def _deadlines(self) -> Iterator[int]:
        """Yield the future instants at which zeros are due or something becomes lost."""
        if self._zero_due_ns is not None:
            yield self._zero_due_ns
        speaking = self._speaking()
        if speaking is not None:
            silent_ns = self._gate.sources[speaking].silent_ns
            if silent_ns is not None:
                yield self._spoken[speaking][0] + silent_ns
        for each in self._gate.inputs:
            if each.timeout_ns is not None and self._number(each) is not None:
                yield self._read[each.topic][0] + each.timeout_ns
        for line in self._gate.lines:
            last_ns = self._last_ns(line)
            if line.lost_ns is not None and last_ns is not None:
                lost_at_ns = last_ns + line.lost_ns
                if lost_at_ns > self._now_ns:
                    yield lost_at_ns

    def _catch_up(self, t_ns: int) -> None:
        self._called_ns = t_ns
        if t_ns < self._now_ns:
            self._step_back(t_ns)
        while (due_ns := self.next_deadline) is not None and due_ns <= t_ns:
            self._now_ns = due_ns
            self._settle()
        self._now_ns = t_ns

    def _step_back(self, t_ns: int) -> None:
        self._now_ns = t_ns
        self._forget()
        self._decision = Decision()
        self._fell_from = None  # what was falling has no past now: it is zero at once
        self._has_past = False
        self._settle()

    def _forget(self) -> None:
        """Forget the actions, the heartbeat and the input; everything that can be lost is."""
        self._active = {}
        self._known_since: dict[int, int] = {}  # the actions that are known to be active
        self._moves = self._is_held = False
        self._wish_ns: int | None = None  # the first of the commands to move that are held back
        self._counter = None
        self._heartbeat_ns = None
        self._read: dict[str, tuple[int, Message | None]] = {}  # of each topic of numbers
        self._spoken: dict[int, tuple[int, Message | None]] = {}  # of each source, when and what
        self._passing: int | None = None  # the source whose commands pass
        self._has_taken_over = False  # a source that has to command zero first
        self._heartbeat_was_lost = self._is_lost("heartbeat")
        self._waits = self._gate.resume_on_zero

    # Lines -------------------------------------------------------------------------------

    def _last_ns(self, line: GateLine) -> int | None:
        if line.lost == "heartbeat":
            return self._heartbeat_ns
        if self._is_timed:
            return None  # the sources have the time
        spoken_ns, message = self._spoken.get(0, (0, None))
        return None if message is None else spoken_ns

    def _speaking(self) -> int | None:
        """Return the first source that has spoken within its time."""
        for index, (spoken_ns, _) in sorted(self._spoken.items()):
            silent_ns = self._gate.sources[index].silent_ns
            if silent_ns is None or self._now_ns - spoken_ns < silent_ns:
                return index
        return None

    def _listened_to(self) -> int | None:
        """Return the source whose commands pass: the one that speaks, unless it spoke nonsense."""
        speaking = self._speaking()
        return None if speaking is None or self._spoken[speaking][1] is None else speaking

    def _line_is_lost(self, line: GateLine) -> bool:
        """Return whether what a ``lost`` line names has been silent for its time."""
        if line.lost == "input" and self._is_timed:
            return self._listened_to() is None
        last_ns = self._last_ns(line)
        if last_ns is None:
            return True
        return line.lost_ns is not None and self._now_ns >= last_ns + line.lost_ns

    def _is_lost(self, what: Literal["heartbeat", "input"]) -> bool:
        """Return whether the gate has a line about ``what`` that applies."""
        return any(self._line_is_lost(each) for each in self._gate.lines if each.lost == what)

    def _applies(self, line: GateLine) -> bool:
        if line.is_standing or line.wait_ns:
            return False  # it is not one of those among which the first decides
        if line.action is None:
            return self._line_is_lost(line)
        if line.limits and (self._is_lost("heartbeat") or self._is_lost("input")):
            return False
        return self._active.get(line.action, True)

    def _is_stopped(self) -> bool:
        """Return whether a line that stops applies, or one is latched."""
        return self._stopping() is not None

    def _stopping(self) -> int | None:
        """Return the index of the first line that stops and applies or is latched."""
        lines = self._gate.lines
        found = (i for i in self._stops if i in self._latched or self._applies(lines[i]))
        return next(found, None)

    def _is_safe(self, command: Message) -> bool:
        """Return whether a command is one that a line stops with."""
        stops = [line.stop for line in self._gate.lines if line.stop]
        safe = [stop for stop in stops if stop.kind in ("zero", "send")] or [Stop()]
        return any(self._is_as(command, stop) for stop in safe)

    def _is_as(self, command: Message, stop: Stop) -> bool:
        """Return whether sending something else than zero in this form would change nothing."""
        if any(each.value is None and value_at(command, each.path) for each in stop.sent):
            return False
        values = {each.path: each.value for each in stop.sent if each.value is not None}
        if any(value_at(command, path) != value for path, value in values.items()):
            return False
        for path, value in values.items():
            command = put(command, path, type(value)())
        return is_zero(self._store, self._gate.type, command)

    def _hold(self, command: Message | None = None) -> None:
        """Latch the lines that apply until the reset, and wait for a zero command, or for none."""
        for index, line in enumerate(self._gate.lines):
            if line.until_reset and self._applies(line):
                self._latched.add(index)
        if self._is_stopped():
            self._waits = self._gate.resume_on_zero
        elif command is not None and self._is_safe(command):
            self._waits = self._has_taken_over = False

    def _is_waiting(self) -> bool:
        """Return whether the gate waits for a zero command, after a stop or from a new source."""
        return self._waits or self._has_taken_over

    def _taken(self, source: int | None) -> Message | None:
        """Return the command that is news: of the source, if it passes, or of one that takes over.

        ``source`` is the one that has just spoken.
        """
        before, self._passing = self._passing, self._listened_to()
        if self._passing != before:
            new = self._passing
            self._has_taken_over = new is not None and self._gate.sources[new].from_zero
        elif source is None or source != self._passing:
            return None
        if self._passing is None:
            return None
        self._source = self._passing
        return self._spoken[self._passing][1]

    def _holds_back(self, stopping: int | None, command: Message | None) -> bool:
        """Return whether a command that would make the robot set off has to wait."""
        if not self._waiting:
            return False
        is_stopped = stopping is not None or self._is_waiting()
        if is_stopped:
            stop = None if self._last_stop is None else self._gate.lines[self._last_stop].stop
            self._moves = self._moves and stop is not None and stop.kind == "hold"
        elif self._is_lost("input") or (command is not None and self._is_safe(command)):
            self._moves = False
        elif command is None or self._moves:
            return self._wish_ns is not None
        else:
            self._wish_ns = self._now_ns if self._wish_ns is None else self._wish_ns
            self._moves = all(map(self._has_waited, self._waiting))
            if not self._moves:
                return True
        self._wish_ns = None
        return False

    def _has_waited(self, line: GateLine) -> bool:
        assert line.action is not None
        assert line.wait_ns is not None
        assert self._wish_ns is not None
        known_ns = self._known_since.get(line.action)
        return known_ns is not None and self._now_ns - max(known_ns, self._wish_ns) >= line.wait_ns

    def _decide(self, command: Message | None = None) -> Decision:
        stopping = self._stopping()
        if stopping is not None:
            self._last_stop = stopping
        limits: dict[FieldPath, Limit] = {}
        for line in self._gate.lines:
            if line.stop and self._applies(line):
                break
            if self._applies(line):
                for limit in line.limits:
                    limits.setdefault(limit.path, limit)
        self._is_held = self._holds_back(stopping, command)
        if self._is_held:
            kinds = [self._gate.lines[i].stop for i in self._stops]
            has_zero = any(each and each.kind == "zero" for each in kinds)
            last = None if self._last_stop is None else self._gate.lines[self._last_stop].stop
            stop = Stop() if has_zero else last or Stop()
            return Decision(stop, {}, self._last_stop if stop.kind == "send" else None)
        if stopping is None and not self._is_waiting():
            return Decision(None, limits)
        last = None if self._last_stop is None else self._gate.lines[self._last_stop].stop
        stop = last or Stop()
        if self._latched or self._is_waiting() or stop.kind != "zero":
            limits = {}
        return Decision(stop, limits, self._last_stop if stop.kind == "send" else None)

    # Publishing --------------------------------------------------------------------------

    def _settle(self, source: int | None = None) -> None:
        """Decide anew, and publish what follows; ``source`` is one that has just spoken."""
        command = self._taken(source)
        lost = self._is_lost("heartbeat")
        if lost and not self._heartbeat_was_lost:
            self._active.clear()
            self._known_since.clear()
        self._heartbeat_was_lost = lost
        self._hold(command)
        before, self._decision = self._decision, self._decide(command)
        stop = self._decision.stop
        if stop is not None:
            due = self._zero_due_ns is not None and self._zero_due_ns <= self._now_ns
            last = {"zero": self._stopped_with, "hold": self._executed}.get(stop.kind)
            exceeds = last is not None and limited(last, self._standing()) is not last
            if (before.stop, before.sender) != (stop, self._decision.sender):
                self._turn(stop, is_first=before.stop is None)
            if due or exceeds or self._decision != before:
                self._publish_stop(stop)
            return
        self._zero_due_ns = None
        if command is not None:
            self._publish_command(command)
        elif self._executed is not None:
            within = self._within(self._executed)
            if within is not self._executed:
                self._executed = within
                self.outputs.append(Output(self._now_ns, "limited", within))

    def _within(self, command: Message) -> Message:
        """Return a command within the limits of the decision, and within those that stand."""
        return limited(limited(command, self._decision.limits.values()), self._standing())

    # Standing limits ---------------------------------------------------------------------

    def _standing(self) -> list[Limit]:
        """Return the limits that always hold, with what their ends are now."""
        limits = (each for line in self._gate.lines if line.is_standing for each in line.limits)
        return [self._closed(each) if each.is_open else each for each in limits]

    def _closed(self, limit: Limit) -> Limit:
        lower, upper = map(self._end, limit.ends)
        if lower > upper:
            lower = upper = 0.0
        ends = (min(lower, 0.0) or 0.0, max(upper, 0.0) or 0.0)
        least, greatest = (_as_field(each, limit.type) for each in ends)
        return dataclasses.replace(limit, lower=least, upper=greatest)

    def _end(self, end: float | InputBound | TunedBound) -> float:
        if isinstance(end, InputBound):
            number = self._number(end)
            return 0.0 if number is None else number * end.factor
        if isinstance(end, TunedBound):
            constant = end.constant
            return self._constants.get(constant.name, constant.default) * end.factor
        return float(end)

    def _number(self, end: InputBound) -> float | None:
        """Return what an input says now, if that is known."""
        arrived_ns, message = self._read.get(end.topic, (0, None))
        number = None if message is None else value_at(message, end.path)
        is_old = end.timeout_ns is not None and self._now_ns >= arrived_ns + end.timeout_ns
        return None if number is None or is_old or math.isnan(number) else float(number)

    def _publish_command(self, command: Message) -> None:
        within = self._within(command)
        self._executed = within
        kind: OutputKind = "pass" if within is command else "limited"
        self.outputs.append(Output(self._now_ns, kind, within))

    def _turn(self, stop: Stop, *, is_first: bool) -> None:
        """Begin to stop, or to stop in another way."""
        in_effect = self._executed
        if is_first and in_effect is None and self._has_past:
            # No command has come since the stop before: where that has got to is in effect.
            is_zero = self.outputs[-1].message is self._stopped_with
            in_effect = self._stopped_with if is_zero else None
        if in_effect is not None:
            self._fell_from, self._course = in_effect, []
            self._fell_on = {}
        self._course.append((self._now_ns, stop))

    def _publish_stop(self, stop: Stop) -> None:
        """Publish what stops. What a late call finds overdue is made up for by one message."""
        late = (self._called_ns - self._now_ns) // self._gate.period_ns
        self._zero_due_ns = self._now_ns + self._gate.period_ns * (late + 1)
        if stop.kind == "hold":
            if self._executed is not None:
                self._executed = limited(self._executed, self._standing())
                self.outputs.append(Output(self._now_ns, "hold", self._executed))
            return
        self._executed = None
        if stop.kind == "silence":
            self._has_past = False
            self._zero_due_ns = None
            return
        last_good = self._good.get(self._source)
        message = zero(self._store, self._gate.type, last_good, self._now_ns)
        if stop.kind == "send":
            for each in stop.sent:
                if each.value is None:
                    message = put(message, each.path, [])
                elif value_at(message, each.path) is not None:
                    message = put(message, each.path, each.value)
            self.outputs.append(Output(self._now_ns, "send", message))
            return
        for ramp in stop.ramps:
            if ramp.path not in self._decision.limits:  # another line decides that field
                message = self._falling(message, ramp)
        fallen, message = message, limited(message, self._standing())
        if last_good is not None and not self._is_lost("input"):
            within = self._within(last_good)
            for path in self._decision.limits:
                value = value_at(within, path)
                if value is not None:
                    message = put(message, path, value)
        for ramp in stop.ramps:
            value = value_at(message, ramp.path)
            if ramp.path in self._decision.limits or value != value_at(fallen, ramp.path):
                self._fell_on[ramp.path] = (len(self._course) - 1, self._called_ns, value)
        self._stopped_with = message
        self._has_past = last_good is not None
        self.outputs.append(Output(self._now_ns, "zero", message))

    def _falling(self, message: Message, ramp: StopField) -> Message:
        """Return a zero with one field where its ramp has got to."""
        start = None if self._fell_from is None else value_at(self._fell_from, ramp.path)
        if start is None or value_at(message, ramp.path) is None:
            return message
        first, since_ns, start = self._fell_on.get(ramp.path, (0, -1, start))
        if start is None:  # the command that the limit left it to did not have it
            return message
        fallen = 0.0
        ends = [begin_ns for begin_ns, _ in self._course[1:]] + [self._called_ns]
        for (begin_ns, stop), end_ns in list(zip(self._course, ends, strict=True))[first:]:
            rate = next((each.value for each in stop.ramps if each.path == ramp.path), None)
            if rate is None:
                return message  # it has been at zero since
            assert isinstance(rate, float)
            fallen += rate * max(end_ns - max(begin_ns, since_ns), 0) / 1e9
        left = abs(float(start)) - fallen
        if left <= 0:
            return message
        number = math.copysign(left, start)
        if isinstance(start, int):
            number = start if fallen == 0 else int(number)
        elif ramp.type.base == "float32":
            number = as_float32(number)
        made: Message = put(message, ramp.path, number)
        return made


def _as_field(number: float, kind: FieldType) -> float:
    """Return a number as a field holds it: rounded, or cut to an integer of its range."""
    if kind.base == "float32":
        return as_float32(number)
    if kind.base not in INTEGER_RANGES:
        return number
    least, greatest = INTEGER_RANGES[str(kind.base)]
    return int(max(least, min(greatest, number)))


def _names(gate: Gate, action: Action) -> bool:
    return any(line.action == action.index for line in gate.lines)
