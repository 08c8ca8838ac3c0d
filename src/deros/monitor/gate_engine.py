"""The reference gate: what a ``gate`` of the rules means is what this does.

It aims at being right at a glance; the generated gate is held to publish the same commands at the
same nanosecond. In short:

* A line applies while its action is active *as far as the gate knows*, or while what it names is
  lost. What the gate does not know counts against the command: an action counts as active before
  the first message about its state, and from a loss of the heartbeat until the next such message.
* The heartbeat, or the input, is lost from the start until it first comes, and again at the instant
  when it has been silent for the line's time (inclusive). A command that is refused makes the input
  lost at once, until the next good one.
* A heartbeat is a sign of life if its counter is greater than that of the one before. One whose
  counter is not makes the heartbeat lost at once and is, as the first one is, what the next one is
  compared with. Where more than one node publishes the heartbeat, nothing is known.
* A state that may come from another node than the safety node makes an action active, never
  inactive.
* For each number of the command, the first line that applies and speaks of it decides; ``zero``
  speaks of all. The limits of an action say nothing while the heartbeat or the input is lost.
* A line with ``zero until reset`` that has applied is *latched* until the gate's reset: zero, in
  every number, whether or not it still applies. A reset is refused, and not remembered, while a
  line with ``zero`` applies or anything is lost.
* With ``resume on zero command``, the gate *waits* from the start and from each zero line that
  applies, or is latched, on: zero, in every number. The waiting ends with a good command that is
  zero, and comes while nothing is latched and no zero line applies.
* A good command is published at once, with the limits kept. While a zero line decides, it is not
  published: zeros are, at once and then with the gate's period, until no zero line decides.
* A limit that comes into force between two commands holds for the one being executed: if that
  breaks it, it is published again within the limits. When a line ends, nothing is published.

Source: docs, "What a gate means".
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

from deros.interfaces.store import InterfaceStore
from deros.monitor.commands import Message, is_finite, is_zero, limited, put, value_at, zero
from deros.monitor.ir import Action, Gate, GateLine, Limit

OutputKind = Literal["pass", "limited", "zero"]
FieldPath = tuple[str | int, ...]


@dataclass(frozen=True, slots=True)
class Output:
    """A command that a gate publishes.

    Attributes:
        t_ns: when.
        kind: the very command that came, one with limits kept, or zero (but for numbers that a
            limit, written before the zero line, leaves to the command).
        message: as plain data.
    """

    t_ns: int
    kind: OutputKind
    message: Message


@dataclass(frozen=True, slots=True)
class Decision:
    """What the lines that apply make of the command: limits, and zero for all other numbers."""

    zero: bool = False
    limits: Mapping[FieldPath, Limit] = field(default_factory=dict)


class GateEngine:
    """Runs one gate. Times are nanoseconds of one clock, given with every call.

    Deadlines that are due when a call comes are settled first, in time order. A call with an
    earlier time than the one before shows a backward step of the clock: everything is unknown and
    lost then, as at the start.

    Attributes:
        outputs: all that has been published since the start, in order.
    """

    def __init__(
        self, gate: Gate, actions: Sequence[Action], store: InterfaceStore, start_ns: int = 0
    ) -> None:
        """Start at ``start_ns``; ``actions`` are those of the gate's program.

        Zeros are due at the start, if they are what is decided, and published by the first call.
        """
        self.outputs: list[Output] = []
        self._gate = gate
        self._actions = [each for each in actions if _heeds(gate, each)]
        self._store = store
        self._now_ns = self._called_ns = start_ns
        self._active: dict[int, bool]
        self._counter: int | None
        self._heartbeat_ns: int | None
        self._command_ns: int | None
        self._latched: set[int] = set()  # indices of lines
        self._last_good: Message | None = None
        self._executed: Message | None = None  # what was published last, unless that was zero
        self._forget()
        self._hold()
        self._decision = self._decide()
        self._zero_due_ns = start_ns if self._decision.zero else None

    @property
    def next_deadline(self) -> int | None:
        """The earliest instant at which something can happen by itself, if there is one."""
        return min(self._deadlines(), default=None)

    @property
    def applying(self) -> tuple[bool, ...]:
        """What holds commands back, as of the last call.

        Of each line whether it applies; then of each line with ``until_reset`` whether it is
        latched though it does not apply; then, with ``resume_on_zero``, whether the gate waits for
        a command that is zero, and for nothing else.
        """
        lines = tuple(map(self._applies, self._gate.lines))
        latched = tuple(
            index in self._latched and not lines[index]
            for index, line in enumerate(self._gate.lines)
            if line.until_reset
        )
        waits = (self._waits and not self._is_stopped(),) if self._gate.resume_on_zero else ()
        return (*lines, *latched, *waits)

    # What happens -------------------------------------------------------------------------------

    def command(self, t_ns: int, message: Message | None) -> list[Output]:
        """Take a command (``None``: one that could not be decoded). Return what is published."""
        before = len(self.outputs)
        self._catch_up(t_ns)
        if message is None or not is_finite(message):
            self._refused = True
            self._settle()
        else:
            self._refused = False
            self._command_ns, self._last_good = t_ns, message
            self._settle(message)
        return self.outputs[before:]

    def state(
        self, t_ns: int, topic: str, message: Message | None, *, is_trusted: bool = True
    ) -> list[Output]:
        """Take a message about the state of actions. Return what is published.

        After one that could not be decoded (``None``), nothing is known. One that is not trusted,
        because it may come from another node than the safety node, makes no action inactive.
        """
        before = len(self.outputs)
        self._catch_up(t_ns)
        for each in self._actions:
            if each.binding is None or each.binding.topic != topic:
                continue
            if message is None:
                self._active.pop(each.index, None)
            else:
                active = value_at(message, each.binding.path) == each.binding.value
                if active or is_trusted:
                    self._active[each.index] = active
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
        """Take note that no node, or more than one, can be the safety node.

        Return what is published. Nothing is known of the actions, the heartbeat is lost, and the
        next one is the first again.
        """
        before = len(self.outputs)
        self._catch_up(t_ns)
        self._active.clear()
        self._counter = self._heartbeat_ns = None
        self._settle()
        return self.outputs[before:]

    def reset(self, t_ns: int) -> tuple[int, ...]:
        """Take a reset. Return the indices of the lines that stand against it: none, it is done."""
        self._catch_up(t_ns)
        against = tuple(
            index
            for index, line in enumerate(self._gate.lines)
            if (line.lost or not line.limits) and self._applies(line)
        )
        if not against:
            self._latched.clear()
            self._settle()
        return against

    def advance(self, t_ns: int) -> list[Output]:
        """Settle all that is due up to and including ``t_ns``. Return what is published."""
        before = len(self.outputs)
        self._catch_up(t_ns)
        return self.outputs[before:]

    # Time ---------------------------------------------------------------------------------------

    def _deadlines(self) -> Iterator[int]:
        """Yield the instants, not settled yet, at which zeros are due or something is lost."""
        if self._zero_due_ns is not None:
            yield self._zero_due_ns
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
        if self._zero_due_ns is not None:
            self._zero_due_ns = t_ns
        self._settle()

    def _forget(self) -> None:
        """Know nothing of the actions, the heartbeat and the input; all that can be lost is."""
        self._active = {}
        self._counter = None
        self._heartbeat_ns = None
        self._command_ns = None
        self._refused = False
        self._heartbeat_was_lost = self._is_lost("heartbeat")
        self._waits = self._gate.resume_on_zero

    # What applies -------------------------------------------------------------------------------

    def _last_ns(self, line: GateLine) -> int | None:
        return self._heartbeat_ns if line.lost == "heartbeat" else self._command_ns

    def _line_is_lost(self, line: GateLine) -> bool:
        """Tell whether what a ``lost`` line names has been silent for its time."""
        last_ns = self._last_ns(line)
        if last_ns is None or (line.lost == "input" and self._refused):
            return True
        return line.lost_ns is not None and self._now_ns >= last_ns + line.lost_ns

    def _is_lost(self, what: Literal["heartbeat", "input"]) -> bool:
        """Tell whether the gate has a line about ``what`` that applies."""
        return any(self._line_is_lost(each) for each in self._gate.lines if each.lost == what)

    def _applies(self, line: GateLine) -> bool:
        if line.action is None:
            return self._line_is_lost(line)
        if line.limits and (self._is_lost("heartbeat") or self._is_lost("input")):
            return False
        return self._active.get(line.action, True)

    def _is_stopped(self) -> bool:
        """Return whether a zero line applies, or one is latched."""
        zeros = (line for line in self._gate.lines if not line.limits)
        return bool(self._latched) or any(map(self._applies, zeros))

    def _hold(self, command: Message | None = None) -> None:
        """Latch the lines that apply until the reset, and wait for a zero command, or for none."""
        for index, line in enumerate(self._gate.lines):
            if line.until_reset and self._applies(line):
                self._latched.add(index)
        if self._is_stopped():
            self._waits = self._gate.resume_on_zero
        elif command is not None and is_zero(self._store, self._gate.type, command):
            self._waits = False

    def _decide(self) -> Decision:
        if self._latched or self._waits:
            return Decision(True)
        limits: dict[FieldPath, Limit] = {}
        for line in self._gate.lines:
            if not self._applies(line):
                continue
            if not line.limits:
                return Decision(True, limits)
            for limit in line.limits:
                limits.setdefault(limit.path, limit)
        return Decision(False, limits)

    # What is published --------------------------------------------------------------------------

    def _settle(self, command: Message | None = None) -> None:
        """Decide anew, and publish what follows; ``command`` is one that has just come."""
        lost = self._is_lost("heartbeat")
        if lost and not self._heartbeat_was_lost:
            self._active.clear()
        self._heartbeat_was_lost = lost
        self._hold(command)
        before, self._decision = self._decision, self._decide()
        if self._decision.zero:
            due = self._zero_due_ns is not None and self._zero_due_ns <= self._now_ns
            if due or self._decision != before:
                self._publish_zero()
            return
        self._zero_due_ns = None
        if command is not None:
            self._publish_command(command)
        elif self._executed is not None:
            within = limited(self._executed, self._decision.limits.values())
            if within is not self._executed:
                self._executed = within
                self.outputs.append(Output(self._now_ns, "limited", within))

    def _publish_command(self, command: Message) -> None:
        within = limited(command, self._decision.limits.values())
        self._executed = within
        kind: OutputKind = "pass" if within is command else "limited"
        self.outputs.append(Output(self._now_ns, kind, within))

    def _publish_zero(self) -> None:
        """Publish zeros. Those that a late call finds overdue are made up for by one."""
        message = zero(self._store, self._gate.type, self._last_good, self._now_ns)
        if self._last_good is not None and not self._is_lost("input"):
            within = limited(self._last_good, self._decision.limits.values())
            for path in self._decision.limits:
                value = value_at(within, path)
                if value is not None:
                    message = put(message, path, value)
        self.outputs.append(Output(self._now_ns, "zero", message))
        self._executed = None
        late = (self._called_ns - self._now_ns) // self._gate.period_ns
        self._zero_due_ns = self._now_ns + self._gate.period_ns * (late + 1)


def _heeds(gate: Gate, action: Action) -> bool:
    return any(line.action == action.index for line in gate.lines)
