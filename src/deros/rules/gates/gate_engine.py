"""Runs gates on messages as plain data: the reference that generated gates are compared with.

What a gate publishes when is decided by the class that generated gates run, too; see
:mod:`deros.generators.runtime.python.deros_runtime.gate_logic`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from deros.generators.runtime.python.deros_runtime import gate_logic
from deros.interfaces.message_fields import field_type
from deros.interfaces.store import InterfaceStore
from deros.rules.functions.reads import strip_comments
from deros.rules.gates.gate_table import gate_table, numbered_paths, state_topics
from deros.rules.program.bounds import as_float32
from deros.rules.program.commands import Message, is_finite, is_sent, put, sent, value_at, zero
from deros.rules.program.ir import Action, Gate, GateLine, Stop

OutputKind = gate_logic.Output


@dataclass(frozen=True, slots=True)
class Output:
    """A command that a gate publishes.

    Attributes:
        t_ns: when.
        kind: the command as it came, within the limits, or zero (but for numbers that a limit,
            written before the zero line, leaves to the command, and those that fall to zero along
            a ramp); or what a line sends, or the command that is held.
        message: as plain data.
    """

    t_ns: int
    kind: OutputKind
    message: Message


class GateEngine:
    """Runs one gate. Times are nanoseconds of one clock, passed with every call.

    Deadlines that are due when a call comes are handled first, in time order. A call with an
    earlier time than the one before means that the clock has stepped back: everything is unknown
    and lost then, as at the start.

    Attributes:
        table: the lines of the gate, and the texts of everything that can hold commands back.
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
        """Start at ``start_ns``; ``actions`` are those of the gate's rules.

        ``constants`` are the values of tunable constants, where they are not the default ones. The
        first decision is due at the start; the first call makes it, and publishes its zeros.
        """
        self.table = gate_table(gate, actions, _shown)
        self.outputs: list[Output] = []
        self._type = gate.type
        self._paths = numbered_paths(gate)
        self._singles = {
            path for path in self._paths if field_type(store, gate.type, path).base == "float32"
        }
        self._stops = [line.stop for line in gate.lines]
        self._states = [
            (state.topic, {actions[index].name: each for index, each in state.bindings.items()})
            for state in state_topics(gate, actions)
        ]
        self._store = store
        self._commands: list[Message | None] = [None] * len(gate.sources)  # the last good ones
        self._published_last: Message | None = None
        self._inputs = gate.inputs
        tuned = {each.name: each.default for each in gate.tunables} | dict(constants or {})
        self._gate = gate_logic.Gate(self.table, start_ns, self._publish, tuned)

    @property
    def next_deadline(self) -> int | None:
        """The earliest instant at which something can happen by itself, if there is one."""
        due_ns = self._gate.next_deadline
        return None if due_ns == gate_logic.NEVER else due_ns

    @property
    def standing(self) -> tuple[str, ...]:
        """The texts of the lines whose limits always hold."""
        return tuple(line.text for line in self.table.lines if line.is_standing)

    @property
    def source(self) -> str:
        """The topic whose commands may pass, if there is one among several."""
        return self._gate.source_name

    @property
    def applying(self) -> tuple[bool, ...]:
        """Whether each of the table's reports holds, as of the last decision."""
        return self._gate.applying

    # Events -------------------------------------------------------------------------------------

    def command(self, t_ns: int, message: Message | None, source: int = 0) -> list[Output]:
        """Take a command (``None``: one that could not be decoded). Return what is published.

        ``source`` is the number of its source.
        """
        if message is None or not is_finite(message):
            return self._published(lambda: self._gate.on_refused(t_ns, source))
        published = self.advance(t_ns)  # with the command before
        self._commands[source] = message
        values = tuple(value_at(message, path) for path in self._paths)
        is_asked = self.table.waits_for_zero or bool(self.table.waiting)
        ends_wait = is_asked and self._ends_wait(message)
        return published + self._published(
            lambda: self._gate.on_command(t_ns, values, ends_wait, source)
        )

    def state(
        self, t_ns: int, topic: str, message: Message | None, *, is_trusted: bool = True
    ) -> list[Output]:
        """Take a message about the state of actions. Return what is published.

        After a message that could not be decoded (``None``), nothing is known. An untrusted one,
        which may come from another node than the safety node, makes no action inactive.
        """
        active = {
            action: message is None or value_at(message, binding.path) == binding.value
            for bound_topic, bindings in self._states
            for action, binding in bindings.items()
            if bound_topic == topic
        }
        return self._published(lambda: self._gate.on_state(t_ns, active, is_trusted))

    def reading(self, t_ns: int, topic: str, message: Message | None) -> list[Output]:
        """Take a message with numbers for limits. Return what is published.

        After a message that could not be decoded (``None``), they are unknown.
        """
        numbers = {
            number: None if message is None else value_at(message, each.path)
            for number, each in enumerate(self._inputs)
            if each.topic == topic
        }
        return self._published(lambda: self._gate.on_inputs(t_ns, numbers))

    def heartbeat(self, t_ns: int, counter: int) -> list[Output]:
        """Take a heartbeat of the safety node. Return what is published."""
        return self._published(lambda: self._gate.on_heartbeat(t_ns, counter))

    def no_safety_node(self, t_ns: int) -> list[Output]:
        """Note that no node, or more than one, can be the safety node. Return what is published.

        The actions are unknown, the heartbeat is lost, and the next heartbeat is the first again.
        """
        return self._published(lambda: self._gate.on_no_safety_node(t_ns))

    def reset(self, t_ns: int) -> tuple[int, ...]:
        """Decide a reset. Return the indices of the lines that refuse it: with none, it is done."""
        return self._gate.on_reset(t_ns)

    def advance(self, t_ns: int) -> list[Output]:
        """Handle everything due up to and including ``t_ns``. Return what is published."""
        return self._published(lambda: self._gate.advance(t_ns))

    def _published(self, call: Callable[[], object]) -> list[Output]:
        before = len(self.outputs)
        call()
        return self.outputs[before:]

    # Publishing ---------------------------------------------------------------------------------

    def _publish(self, kind: OutputKind, values: gate_logic.Values) -> None:
        message = self._made(kind, values)
        self._published_last = message
        self.outputs.append(Output(self._gate.now, kind, message))

    def _made(self, kind: OutputKind, values: gate_logic.Values) -> Message:
        if kind == "hold" or self._gate.renews:
            assert self._published_last is not None, "something is being executed"
            return self._changed(self._published_last, values) if values else self._published_last
        command = self._commands[self._gate.source]
        if kind in ("zero", "send"):
            message = zero(self._store, self._type, command, self._gate.now)
        else:
            assert command is not None, "there is something to pass"
            message = command
        if kind == "send":
            stop = self._stops[self._gate.deciding]
            return sent(message, stop.sent if stop else ())
        return message if kind == "pass" else self._changed(message, values)

    def _changed(self, message: Message, values: gate_logic.Values) -> Message:
        """Return a message with values in the fields of the table."""
        for path, value in zip(self._paths, values, strict=True):
            if value is not None:
                held = as_float32(value) if path in self._singles else value
                message = put(message, path, held)
        return message

    def _ends_wait(self, message: Message) -> bool:
        """Return whether a command is what the gate itself would publish to stop."""
        stops = [each for each in self._stops if each and each.kind in ("zero", "send")]
        return any(
            is_sent(self._store, self._type, message, each.sent) for each in stops or [Stop()]
        )


def _shown(line: GateLine) -> str:
    return strip_comments(line.span.text).rstrip("; ")
