"""Runs gates: the reference that generated gates are compared with.

The engine executes the steps of a :class:`~deros.monitor.gate_program.GateProgram` one by one, on
messages as plain data. What the lines of a gate mean is stated in
:mod:`deros.monitor.gate_lowering`; the generated gate has to publish the same commands at the same
nanosecond.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from deros.interfaces.store import InterfaceStore
from deros.monitor import gate_program as form
from deros.monitor.commands import Message, is_finite, is_zero, limited, put, value_at, zero
from deros.monitor.gate_lowering import gate_program
from deros.monitor.ir import Action, Gate, Limit

OutputKind = Literal["pass", "limited", "zero"]


@dataclass(frozen=True, slots=True)
class Output:
    """A command that a gate publishes.

    Attributes:
        t_ns: when.
        kind: the command as it came, within the limits, or zero (but for numbers that a limit,
            written before the zero line, leaves to the command).
        message: as plain data.
    """

    t_ns: int
    kind: OutputKind
    message: Message


@dataclass(frozen=True, slots=True)
class _Event:
    """An event that the steps take, with its data."""

    message: Message | None = None
    is_trusted: bool = True
    counter: int = 0


class GateEngine:
    """Runs one gate. Times are nanoseconds of one clock, passed with every call.

    Deadlines that are due when a call comes are handled first, in time order. A call with an
    earlier time than the one before means that the clock has stepped back: everything is unknown
    and lost then, as at the start.

    Attributes:
        outputs: everything published since the start, in order.
        applying: whether each condition that can hold commands back does, as of the last decision:
            for each line, whether it applies; for each line with ``until_reset``, whether it is
            latched though it does not apply; with ``resume_on_zero``, whether the gate waits for a
            command that is zero, and for nothing else. Empty before the first call.
    """

    def __init__(
        self, gate: Gate, actions: Sequence[Action], store: InterfaceStore, start_ns: int = 0
    ) -> None:
        """Start at ``start_ns``; ``actions`` are those of the gate's rules.

        The first decision is due at the start; the first call makes it, and publishes its zeros.
        """
        self.outputs: list[Output] = []
        self._program = gate_program(gate, actions, store)
        self._bindings = dict(bound for state in self._program.states for bound in state.bindings)
        self._store = store
        self._latched: set[int] = set()  # indices of lines
        self._command: Message | None = None  # the last good one
        self._executed: Message | None = None  # what was published last, unless that was zero
        self._applies: dict[int, bool] = {}  # by the index of the line
        self._is_lost: dict[form.Source, bool] = {}
        self._line_is_zero = False
        self._limits: tuple[Limit, ...] = ()
        self.applying: tuple[bool, ...] = ()
        self._start(start_ns)

    @property
    def next_deadline(self) -> int | None:
        """The earliest instant at which something can happen by itself, if there is one."""
        deadlines = (self._zero_due_ns, self._lost_due_ns)
        return min((each for each in deadlines if each is not None), default=None)

    # Events -------------------------------------------------------------------------------------

    def command(self, t_ns: int, message: Message | None) -> list[Output]:
        """Take a command (``None``: one that could not be decoded). Return what is published."""
        if message is None or not is_finite(message):
            return self._take(t_ns, self._program.on_refused)
        return self._take(t_ns, self._program.on_command, _Event(message))

    def state(
        self, t_ns: int, topic: str, message: Message | None, *, is_trusted: bool = True
    ) -> list[Output]:
        """Take a message about the state of actions. Return what is published.

        After a message that could not be decoded (``None``), nothing is known. An untrusted one,
        which may come from another node than the safety node, makes no action inactive.
        """
        states = (state for state in self._program.states if state.topic == topic)
        steps = tuple(step for state in states for step in state.steps)
        return self._take(t_ns, steps, _Event(message, is_trusted))

    def heartbeat(self, t_ns: int, counter: int) -> list[Output]:
        """Take a heartbeat of the safety node. Return what is published."""
        return self._take(t_ns, self._program.on_heartbeat, _Event(counter=counter))

    def no_safety_node(self, t_ns: int) -> list[Output]:
        """Note that no node, or more than one, can be the safety node. Return what is published.

        The actions are unknown, the heartbeat is lost, and the next heartbeat is the first again.
        """
        return self._take(t_ns, self._program.on_no_safety_node)

    def reset(self, t_ns: int) -> tuple[int, ...]:
        """Decide a reset. Return the indices of the lines that refuse it: with none, it is done."""
        self._catch_up(t_ns)
        for step in self._program.on_reset:
            assert isinstance(step, form.Reset), step
            refusing = tuple(line for line in step.refusing if self._applies[line])
            if refusing:
                return refusing
            self._latched -= set(step.latches)
            self._settle()
        return ()

    def advance(self, t_ns: int) -> list[Output]:
        """Handle everything due up to and including ``t_ns``. Return what is published."""
        return self._take(t_ns, ())

    def _take(
        self, t_ns: int, steps: Sequence[form.Step], event: _Event | None = None
    ) -> list[Output]:
        before = len(self.outputs)
        self._catch_up(t_ns)
        for step in steps:
            self._do(step, event or _Event())
        return self.outputs[before:]

    # Time ---------------------------------------------------------------------------------------

    def _start(self, t_ns: int) -> None:
        """Give the variables their first values; the latches and the last commands stay."""
        self._now_ns = self._called_ns = t_ns
        self._active = dict.fromkeys(self._program.actions, True)
        self._last_ns: dict[form.Source, int | None] = {"heartbeat": None, "input": None}
        self._counter: int | None = None
        self._heartbeat_was_lost = True
        self._waits = self._program.gate.resume_on_zero
        self._decision: tuple[bool, tuple[Limit, ...]] = (False, ())
        self._zero_due_ns: int | None = t_ns
        self._lost_due_ns: int | None = None

    def _catch_up(self, t_ns: int) -> None:
        self._called_ns = t_ns
        if t_ns < self._now_ns:
            self._start(t_ns)
        while (due_ns := self.next_deadline) is not None and due_ns <= t_ns:
            self._now_ns = due_ns
            self._settle()
        self._now_ns = t_ns

    def _settle(self, command: Message | None = None) -> None:
        for step in self._program.settle:
            self._decide(step, command)

    # Steps --------------------------------------------------------------------------------------

    def _do(self, step: form.Step, event: _Event) -> None:
        """Run a step that takes an event."""
        match step:
            case form.AssumeActive(actions):
                self._active |= dict.fromkeys(actions, True)
            case form.Forget(source):
                self._last_ns[source] = None
                if source == "heartbeat":
                    self._counter = None
            case form.NoteInput():
                self._last_ns["input"] = self._now_ns
            case form.StoreCommand():
                self._command = event.message
            case form.TakeState(action):
                self._take_state(action, event)
            case form.TakeHeartbeat():
                is_alive = self._counter is not None and event.counter > self._counter
                self._last_ns["heartbeat"] = self._now_ns if is_alive else None
                self._counter = event.counter
            case form.Settle(with_command):
                self._settle(event.message if with_command else None)
            case _:
                raise NotImplementedError(step)

    def _take_state(self, action: int, event: _Event) -> None:
        is_active = True
        if event.message is not None:
            binding = self._bindings[action]
            is_active = value_at(event.message, binding.path) == binding.value
        if is_active or event.is_trusted:
            self._active[action] = is_active

    def _decide(self, step: form.Step, command: Message | None) -> None:
        """Run a step that decides; ``command`` is a good one that has just come."""
        match step:
            case form.FindLine(line, condition):
                self._applies[line] = self._holds(condition)
            case form.FindLoss(source):
                self._is_lost[source] = self._holds(step.condition)
            case form.ForgetActions(actions):
                is_lost = self._holds(step.loss)
                if is_lost and not self._heartbeat_was_lost:
                    self._active |= dict.fromkeys(actions, True)
                self._heartbeat_was_lost = is_lost
            case form.LatchLines(lines):
                self._latched |= {line for line in lines if self._applies[line]}
            case form.FindZero(condition):
                self._line_is_zero = self._holds(condition)
            case form.UpdateWait():
                ends = command is not None and self._is_zero(command)
                self._waits = self._line_is_zero or (self._waits and not ends)
            case form.ChooseLimits(fields):
                chosen = (self._chosen(field.choices) for field in fields)
                self._limits = tuple(limit for limit in chosen if limit is not None)
            case form.Publish():
                self._publish(step, command)
            case form.ReportApplying(conditions):
                self.applying = tuple(map(self._holds, conditions))
            case form.ScheduleLosses(deadlines):
                due = (self._due_ns(each) for each in deadlines if not self._applies[each.line])
                self._lost_due_ns = min(due, default=None)
            case _:
                raise NotImplementedError(step)

    def _chosen(self, choices: Sequence[form.Choice]) -> Limit | None:
        return next((each.limit for each in choices if self._holds(each.condition)), None)

    def _due_ns(self, deadline: form.Deadline) -> int:
        last_ns = self._last_ns[deadline.source]
        assert last_ns is not None, "a line about what never came applies"
        return last_ns + deadline.ns

    def _is_zero(self, command: Message) -> bool:
        return is_zero(self._store, self._program.gate.type, command)

    # Conditions ---------------------------------------------------------------------------------

    def _holds(self, condition: form.Condition) -> bool:
        match condition:
            case form.Silent(source, ns):
                last_ns = self._last_ns[source]
                return last_ns is None or self._now_ns >= last_ns + ns
            case form.IsActive(action):
                return self._active[action]
            case form.Applies(line):
                return self._applies[line]
            case form.IsLost(sources):
                return any(self._is_lost[source] for source in sources)
            case form.IsLatched(line):
                return line in self._latched
            case form.IsAnyLatched():
                return bool(self._latched)
            case form.IsZero():
                return self._line_is_zero
            case form.IsWaiting():
                return self._waits
            case form.Not(operand):
                return not self._holds(operand)
            case form.AllOf(operands):
                return all(map(self._holds, operands))
            case form.AnyOf(operands):
                return any(map(self._holds, operands))
            case _:
                raise NotImplementedError(condition)

    # Publishing ---------------------------------------------------------------------------------

    def _publish(self, step: form.Publish, command: Message | None) -> None:
        before, self._decision = self._decision, (self._holds(step.zero), self._limits)
        if self._holds(step.zero):
            due = self._zero_due_ns is not None and self._zero_due_ns <= self._now_ns
            if due or self._decision != before:
                self._publish_zero(step)
            return
        self._zero_due_ns = None
        if command is not None:
            self._executed = limited(command, self._limits)
            self._output("pass" if self._executed is command else "limited", self._executed)
        elif self._executed is not None:
            within = limited(self._executed, self._limits)
            if within is not self._executed:
                self._executed = within
                self._output("limited", within)

    def _publish_zero(self, step: form.Publish) -> None:
        """Publish zeros. One message makes up for all that a late call finds overdue."""
        message = zero(self._store, self._program.gate.type, self._command, self._now_ns)
        is_known = self._command is not None and not (step.unless and self._holds(step.unless))
        if step.has_gaps and is_known:
            assert self._command is not None
            within = limited(self._command, self._limits)
            for limit in self._limits:
                value = value_at(within, limit.path)
                if value is not None:
                    message = put(message, limit.path, value)
        self._output("zero", message)
        self._executed = None
        period_ns = self._program.gate.period_ns
        late = (self._called_ns - self._now_ns) // period_ns
        self._zero_due_ns = self._now_ns + period_ns * (late + 1)

    def _output(self, kind: OutputKind, message: Message) -> None:
        self.outputs.append(Output(self._now_ns, kind, message))
