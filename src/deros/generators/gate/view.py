"""What the templates of a gate see in every language: its table, and its parts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from deros.generators.text.prose import printable_line
from deros.generators.text.provenance import origin
from deros.interfaces.fields import format_path
from deros.interfaces.message_fields import field_type, unsized_arrays
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import FieldType, InterfaceType
from deros.rules.gates.gate_table import StateTopic, Table, gate_table
from deros.rules.program.ir import Action, Binding, Gate, GateLine, Program, Scalar, StopField


@dataclass(frozen=True, slots=True)
class TypeBase:
    """The parts that the views of the functions for one message type have in common.

    Attributes:
        type: its name in ROS 2.
        finite: the operands whose conjunction is that each float in it is finite.
        zeros: the statements that set it to zero.
        zero_tests: the operands whose conjunction is that it commands nothing.
        stamped: whether it, or a message in it, has a header that takes the time.
    """

    type: InterfaceType
    finite: tuple[str, ...]
    zeros: tuple[str, ...]
    zero_tests: tuple[str, ...]
    stamped: bool


@dataclass(frozen=True, slots=True)
class SendBase:
    """What a line sends to stop.

    Attributes:
        line: its number in the table.
        assignments: the statements that set its fields in zeros.
        tests: the operands whose conjunction is that a command has these values.
        zeros: the statements that set the same fields to zero, in the rest of such a command.
    """

    line: int
    assignments: tuple[str, ...]
    tests: tuple[str, ...]
    zeros: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class ActionView:
    """An action that lines name; ``test`` is the condition that a message says it is active."""

    name: str
    test: str


@dataclass(frozen=True, slots=True, kw_only=True)
class GateBase:
    """The parts that the views of a gate have in common.

    Attributes:
        gate: where it comes from.
        table: what it does.
        types: the functions for messages of each type in the command, which is the last.
        sends: what the lines send.
    """

    gate: Gate
    table: Table
    types: tuple[TypeBase, ...]
    sends: tuple[SendBase, ...]

    @property
    def origin(self) -> str:
        """Its place in the rules, as text."""
        return origin(self.gate.span)

    @property
    def type(self) -> str:
        """The command's type in ROS 2."""
        return str(self.gate.type)

    @property
    def period_ns(self) -> int:
        """The time between two zeros."""
        return self.table.period_ns

    @property
    def waits(self) -> bool:
        """Whether commands pass again only after one that is zero."""
        return self.table.resume_on_zero

    @property
    def chooses(self) -> bool:
        """Whether sources have times, so that one of several is chosen."""
        return bool(self.table.sources)

    @property
    def tests_zero(self) -> bool:
        """Whether it matters that a command is zero, or what a line sends."""
        return self.table.waits_for_zero or bool(self.table.waiting)

    @property
    def has_floats(self) -> bool:
        """Whether a command can hold a NaN."""
        return bool(self.types and self.types[-1].finite)

    @property
    def stamped(self) -> bool:
        """Whether a command carries the time."""
        return bool(self.types and self.types[-1].stamped)

    @property
    def commands_numbers(self) -> bool:
        """Whether there is a number or a flag in a command."""
        return bool(self.types and self.types[-1].zero_tests)

    @property
    def holds(self) -> bool:
        """Whether a line holds the last command."""
        return any(line.stop and line.stop.what == "hold" for line in self.table.lines)

    @property
    def stops_with_zero(self) -> bool:
        """Whether a line commands zero, or a gate without a line that stops waits at zero."""
        kinds = [line.stop.what for line in self.table.lines if line.stop]
        return "zero" in kinds or "send" not in kinds

    @property
    def depends_on_safety_node(self) -> bool:
        """Whether a line is about an action, or about the heartbeat."""
        return any(line.action or line.lost == "heartbeat" for line in self.table.lines)

    @property
    def latching(self) -> bool:
        """Whether a line stops until a reset."""
        return self.gate.is_latching


