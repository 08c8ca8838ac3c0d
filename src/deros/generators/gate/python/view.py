"""What the templates of a gate see: its lines as conditions, its fields in terms of rclpy."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from deros.generators.gate.command import limited_paths
from deros.generators.gate.python.messages import LimitedField, limited_field, type_views
from deros.generators.gate.view import (
    ActionView,
    GateBase,
    LineView,
    deciding_lines,
    heeded_actions,
    limiting_lines,
    line_views,
)
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
from deros.interfaces.fields import format_path
from deros.interfaces.message_fields import field_type
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import InterfaceType
from deros.metamodels.node import NodeType
from deros.metamodels.safety_nodes import HEARTBEAT_TYPE, RESET, TRIGGER, heartbeat_port
from deros.monitor.ir import Action, Binding, Gate, Limit, Program

# Names that the template of the logic uses itself.
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


@dataclass(frozen=True, slots=True)
class StateView:
    """A topic with the states of actions; ``identifier`` is that of the port.

    Attributes:
        literal: the topic as an expression.
    """

    identifier: str
    topic: str
    literal: str
    type: str
    actions: tuple[ActionView, ...]

    @property
    def parameters(self) -> tuple[str, ...]:
        """The parameters of the method that takes the states."""
        states = (f"{action.state}: bool" for action in self.actions)
        return ("self", "t: int", *states, "is_trusted: bool")

    @property
    def is_believed(self) -> str:
        """The condition that the states are as a message says."""
        return " and ".join(f"self._{each.state} == {each.state}" for each in self.actions)

    @property
    def active(self) -> tuple[str, ...]:
        """What a message ``msg``, which may be ``None``, says of each action."""
        return tuple(f"msg is None or {action.test}" for action in self.actions)


@dataclass(frozen=True, slots=True)
class FieldView:
    """A field that limits speak of; ``limit`` chooses the interval that it is to be kept in."""

    field: LimitedField
    limit: tuple[str, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class GateView(GateBase):
    """All that the templates print.

    Attributes:
        rules: the file name of the rules.
        command: the command's type as the node's module names it.
        source: the port that commands come in by, and ``target`` that which they go out by.
        heartbeat: the port of the heartbeat, where a line needs one.
        imports: the statements that import the interfaces.
        trigger: the service class of ``~/reset`` as the module names it; empty without latches.
    """

    node: NodeView
    rules: str
    command: str
    source: PortView
    target: PortView
    heartbeat: PortView | None
    imports: tuple[str, ...]
    fields: tuple[FieldView, ...]
    states: tuple[StateView, ...]
    trigger: str

    @property
    def lost_heartbeat(self) -> str:
        """The condition that the heartbeat is lost."""
        text = _any_of(line.name for line in self.lines if line.lost == "heartbeat")
        return f"({text})" if " or " in text else text

    @property
    def lost_input(self) -> str:
        """The condition that the input is lost."""
        return _any_of(line.name for line in self.lines if line.lost == "input")

    @property
    def unless_lost(self) -> str:
        """What the limits of an action also depend on."""
        text = _any_of(line.name for line in self.losses)
        return f" and not {f'({text})' if ' or ' in text else text}" if text else ""

    @property
    def zero(self) -> str:
        """The condition that some line commands zero, or is latched."""
        releasing = (line.name for line in self.releasing)
        return _any_of((*releasing, *(["is_latched"] if self.latching else []))) or "False"

    @property
    def latched(self) -> str:
        """The condition that some line is latched."""
        return _any_of(f"self._{line.latch}" for line in self.latching)

    @property
    def all_lines(self) -> Call:
        """Of all that can hold commands back, whether it does."""
        names = [line.name for line in self.lines]
        names += [f"self._{line.latch} and not {line.name}" for line in self.latching]
        return _tuple([*names, *(["self._waits and not zero"] if self.waits else [])])

    @property
    def refusing_lines(self) -> Call:
        """The numbers of the lines that refuse a reset."""
        return _tuple(map(str, self.refusing))

    @property
    def values(self) -> Call:
        """The fields that limits speak of, as local variables."""
        return _tuple(each.field.name for each in self.fields)

    @property
    def unpacked(self) -> Call:
        """The same, taken from ``values``."""
        return dataclasses.replace(self.values, tail=" = values")

    @property
    def command_parameters(self) -> tuple[str, ...]:
        """The parameters of the method that takes a command."""
        fields = (f"{each.field.name}: float | None" for each in self.fields)
        return ("self", "t: int", *fields, *(["is_zero: bool"] if self.waits else []))

    @property
    def follow(self) -> str:
        """The arguments of the method that does what follows."""
        zero = "self._waits" if self.waits else "zero"
        if not self.fields:
            return f"t, {zero}, is_new"
        return f"t, {zero}, limits, is_new{f', {self.lost_input}' if self.minds_input else ''}"

    @property
    def lost_due(self) -> Call | str:
        """The earliest instant at which something will be lost."""
        due = [
            f"NEVER if {line.name} else self._{line.lost} + {nanoseconds(line.lost_ns)}"
            for line in self.losses
        ]
        return Call("min", tuple(due)) if len(due) > 1 else due[0]


def _any_of(names: Iterable[str]) -> str:
    return " or ".join(names)


def _tuple(names: Iterable[str]) -> Call:
    listed = list(names)
    return Call("", tuple(listed if len(listed) > 1 else [f"{listed[0]},"]))


def gate_view(
    gate: Gate, node: NodeType, program: Program, store: InterfaceStore, safety_node: NodeType
) -> GateView:
    """Return the view of a gate.

    Args:
        gate: the gate.
        node: its node.
        program: the rules that it is of.
        store: the message definitions.
        safety_node: the node whose states and heartbeat it heeds.

    Raises:
        GenerationError: if two ports would get one name.
    """
    base = node_view(node, raw=True)
    heartbeat = heartbeat_port(safety_node)
    names = UniqueNames(PYTHON_WORDS | _TAKEN)
    heeded = heeded_actions(gate, program)
    states = tuple(
        _state(_port(base.subscriptions, topic), bound, store, names)
        for topic, bound in heeded.items()
    )
    actions = tuple(action for state in states for action in state.actions)
    lines = line_views(gate, program, actions, names)
    heard = {binding.type for bound in heeded.values() for _, binding in bound}
    if node.port(heartbeat):
        heard.add(HEARTBEAT_TYPE)
    called = {TRIGGER} if node.port(RESET) else set()
    return GateView(
        node=base,
        rules=origin(gate.span).rpartition(":")[0],
        origin=origin(gate.span),
        type=str(gate.type),
        command=dict(base.interfaces)[gate.type],
        source=_port(base.subscriptions, gate.source),
        target=_port(base.publishers, gate.target),
        heartbeat=_port(base.subscriptions, heartbeat) if node.port(heartbeat) else None,
        imports=tuple(_imports(base, node, {gate.type, *heard, *called}, is_heeding=bool(heard))),
        period_ns=gate.period_ns,
        types=type_views(store, gate.type),
        fields=tuple(_fields(gate, lines, store, names)),
        lines=lines,
        actions=actions,
        states=states,
        waits=gate.resume_on_zero,
        trigger=_trigger(base) if node.port(RESET) else "",
    )


def _trigger(base: NodeView) -> str:
    return dict(base.interfaces)[TRIGGER]


def nanoseconds(count: int) -> str:
    """Return a time as a literal."""
    return f"{count:_}"


def _port(ports: Iterable[PortView], name: str) -> PortView:
    return next(port for port in ports if port.name == name)


def _imports(
    base: NodeView, node: NodeType, used: Iterable[InterfaceType], *, is_heeding: bool
) -> list[str]:
    imports = interface_imports(dict(base.interfaces), used)
    own = {f"{base.module}_{module} as {module}" for module in ("logic", "message")}
    imports |= {
        "rclpy.serialization": {"deserialize_message"},
        node.package: {*own, "realtime"},
        f"{node.package}.{base.base_module}": {base.base_class},
        f"{node.package}.gate_report": {"decoded", "GateReport"},
        f"{node.package}.gate_runner": {"GateRunner"},
        f"{node.package}.instance": {"claim"},
        f"{node.package}.process": {"run"},
    }
    if is_heeding:
        imports[f"{node.package}.safety_source"] = {"SafetySource"}
    return import_lines(imports)


# Actions ------------------------------------------------------------------------------------------


def _state(
    port: PortView,
    bound: Iterable[tuple[Action, Binding]],
    store: InterfaceStore,
    names: UniqueNames,
) -> StateView:
    actions = tuple(_action(action, binding, store, names) for action, binding in bound)
    return StateView(port.identifier, port.name, port.topic, port.type, actions)


def _action(
    action: Action, binding: Binding, store: InterfaceStore, names: UniqueNames
) -> ActionView:
    test = f"msg.{format_path(binding.path)}"
    if not isinstance(binding.value, bool):
        test += f" == {literal(field_type(store, binding.type, binding.path), binding.value)}"
    elif not binding.value:
        test = f"not {test}"
    return ActionView(action.name, names.new(action.name, "active"), test)


# Limits -------------------------------------------------------------------------------------------


def _fields(
    gate: Gate, lines: Sequence[LineView], store: InterfaceStore, names: UniqueNames
) -> Iterator[FieldView]:
    limiting = limiting_lines(gate, lines)
    for path in limited_paths(gate):
        field = limited_field(store, gate.type, path, names.new(*path))
        decided = (
            f"{_interval(limit)} if {line.name}"
            for line, limit in deciding_lines(limiting, field.path)
        )
        held = [f"None if {_held(gate)}"] if gate.is_holding else []
        yield FieldView(field, (*held, *decided, "None"))


def _held(gate: Gate) -> str:
    """Return the condition that all numbers are zero, whatever the lines say."""
    return "self._waits" if gate.resume_on_zero else "is_latched"


def _interval(limit: Limit | None) -> str:
    return f"({limit.lower!r}, {limit.upper!r})" if limit else "None"
