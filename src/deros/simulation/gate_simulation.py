"""Simulates the gates of a program next to its monitor: what they publish, and why."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from deros.interfaces.durations import NS_PER_S
from deros.interfaces.store import InterfaceStore
from deros.rules.engine.engine import Event
from deros.rules.gates.gate_engine import GateEngine, Output
from deros.rules.program.commands import Message, is_finite
from deros.rules.program.ir import Action, Binding, Gate, Program
from deros.simulation.trace_values import MessageReader
from deros.systems.safety_nodes import PUBLISH_HZ

AnswerKind = Literal[
    "passed",
    "limited",
    "zero",
    "sent",
    "held",
    "command_refused",
    "gate_reset",
    "gate_reset_refused",
]

_KINDS: dict[str, AnswerKind] = {
    "pass": "passed",
    "limited": "limited",
    "zero": "zero",
    "send": "sent",
    "hold": "held",
}
_REFUSED = "the command holds NaN or infinity"


@dataclass(frozen=True, slots=True)
class GateAnswer:
    """One event of a gate.

    Attributes:
        t_ns: when.
        event: the result of a command or of a reset.
        gate: the topic that the gate publishes.
        why: the lines of the gate that apply, or that refuse the reset.
        message: the published message, if there is one.
    """

    t_ns: int
    event: AnswerKind
    gate: str
    why: tuple[str, ...] = ()
    message: Message | None = None


class GateSimulation:
    """Runs the gates of a program, with the messages of the safety node.

    The safety node publishes the states of its bound actions at the start, whenever they change,
    and ``publish_freq`` times a second with its heartbeat, which begins as soon as it does not wait
    for inputs any more. All of them use the time of the trace.

    Attributes:
        heard: whether the messages of the safety node reach the gates.
    """

    def __init__(
        self,
        program: Program,
        store: InterfaceStore,
        publish_hz: float = PUBLISH_HZ,
        *,
        start_ns: int = 0,
        report_all: bool = False,
        constants: Mapping[str, float] | None = None,
    ) -> None:
        """Start at ``start_ns``.

        Args:
            program: the rules with the gates.
            store: the message definitions.
            publish_hz: the ``publish_freq`` of the safety node.
            start_ns: the time of the start.
            report_all: whether every published command is reported, even if nothing changes.
            constants: the values of tunable constants, where they are not the default ones.
        """
        self.heard = True
        self._gates = [
            _Gate(each, program.actions, store, start_ns, report_all, constants or {})
            for each in program.gates
        ]
        self._states = _States(program, store)
        self._period_ns = round(NS_PER_S / publish_hz)
        self._publish_ns = start_ns  # when it publishes next
        self._has_begun = False
        self._beats = 0

    @property
    def next_ns(self) -> int | None:
        """The next instant at which something happens by itself; ``None`` without gates."""
        if not self._gates:
            return None
        deadlines = (each.engine.next_deadline for each in self._gates)
        return min(self._publish_ns, *(each for each in deadlines if each is not None))

    def settle(
        self, t_ns: int, events: Sequence[Event], waiting: bool, stepped: bool
    ) -> Iterator[GateAnswer]:
        """Process an instant, after the events of the monitor.

        Args:
            t_ns: the instant.
            events: the events of the monitor.
            waiting: whether an input is awaited, so that there is no heartbeat.
            stepped: whether the clock has stepped back.
        """
        self._states.follow(events)
        for gate in self._gates:
            yield from gate.reports(gate.engine.advance(t_ns))
        if any(event.kind in ("trigger", "reset") for event in events):
            yield from self._publish_states(t_ns)
        if stepped or t_ns >= self._publish_ns:
            yield from self._publish_states(t_ns)
            yield from self._beat(t_ns, waiting)
            self._publish_ns = t_ns + self._period_ns

    def command(self, t_ns: int, topic: str, message: Message) -> Iterator[GateAnswer]:
        """Pass a command, or a message with numbers for limits, to the gates that read a topic."""
        for gate in self._gates:
            topics = gate.gate.topics
            if topic in topics:
                yield from gate.command(t_ns, message, topics.index(topic))
            elif topic in gate.gate.input_types:
                yield from gate.reports(gate.engine.reading(t_ns, topic, message))

    def reset(self, t_ns: int, target: str) -> Iterator[GateAnswer]:
        """Reset the gate that publishes a topic."""
        for gate in self._gates:
            if gate.gate.target == target:
                yield from gate.reset(t_ns)

    def _publish_states(self, t_ns: int) -> Iterator[GateAnswer]:
        if not self.heard:
            return
        for topic, message in self._states.messages():
            for gate in self._gates:
                yield from gate.reports(gate.engine.state(t_ns, topic, message))

    def _beat(self, t_ns: int, waiting: bool) -> Iterator[GateAnswer]:
        if not self._has_begun:  # the states go out at the start, the first beat a period later
            self._has_begun = True
            return
        if waiting:
            return
        self._beats += 1
        if self.heard:
            for gate in self._gates:
                yield from gate.reports(gate.engine.heartbeat(t_ns, self._beats))


class _Gate:
    """One gate, which reports what it does when that changes."""

    def __init__(
        self,
        gate: Gate,
        actions: Sequence[Action],
        store: InterfaceStore,
        start_ns: int,
        report_all: bool,
        constants: Mapping[str, float],
    ) -> None:
        self.gate = gate
        self.engine = GateEngine(gate, actions, store, start_ns, constants)
        self._report_all = report_all
        self._before: tuple[AnswerKind, tuple[str, ...]] | None = None

    def command(self, t_ns: int, message: Message, source: int = 0) -> Iterator[GateAnswer]:
        """Take a command of a source, by its number."""
        if not is_finite(message):
            yield GateAnswer(t_ns, "command_refused", self.gate.target, (_REFUSED,))
        yield from self.reports(self.engine.command(t_ns, message, source))

    def reset(self, t_ns: int) -> Iterator[GateAnswer]:
        """Decide a reset."""
        why = tuple(self.engine.table.lines[index].text for index in self.engine.reset(t_ns))
        event: AnswerKind = "gate_reset_refused" if why else "gate_reset"
        yield GateAnswer(t_ns, event, self.gate.target, why)
        self._before = None  # the result is reported again
        yield from self.reports(self.engine.advance(t_ns))

    def reports(self, outputs: Iterable[Output]) -> Iterator[GateAnswer]:
        """Yield published commands, once while neither their kind nor the reasons change."""
        for output in outputs:
            report = (_KINDS[output.kind], self._why(output))
            if self._report_all or report != self._before:
                self._before = report
                event, why = report
                yield GateAnswer(output.t_ns, event, self.gate.target, why, output.message)

    def _why(self, output: Output) -> tuple[str, ...]:
        """Return what holds commands back, else limits; and whose commands, of several sources."""
        applying = zip(self.engine.table.reports, self.engine.applying, strict=True)
        held_back = tuple(text for text, applies in applying if applies)
        why = self.engine.standing if output.kind == "limited" and not held_back else held_back
        source = self.engine.source
        passes = bool(source) and output.kind in ("pass", "limited")
        return (*why, f"source {source}") if passes else why


class _States:
    """The messages of the safety node about its bound actions."""

    def __init__(self, program: Program, store: InterfaceStore) -> None:
        self._active: set[str] = set()
        self._topics: dict[str, list[tuple[Action, Binding, Any]]] = {}
        for action in program.actions:
            binding = action.binding
            if binding is not None:
                default = MessageReader(store, binding.type).leaf({}, binding.path)
                if isinstance(binding.value, bool):
                    default = not binding.value
                states = self._topics.setdefault(binding.topic, [])
                states.append((action, binding, default))

    def follow(self, events: Iterable[Event]) -> None:
        """Update which actions are active."""
        for event in events:
            if event.kind == "trigger":
                self._active.add(event.action)
            elif event.kind == "reset":
                self._active.discard(event.action)

    def messages(self) -> Iterator[tuple[str, Message]]:
        """Yield each topic with the fields of its message; the action declared first decides."""
        for topic, states in self._topics.items():
            message: dict[str, Any] = {}
            for _, binding, default in reversed(states):
                _put(message, binding.path, default)
            for action, binding, _ in reversed(states):
                if action.name in self._active:
                    _put(message, binding.path, binding.value)
            yield topic, message


def _put(message: dict[str, Any], path: Sequence[str], value: Any) -> None:
    *around, last = path
    for step in around:
        message = message.setdefault(step, {})
    message[last] = value