@dataclass(frozen=True, slots=True)
class ActionWords:
    """How a language tests a message for the state of an action.

    Attributes:
        message: what stands before a field of the message.
        negation: what stands before a condition to negate it.
        literal: returns a constant that a field of a type is compared with.
    """

    message: str
    negation: str
    literal: Callable[[FieldType, Scalar], str]


@dataclass(frozen=True, slots=True)
class SendWords:
    """How a language sets and tests the fields of what a line sends.

    Attributes:
        message: the name of a command.
        negation: what stands before a condition to negate it.
        conjunction: what stands between operands that all have to hold.
        longer: returns the condition that an array has more than so many elements.
        empty: returns the condition that an array has none.
        assigned: returns the statement that gives a place a value of the field's type.
        guarded: returns a statement that runs on a condition.
        literal: returns a value of a field's type.
    """

    message: str
    negation: str
    conjunction: str
    longer: Callable[[str, int], str]
    empty: Callable[[str], str]
    assigned: Callable[[str, FieldType, Scalar | None], str]
    guarded: Callable[[str, str], str]
    literal: Callable[[FieldType, Scalar], str]


def send_views(gate: Gate, store: InterfaceStore, words: SendWords) -> tuple[SendBase, ...]:
    """Return what the lines of a gate send."""
    return tuple(
        SendBase(
            number,
            tuple(_assigned(gate, store, words, each) for each in line.stop.sent),
            tuple(_is_sent(gate, store, words, each) for each in line.stop.sent),
            tuple(
                words.assigned(f"rest.{format_path(each.path)}", each.type, each.zero)
                for each in line.stop.sent
                if each.value is not None
            ),
        )
        for number, line in enumerate(gate.lines)
        if line.stop is not None and line.stop.kind == "send"
    )


def _assigned(gate: Gate, store: InterfaceStore, words: SendWords, sent: StopField) -> str:
    """Return the statement that gives a field its value, if the message has the field."""
    place = f"{words.message}.{format_path(sent.path)}"
    statement = words.assigned(place, sent.type, sent.value)
    guards = _guards(gate, store, words, sent)
    return words.guarded(words.conjunction.join(guards), statement) if guards else statement


def _is_sent(gate: Gate, store: InterfaceStore, words: SendWords, sent: StopField) -> str:
    """Return the condition that a command has the value that is sent."""
    place = f"{words.message}.{format_path(sent.path)}"
    if sent.value is None:
        return words.empty(place)
    if isinstance(sent.value, bool):
        test = place if sent.value else f"{words.negation}{place}"
    else:
        test = f"{place} == {words.literal(sent.type, sent.value)}"
    return words.conjunction.join([*_guards(gate, store, words, sent), test])


def _guards(gate: Gate, store: InterfaceStore, words: SendWords, sent: StopField) -> list[str]:
    arrays = unsized_arrays(store, gate.type, sent.path)
    return [words.longer(f"{words.message}.{format_path(array)}", index) for array, index in arrays]


def table_of(gate: Gate, program: Program) -> Table:
    """Return the table of a gate, whose lines are reported with their places."""
    return gate_table(gate, program.actions, _shown)


def _shown(line: GateLine) -> str:
    return f"{printable_line(line.span.text).rstrip('; ')} ({origin(line.span)})"


def action_views(
    state: StateTopic, program: Program, store: InterfaceStore, words: ActionWords
) -> tuple[ActionView, ...]:
    """Return the actions whose states the messages of a topic hold."""
    return tuple(
        _action(program.actions[index], binding, store, words)
        for index, binding in state.bindings.items()
    )


def _action(
    action: Action, binding: Binding, store: InterfaceStore, words: ActionWords
) -> ActionView:
    test = f"{words.message}{format_path(binding.path)}"
    if not isinstance(binding.value, bool):
        field = field_type(store, binding.type, binding.path)
        test += f" == {words.literal(field, binding.value)}"
    elif not binding.value:
        test = f"{words.negation}{test}"
    return ActionView(action.name, test)
