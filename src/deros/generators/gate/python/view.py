"""What the templates of a gate see: its program, named, and its ports in terms of rclpy."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from deros.generators.gate.printing import ConditionPrinter
from deros.generators.gate.python.messages import LimitedField, limited_field, type_views
from deros.generators.gate.view import ActionView, ActionWords, GateBase, named_parts
from deros.generators.node.python.interface import (
    NodeView,
    PortView,
    interface_imports,
    node_view,
)
from deros.generators.text.identifiers import PYTHON_WORDS
from deros.generators.text.provenance import origin
from deros.generators.text.python import Call, import_lines
from deros.generators.text.python_fields import literal
from deros.generators.text.unique_names import UniqueNames
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import InterfaceType
from deros.metamodels.node import NodeType
from deros.metamodels.safety_nodes import HEARTBEAT_TYPE, RESET, TRIGGER, heartbeat_port
from deros.monitor import gate_program as form
from deros.monitor.ir import Gate, Limit, Program

# Names that the template of the logic uses.
_TAKEN = frozenset(
    (
        "Callable",
        "Gate",
        "LINES",
        "Limits",
        "NEVER",
        "PERIOD",
        "REFUSING",
        "Values",
        "advance",
        "against",
        "applying",
        "is_latched",
        "is_new",
        "is_zero",
        "kept",
        "limits",
        "math",
        "now",
        "self",
        "t",
        "values",
        "zero",
    )
)

_MESSAGE_TESTS = ActionWords("msg.", "not ", literal)


@dataclass(frozen=True, slots=True)
class StateView:
    """A topic with the states of actions; ``identifier`` is that of the port.

    Attributes:
        literal: the topic as an expression.
        actions: the actions whose states its messages hold.
        steps: what a message of it does.
    """

    identifier: str
    topic: str
    literal: str
    type: str
    actions: tuple[ActionView, ...]
    steps: tuple[form.Step, ...]

    @property
    def parameters(self) -> tuple[str, ...]:
        """The parameters of the method that takes the states."""
        states = (f"{action.state}: bool" for action in self.actions)
        return ("self", "t: int", *states, "is_trusted: bool")

    @property
    def is_believed(self) -> str:
        """The condition that the stored states equal those of the message."""
        return " and ".join(f"self._{each.state} == {each.state}" for each in self.actions)

    @property
    def active(self) -> tuple[str, ...]:
        """For each action, the condition that a message ``msg``, or ``None``, makes it active."""
        return tuple(f"msg is None or {action.test}" for action in self.actions)


@dataclass(frozen=True, slots=True, kw_only=True)
class GateView(GateBase):
    """All that the templates print.

    Attributes:
        rules: the file name of the rules.
        command: the command's type as the node's module names it.
        source: the port where commands arrive, and ``target`` the port where they leave.
        heartbeat: the port of the heartbeat, where a line needs one.
        imports: the statements that import the interfaces.
        fields: the fields that have limits, in the order of the program.
        trigger: the service class of ``~/reset`` as the module names it; empty without latches.
    """

    node: NodeView
    rules: str
    command: str
    source: PortView
    target: PortView
    heartbeat: PortView | None
    imports: tuple[str, ...]
    fields: tuple[LimitedField, ...]
    states: tuple[StateView, ...]
    trigger: str

    @property
    def refusing_lines(self) -> Call:
        """The numbers of the lines that refuse a reset."""
        return tuple_of(map(str, self.refusing))

    @property
    def values(self) -> Call:
        """The fields that have limits, as local variables."""
        return tuple_of(field.name for field in self.fields)

    @property
    def unpacked(self) -> Call:
        """The same, taken from ``values``."""
        return dataclasses.replace(self.values, tail=" = values")

    @property
    def command_parameters(self) -> tuple[str, ...]:
        """The parameters of the method that takes a command."""
        fields = (f"{field.name}: float | None" for field in self.fields)
        return ("self", "t: int", *fields, *(["is_zero: bool"] if self.waits else []))


class Conditions(ConditionPrinter):
    """Prints conditions, and what depends on them, as expressions."""

    language = "Python"
    all_of = " and "
    any_of = " or "
    never = "False"

    def variable(self, name: str) -> str:
        """Return the attribute of the gate."""
        return f"self._{name}"

    def nanoseconds(self, count: int) -> str:
        """Return the literal of a duration."""
        return nanoseconds(count)

    def losses(self, sources: Sequence[form.Source]) -> list[str]:
        """Return the lines about the loss of one of ``sources``."""
        lines = zip(self._gate.program.gate.lines, self._gate.lines, strict=True)
        return [view.name for line, view in lines if line.lost in sources]

    def none_of(self, operands: list[str]) -> str:
        """Return the negation of a disjunction."""
        return f"not ({self.any_of.join(operands)})" if len(operands) > 1 else f"not {operands[0]}"

    def all_lines(self, step: form.ReportApplying) -> Call:
        """Return the tuple of everything that can hold commands back."""
        return tuple_of(map(self, step.conditions))

    def limit_choices(self, field: form.FieldChoice) -> tuple[str, ...]:
        """Return the parts of the conditional expression that chooses a field's limit."""
        choices = (f"{_interval(each.limit)} if {self(each.condition)}" for each in field.choices)
        return (*choices, "None")

    def next_loss(self, step: form.ScheduleLosses) -> Call | str:
        """Return the earliest instant at which something will be lost."""
        due = [
            f"NEVER if {self(form.Applies(end.line))} else {self.instant(end.source, end.ns)}"
            for end in step.deadlines
        ]
        return Call("min", tuple(due)) if len(due) > 1 else due[0]


