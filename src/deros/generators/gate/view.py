"""What the templates of a gate see in every language: its program, and names for its parts."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from deros.diagnostics import Span
from deros.generators.text.prose import printable_line
from deros.generators.text.provenance import origin
from deros.generators.text.unique_names import UniqueNames
from deros.interfaces.fields import format_path
from deros.interfaces.message_fields import field_type
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import FieldType, InterfaceType
from deros.monitor import gate_program as form
from deros.monitor.gate_lowering import gate_program
from deros.monitor.gate_table import Table
from deros.monitor.ir import Binding, Gate, GateLine, Program, Scalar


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
class ActionView:
    """An action that lines name.

    Attributes:
        name: its name in the rules.
        state: the name of the variable that holds whether it is active.
        test: the condition that a message says it is.
    """

    name: str
    state: str
    test: str


@dataclass(frozen=True, slots=True)
class LineView:
    """One line of the gate.

    Attributes:
        name: the local variable that holds whether the line applies.
        title: what it is about, and ``span`` where it stands.
        shown: its text, on one line, for the diagnostics.
        latch: the variable that holds whether it has applied since the last reset, if it commands
            zero until a reset; else empty.
    """

    name: str
    title: str
    span: Span
    shown: str
    latch: str


@dataclass(frozen=True, slots=True, kw_only=True)
class GateBase:
    """The parts that the views of a gate have in common.

    Attributes:
        program: what the gate does.
        table: the same as data.
        types: the functions for messages of each type in the command, which is the last.
        actions: those that lines name, by index.
        lines: its lines, by index.
    """

    program: form.GateProgram
    table: Table
    types: tuple[TypeBase, ...]
    actions: Mapping[int, ActionView]
    lines: tuple[LineView, ...]

    @property
    def span(self) -> Span:
        """Its place in the rules."""
        return self.program.gate.span

    @property
    def origin(self) -> str:
        """Its place in the rules, as text."""
        return origin(self.span)

    @property
    def type(self) -> str:
        """The command's type in ROS 2."""
        return str(self.program.gate.type)

    @property
    def period_ns(self) -> int:
        """The time between two zeros."""
        return self.program.gate.period_ns

    @property
    def waits(self) -> bool:
        """Whether commands pass again only after one that is zero."""
        return self.program.gate.resume_on_zero

    @property
    def has_floats(self) -> bool:
        """Whether a command can hold a NaN."""
        return bool(self.types and self.types[-1].finite)

    @property
    def stamped(self) -> bool:
        """Whether a command carries the time."""
        return bool(self.types and self.types[-1].stamped)

    @property
    def depends_on_safety_node(self) -> bool:
        """Whether a line is about an action, or about the heartbeat."""
        return bool(self.program.on_no_safety_node)

    @property
    def latching(self) -> bool:
        """Whether a line commands zero until a reset."""
        return self.program.gate.is_latching

    @property
    def has_losses(self) -> bool:
        """Whether a line is about a loss."""
        return any(line.lost for line in self.program.gate.lines)

    @property
    def refusing(self) -> tuple[int, ...]:
        """The indices of the lines that refuse a reset while they apply."""
        resets = (step for step in self.program.on_reset if isinstance(step, form.Reset))
        return next((step.refusing for step in resets), ())

    @property
    def shown(self) -> tuple[str, ...]:
        """One text for each condition that can hold commands back."""
        return self.table.reports

    def state(self, action: int) -> str:
        """Return the name of the state of an action."""
        return self.actions[action].state


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


def named_parts(
    gate: Gate, program: Program, store: InterfaceStore, words: ActionWords, names: UniqueNames
) -> tuple[form.GateProgram, dict[int, ActionView], tuple[LineView, ...]]:
    """Return what a gate does, its actions and its lines.

    Args:
        gate: the gate.
        program: the rules that it belongs to.
        store: the message definitions.
        words: how messages are tested.
        names: hands out the names of variables.
    """
    steps = gate_program(gate, program.actions, store)
    actions = {
        index: _action(program.actions[index].name, binding, store, words, names)
        for state in steps.states
        for index, binding in state.bindings
    }
    return steps, actions, tuple(_line(line, actions, names) for line in gate.lines)


def _action(
    name: str, binding: Binding, store: InterfaceStore, words: ActionWords, names: UniqueNames
) -> ActionView:
    test = f"{words.message}{format_path(binding.path)}"
    if not isinstance(binding.value, bool):
        field = field_type(store, binding.type, binding.path)
        test += f" == {words.literal(field, binding.value)}"
    elif not binding.value:
        test = f"{words.negation}{test}"
    return ActionView(name, names.new(name, "active"), test)


def _line(line: GateLine, actions: Mapping[int, ActionView], names: UniqueNames) -> LineView:
    if line.action is not None:
        action = actions[line.action].name
        name, title = names.new(action), f"Action {action}"
    else:
        assert line.lost is not None
        name, title = names.new("lost", line.lost), f"Lost {line.lost}"
    return LineView(
        name=name,
        title=title,
        span=line.span,
        shown=shown(line),
        latch=names.new(name, "latched") if line.until_reset else "",
    )


def shown(line: GateLine) -> str:
    """Return the text of a line for reports, with its place."""
    return f"{printable_line(line.span.text).rstrip('; ')} ({origin(line.span)})"