def tuple_of(names: Iterable[str]) -> Call:
    """Return a tuple of one or more expressions."""
    listed = list(names)
    return Call("", tuple(listed if len(listed) > 1 else [f"{listed[0]},"]))


def gate_view(
    gate: Gate,
    node: NodeType,
    program: Program,
    store: InterfaceStore,
    safety_node: NodeType,
    runtime: str = "",
) -> GateView:
    """Return the view of a gate.

    Args:
        gate: the gate.
        node: its node.
        program: the rules that it is of.
        store: the message definitions.
        safety_node: the node whose states and heartbeat it evaluates.
        runtime: the package that the runtime is imported from; by default, the node's own.

    Raises:
        GenerationError: if two ports would get one name.
    """
    base = node_view(node, raw=True)
    heartbeat = heartbeat_port(safety_node)
    names = UniqueNames(PYTHON_WORDS | _TAKEN)
    steps, actions, lines = named_parts(gate, program, store, _MESSAGE_TESTS, names)
    fields = (limited_field(store, gate.type, path, names.new(*path)) for path in steps.fields)
    heard = {binding.type for state in steps.states for _, binding in state.bindings}
    if node.port(heartbeat):
        heard.add(HEARTBEAT_TYPE)
    called = {TRIGGER} if node.port(RESET) else set()
    return GateView(
        program=steps,
        types=type_views(store, gate.type),
        actions=actions,
        lines=lines,
        node=base,
        rules=origin(gate.span).rpartition(":")[0],
        command=dict(base.interfaces)[gate.type],
        source=_port(base.subscriptions, gate.source),
        target=_port(base.publishers, gate.target),
        heartbeat=_port(base.subscriptions, heartbeat) if node.port(heartbeat) else None,
        imports=tuple(
            _imports(
                base,
                node,
                {gate.type, *heard, *called},
                runtime or node.package,
                is_heeding=bool(heard),
            )
        ),
        fields=tuple(fields),
        states=tuple(_states(steps, base, actions)),
        trigger=dict(base.interfaces)[TRIGGER] if node.port(RESET) else "",
    )


def _states(
    steps: form.GateProgram, base: NodeView, actions: Mapping[int, ActionView]
) -> Iterator[StateView]:
    for state in steps.states:
        port = _port(base.subscriptions, state.topic)
        named = tuple(actions[action] for action in state.actions)
        yield StateView(port.identifier, port.name, port.topic, port.type, named, state.steps)


def nanoseconds(count: int) -> str:
    """Return a time as a literal."""
    return f"{count:_}"


def _port(ports: Iterable[PortView], name: str) -> PortView:
    return next(port for port in ports if port.name == name)


def _imports(
    base: NodeView, node: NodeType, used: Iterable[InterfaceType], runtime: str, *, is_heeding: bool
) -> list[str]:
    imports = interface_imports(dict(base.interfaces), used)
    own = {f"{base.module}_{module} as {module}" for module in ("logic", "message")}
    imports |= {
        "rclpy.serialization": {"deserialize_message"},
        node.package: own,
        f"{node.package}.{base.base_module}": {base.base_class},
        f"{runtime}.gate_report": {"decoded", "GateReport"},
        f"{runtime}.gate_runner": {"GateRunner"},
        f"{runtime}.instance": {"claim"},
        f"{runtime}.process": {"run"},
        f"{runtime}.realtime": {"configure_process"},
    }
    if is_heeding:
        imports[f"{runtime}.safety_source"] = {"SafetySource"}
    return import_lines(imports)


def _interval(limit: Limit | None) -> str:
    return f"({limit.lower!r}, {limit.upper!r})" if limit else "None"
